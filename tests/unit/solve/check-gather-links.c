/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gathers over links, with blocks of doubles and of floats, in one part and in two: against
   sums in long double, the same bits wherever runs end, for each band alone, and for vectors of
   two and of four.  The file is part of this program, for what it picks by the processor. */
#include <math.h>
#include <string.h>

#include "solve/gather-links.c"
#include "support/support.h"

enum { ELEMENTS = 23, LINKS = 200, MOST = 9, PARTS = 3 };

/* Groups of four bands, with 0 to 3 left over. */
static const size_t numbers_of_bands[] = {1, 2, 3, 4, 5, 6, 7, 8, 16};
enum { BANDS = 16, FIELD = ELEMENTS * MOST * BANDS, NUMBERS = LINKS * MOST * MOST };

typedef struct stage {
  hr2d_link link[LINKS];
  double block[NUMBERS], up[FIELD], down[FIELD];
  float single[NUMBERS];
} stage;

/* Links of the same first element mostly follow each other. */
static void draw(stage *s, randoms *r) {
  uint32_t first = 0;
  for (size_t k = 0; k < LINKS; k++) {
    if (random_below(r, 4) == 0) first = (uint32_t)random_below(r, ELEMENTS);
    const uint32_t apart = 1 + (uint32_t)random_below(r, ELEMENTS - 1);
    s->link[k] = (hr2d_link){{first, (first + apart) % ELEMENTS}, random_between(r, 0.1, 1)};
  }
  for (size_t k = 0; k < NUMBERS; k++) {
    s->block[k] = random_between(r, -1, 1);
    s->single[k] = (float)random_between(r, -1, 1);
  }
  for (size_t k = 0; k < FIELD; k++) {
    s->up[k] = random_between(r, -1, 1);
    s->down[k] = random_between(r, -1, 1);
  }
}

/* The leading parts of all blocks are one behind the other, and then all that is left. */
static size_t place_of(size_t order, size_t lead, size_t link, size_t l, size_t m) {
  const size_t leading = lead * lead, rest = order * order - leading;
  if (l < lead && m < lead) return link * leading + l * lead + m;
  const size_t before =
      l < lead ? l * (order - lead) : lead * (order - lead) + (l - lead) * order;
  return LINKS * leading + link * rest + before + (l < lead ? m - lead : m);
}

static hr2di_link_run run_of(const stage *s, size_t order, size_t lead, int single,
                             int directed, size_t from) {
  const size_t leading = lead * lead, rest = order * order - leading;
  const size_t number = single ? sizeof *s->single : sizeof *s->block;
  const char *all = single ? (const void *)s->single : s->block;
  return (hr2di_link_run){
      .link = s->link + from,
      .block = {.value = all + from * leading * number,
                .rest = rest ? all + (LINKS * leading + from * rest) * number : NULL,
                .order = order,
                .lead = lead,
                .single = single},
      .count = LINKS - from,
      .directed = directed};
}

static void add_plainly(const stage *s, const hr2di_link_run *run, size_t order, size_t bands,
                        long double *down) {
  const size_t width = order * bands;
  for (size_t k = 0; k < LINKS; k++)
    for (size_t l = 0; l < order; l++)
      for (size_t m = 0; m < order; m++)
        for (size_t b = 0; b < bands; b++) {
          const size_t n = place_of(order, run->block.lead, k, l, m);
          const long double c = run->block.single
                                    ? (long double)s->link[k].exchange_area * s->single[n]
                                    : (long double)s->block[n];
          const size_t i = s->link[k].pair.first * width + l * bands + b;
          const size_t j = s->link[k].pair.second * width + m * bands + b;
          down[i] += c * s->up[j];
          if (!run->directed) down[j] += c * s->up[i];
        }
}

/* In one band of a low order: the loop that every processor can run, and what is picked. */
static void check_widths(const stage *s, const hr2di_link_run *run, size_t order) {
  static double narrow[FIELD], wide[FIELD];
  memcpy(narrow, s->down, sizeof narrow);
  memcpy(wide, s->down, sizeof wide);
  if (run->directed) {
    one_way_loop(run, order, s->up, narrow);
    one_way(run, order, s->up, wide);
  } else {
    both_ways_loop(run, order, s->up, narrow);
    both_ways(run, order, s->up, wide);
  }
  ck_assert_int_eq(memcmp(narrow, wide, sizeof wide), 0);
}

/* Each band has the bits of `all` when it is alone. */
static void check_bands(const stage *s, const hr2di_link_run *run, size_t order, size_t bands,
                        const double *all) {
  const size_t field = ELEMENTS * order;
  for (size_t b = 0; b < bands; b++) {
    double up[ELEMENTS * MOST], down[ELEMENTS * MOST];
    for (size_t k = 0; k < field; k++) {
      up[k] = s->up[k * bands + b];
      down[k] = s->down[k * bands + b];
    }
    hr2di_gather_links(run, order, 1, up, down);
    for (size_t k = 0; k < field; k++) ck_assert(down[k] == all[k * bands + b]);
  }
}

static void check(const stage *s, size_t order, size_t lead, size_t bands, int single,
                  int directed) {
  const hr2di_link_run run = run_of(s, order, lead, single, directed, 0);
  const size_t field = ELEMENTS * order * bands;
  static double at_once[FIELD], in_parts[FIELD];
  static long double plain[FIELD];
  for (size_t k = 0; k < FIELD; k++) plain[k] = at_once[k] = in_parts[k] = s->down[k];
  hr2di_gather_links(&run, order, bands, s->up, at_once);
  add_plainly(s, &run, order, bands, plain);
  for (size_t part = 0; part < PARTS; part++) {
    const size_t from = part * LINKS / PARTS;
    hr2di_link_run some = run_of(s, order, lead, single, directed, from);
    some.count = (part + 1) * LINKS / PARTS - from;
    hr2di_gather_links(&some, order, bands, s->up, in_parts);
  }
  ck_assert_int_eq(memcmp(at_once, in_parts, sizeof at_once), 0);
  for (size_t k = 0; k < field; k++)
    ck_assert_double_eq_tol(at_once[k], (double)plain[k], 1e-12);
  for (size_t k = field; k < FIELD; k++) ck_assert(at_once[k] == s->down[k]);
  check_bands(s, &run, order, bands, at_once);
  if (bands == 1 && order <= LOW && (lead == order || lead + MORE == order))
    check_widths(s, &run, order);
}

START_TEST(sums_are_those_of_plain_loops) {
  static stage s;
  randoms r = {test_seed()};
  for (size_t order = 2; order <= MOST; order++)
    for (size_t lead = 1; lead <= order; lead++)
      for (size_t n = 0; n < sizeof numbers_of_bands / sizeof *numbers_of_bands; n++)
        for (int kind = 0; kind < 4; kind++) {
          draw(&s, &r);
          check(&s, order, lead, numbers_of_bands[n], kind / 2, kind % 2);
        }
}
END_TEST

TEST_SUITE("gathers over links") {
  ADD_TESTS("links", sums_are_those_of_plain_loops);
}
