/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The store gives back what was added, packed or not, and needs the memory that it says. */
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "links/linkset-impl.h"
#include "support/support.h"

enum { MOST = 40000, SOME = 1024 };

typedef struct kind {
  const char *name;
  uint32_t spread;      /* neighbours have elements that are so far apart */
  double max_if_packed; /* bytes per link */
} kind;

static const kind kinds[] = {{"few elements", 100, 10.9},
                             {"as many elements as a block has", 255, 11.3},
                             {"one too many", 1500, 16.1},
                             {"elements of any number", UINT32_MAX, 16.1}};

static hr2d_link draw(const kind *of, uint32_t base, randoms *r) {
  const uint32_t half = of->spread / 2;
  return (hr2d_link){{base + (uint32_t)(random_unit(r) * half),
                      base + half + (uint32_t)(random_unit(r) * half)},
                     random_unit(r)};
}

static int same(const hr2d_link *a, const hr2d_link *b) {
  return a->pair.first == b->pair.first && a->pair.second == b->pair.second &&
         memcmp(&a->exchange_area, &b->exchange_area, sizeof(double)) == 0;
}

static void check_contents(const hr2di_store *store, const hr2d_link *expected, size_t count) {
  hr2d_link room[HR2DI_READ_LINKS];
  ck_assert_uint_eq(store->count, count);
  size_t found = 0;
  for (size_t k = 0; k < hr2di_store_chunks(store); k++)
    found += hr2di_store_chunk_size(store, k);
  ck_assert_uint_eq(found, count);
  for (size_t k = 0; k < count; k++) ck_assert(same(hr2di_store_at(store, k), &expected[k]));
  for (size_t from = 0, some; from < count; from += some) {
    some = count - from;
    const hr2d_link *link = hr2di_store_read(store, from, &some, room);
    ck_assert(some >= 1 && some <= count - from);
    for (size_t k = 0; k < some; k++) ck_assert(same(&link[k], &expected[from + k]));
  }
}

static void fill(hr2di_store *store, const hr2d_allocator *alloc, const kind *of,
                 hr2d_link *expected, size_t count, randoms *r) {
  const uint32_t base = of->spread == UINT32_MAX ? 0 : (uint32_t)(random_unit(r) * (1u << 31));
  for (size_t done = 0, some; done < count; done += some) {
    hr2d_pair pair[SOME];
    double area[SOME];
    some = 1 + (size_t)random_below(r, SOME);
    if (some > count - done) some = count - done;
    for (size_t k = 0; k < some; k++) {
      expected[done + k] = draw(of, base, r);
      pair[k] = expected[done + k].pair;
      area[k] = expected[done + k].exchange_area;
    }
    const uint64_t before = hr2di_store_bytes(store), max = hr2di_store_growth(store, some);
    ck_assert_int_eq(hr2di_store_add(store, alloc, pair, area, some), HR2D_OK);
    ck_assert_uint_le(hr2di_store_bytes(store), before + max);
  }
}

START_TEST(what_was_added_comes_back) {
  static hr2d_link expected[MOST];
  const kind *of = &kinds[_i / 2];
  randoms r = randoms_stream(test_seed(), 60 + _i);
  for (int round = test_count(100); round > 0; round--) {
    test_meter m = {0, 0};
    const hr2d_allocator alloc = test_metered(&m);
    hr2di_store store = {.packs = _i % 2};
    const size_t count = round == 1 ? MOST : (size_t)random_below(&r, 10000);
    fill(&store, &alloc, of, expected, count, &r);
    check_contents(&store, expected, count);
    ck_assert_uint_eq(hr2di_store_bytes(&store), (uint64_t)atomic_load(&m.held));
    if (round == 1) {
      const double each = (double)(store.held) / (double)(store.full * HR2DI_CHUNK_LINKS);
      printf("%s, %s: %.2f bytes per link of a full chunk\n", of->name,
             store.packs ? "packed" : "plain", store.packs ? each : 16.);
      if (store.packs) ck_assert_double_lt(each, of->max_if_packed);
      if (store.packs) ck_assert(of->spread < 256 || each > 15.9);
    }
    hr2di_store_clear(&store, &alloc);
    ck_assert_int_eq(atomic_load(&m.held), 0);
  }
}
END_TEST

static double radiosity(hr2d_linkset *links) {
  hr2d_solution *s = NULL;
  ck_assert_int_eq(hr2d_solve(links, NULL, &s), HR2D_OK);
  const double b = hr2d_solution_average(s, 1, 0);
  hr2d_solution_destroy(s);
  return b;
}

/* Links of hr2d_linkset_read() are those of hr2d_linkset_get(), wherever a piece begins and
 * ends. */
static void read_pieces(const hr2d_linkset *links) {
  static const size_t sizes[] = {1, 7, 255, 4096, 5000};
  const uint64_t count = hr2d_linkset_size(links);
  hr2d_link link[5001];
  for (size_t m = 0; m < sizeof sizes / sizeof *sizes; m++)
    for (uint64_t first = 0, next; first <= count; first = next) {
      const size_t wanted = sizes[m];
      link[wanted].exchange_area = -1;
      const size_t had = hr2d_linkset_read(links, first, wanted, link);
      ck_assert_uint_eq(had, count - first < wanted ? count - first : wanted);
      ck_assert(link[wanted].exchange_area == -1);
      for (size_t k = 0; k < had; k++) {
        const hr2d_link one = hr2d_linkset_get(links, first + k);
        ck_assert(same(&one, &link[k]));
      }
      next = first + (first / 3000 % 2 ? 2999 : wanted); /* from the middle of pieces, too */
      if (m < 2 && first == 0) next = 4096 - wanted + 1; /* few of the short ones */
      if (m < 2 && first > 4096) next = first + count / 10;
    }
  ck_assert_uint_eq(hr2d_linkset_read(links, count + 5, 1, link), 0);
}

/* Two patches: 10⁹ links would take 10.7 GB, and the places in the store of larger numbers of
   elements take no more. */
START_TEST(packing_changes_no_digit_and_saves_memory) {
  test_links t[2];
  for (int k = 0; k < 2; k++) {
    hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
    t[k] = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
    options.epsilon = 1. / 160;
    options.packed = k;
    ck_assert_int_eq(hr2d_refine(t[k].links, &options), HR2D_OK);
    /* The links are refined further, from packed ones. */
    options.epsilon = 1. / 200;
    ck_assert_int_eq(hr2d_refine(t[k].links, &options), HR2D_OK);
    ck_assert_int_eq(hr2d_linkset_validate(t[k].links), HR2D_OK);
    read_pieces(t[k].links);
  }
  const uint64_t count = hr2d_linkset_size(t[0].links);
  ck_assert_uint_eq(count, hr2d_linkset_size(t[1].links));
  for (uint64_t k = 0; k < count; k++) {
    const hr2d_link a = hr2d_linkset_get(t[0].links, k), b = hr2d_linkset_get(t[1].links, k);
    ck_assert(same(&a, &b));
  }
  ck_assert(radiosity(t[0].links) == radiosity(t[1].links));
  const hr2d_refine_counts n = hr2d_linkset_counts(t[1].links);
  const double bytes = (double)hr2d_linkset_bytes(t[1].links) + 70. * (double)n.elements;
  printf("%llu links: %.2f bytes each with elements\n", (unsigned long long)count,
         bytes / (double)count);
  ck_assert_double_lt(bytes / (double)count, 12);
  for (int k = 0; k < 2; k++) test_free_links(&t[k]);
}
END_TEST

TEST_SUITE("store") {
  REPEAT_TESTS(2 * sizeof kinds / sizeof *kinds, "links", what_was_added_comes_back);
  ADD_TESTS("refine", packing_changes_no_digit_and_saves_memory);
}
