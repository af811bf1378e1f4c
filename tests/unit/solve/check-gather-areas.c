/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gathers over exchange areas have the bits of the plain loop, however links are kept and
   whether they are in squares. */
#include <string.h>

#include "base/alloc.h"
#include "solve/gather-areas.h"
#include "support/support.h"

enum { SENDERS = 60, ELEMENTS = 2 * SENDERS, BANDS = 2, FIELD = ELEMENTS * BANDS };
enum { LINKS = 3 * HR2DI_CHUNK_LINKS / 2, LARGE = 16, LAST = SENDERS - 2 };

/* The links of two couples with two others, in the order of a recursion. */
static void make_large(randoms *r, hr2d_pair *pair) {
  const uint32_t i = (uint32_t)random_below(r, LAST), j = (uint32_t)random_below(r, LAST);
  /* Often the second couple has an element of the first. */
  const uint32_t k = (i + 1 + (uint32_t)random_below(r, 2)) % (LAST + 1);
  const uint32_t l = (j + 1 + (uint32_t)random_below(r, 2)) % (LAST + 1);
  const uint32_t first[] = {i, k}, second[] = {j, l};
  for (size_t n = 0; n < LARGE; n++)
    pair[n] = (hr2d_pair){first[n / 8] + n / 2 % 2, SENDERS + second[n / 4 % 2] + n % 2};
}

/* Large squares, parts of them, and squares in which a link is another one. */
static void draw(randoms *r, hr2d_pair *pair, double *area, size_t count) {
  for (size_t k = 0; k < count;) {
    hr2d_pair large[LARGE];
    make_large(r, large);
    const int kind = random_below(r, 4), some = kind < 2 ? LARGE : 1 + random_below(r, LARGE);
    if (kind == 1)
      large[random_below(r, LARGE)] = (hr2d_pair){(uint32_t)random_below(r, SENDERS),
                                                  SENDERS + (uint32_t)random_below(r, SENDERS)};
    for (int m = 0; m < some && k < count; m++, k++) pair[k] = large[m];
  }
  for (size_t k = 0; k < count; k++) area[k] = random_between(r, 0, 1);
}

static void add_plainly(const hr2d_pair *pair, const double *area, size_t count, size_t bands,
                        int directed, const double *up, double *down) {
  for (size_t k = 0; k < count; k++)
    for (size_t b = 0; b < bands; b++) {
      const size_t i = pair[k].first * bands + b, j = pair[k].second * bands + b;
      down[i] += area[k] * up[j];
      if (!directed) down[j] += area[k] * up[i];
    }
}

static void check(const hr2di_store *store, const hr2d_pair *pair, const double *area,
                  size_t bands, int directed, randoms *r) {
  double up[FIELD], down[FIELD], plain[FIELD];
  for (size_t k = 0; k < FIELD; k++) up[k] = random_between(r, -1, 1);
  for (size_t k = 0; k < FIELD; k++) down[k] = plain[k] = random_between(r, -1, 1);
  for (size_t k = 0; k < hr2di_store_chunks(store); k++)
    hr2di_gather_areas(store, k, bands, directed, up, down);
  add_plainly(pair, area, LINKS, bands, directed, up, plain);
  ck_assert_int_eq(memcmp(down, plain, sizeof down), 0);
}

enum { SETS = 20 };

/* The large squares of the first chunk. */
static size_t count_large(const hr2di_store *store) {
  size_t count = 0;
  for (size_t k = 0; k < HR2DI_CHUNK_LINKS; k++)
    count += (size_t)hr2di_store_is_marked(((hr2di_packed *)store->chunk[0].data)->large, k);
  return count;
}

START_TEST(sums_are_those_of_plain_loops) {
  static hr2d_pair pair[LINKS];
  static double area[LINKS];
  const hr2d_allocator alloc = hr2di_alloc_default();
  randoms r = {test_seed()};
  for (int n = 0; n < SETS; n++) {
    hr2di_store store = {.packs = _i};
    draw(&r, pair, area, LINKS);
    ck_assert_int_eq(hr2di_store_add(&store, &alloc, pair, area, LINKS), HR2D_OK);
    ck_assert_int_eq(hr2di_store_is_packed(&store, 0), _i);
    check(&store, pair, area, 1, 0, &r);
    check(&store, pair, area, 1, 1, &r);
    check(&store, pair, area, BANDS, 0, &r);
    hr2di_store_clear(&store, &alloc);
  }
}
END_TEST

/* A hierarchy gives elements other numbers: neighbours mostly stay neighbours, and some pairs
   become so. */
START_TEST(renamed_elements_gather_the_same) {
  static hr2d_pair pair[LINKS];
  static double area[LINKS];
  const hr2d_allocator alloc = hr2di_alloc_default();
  randoms r = {test_seed()};
  size_t before = 0, after = 0;
  for (int n = 0; n < SETS; n++) {
    hr2di_store store = {.packs = 1};
    uint32_t number[ELEMENTS];
    for (uint32_t k = 0; k < ELEMENTS; k++) number[k] = k;
    for (int swaps = 0; swaps < 8; swaps++) {
      const size_t k = (size_t)random_below(&r, ELEMENTS - 1);
      const uint32_t kept = number[k];
      number[k] = number[k + 1];
      number[k + 1] = kept;
    }
    draw(&r, pair, area, LINKS);
    ck_assert_int_eq(hr2di_store_add(&store, &alloc, pair, area, LINKS), HR2D_OK);
    before += count_large(&store);
    ck_assert_int_eq(hr2di_store_rename(&store, number, NULL), HR2D_OK);
    after += count_large(&store);
    for (size_t k = 0; k < LINKS; k++)
      pair[k] = (hr2d_pair){number[pair[k].first], number[pair[k].second]};
    check(&store, pair, area, 1, 0, &r);
    hr2di_store_clear(&store, &alloc);
  }
  ck_assert_uint_gt(after, SETS);
  ck_assert_uint_gt(before, after);
}
END_TEST

TEST_SUITE("gathers over areas") {
  REPEAT_TESTS(2, "links", sums_are_those_of_plain_loops);
  ADD_TESTS("names", renamed_elements_gather_the_same);
}
