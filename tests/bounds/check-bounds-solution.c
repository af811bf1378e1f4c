/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bound that solve.h states for a solution, against the discrete equation.  The equation is
   made from the links and their closure and solved by elimination in MPFR: entry by entry, not
   by push and pull.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the rooms. */
#include <math.h>
#include <mpfr.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/hill-climb.h"
#include "support/support.h"

#define RN MPFR_RNDN

enum { PRECISION = 160, MOST = 200 };

/* The bound is this and the tolerance, over 1 − ρ. */
#define ROUNDINGS 1e-15

static const double corner[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};

/* Numbers: −log₁₀(1−ρ) and E of each wall of a square, and ε. */
enum { LOSS, EMISSION = 4, EPSILON = 8, NUMBERS = 9 };

static void draw_room(const void *ctx, randoms *r, double *x) {
  (void)ctx;
  for (int k = 0; k < 4; k++) {
    x[LOSS + k] = random_between(r, 0, 6);
    x[EMISSION + k] = random_below(r, 2) ? random_power(r, -6, 0) : 0;
  }
  x[EPSILON] = random_between(r, 0.7, 2);
}

typedef struct dense {
  const hr2d_element *element;
  uint32_t leaf[MOST];
  int leaves;
  mpfr_t *row;   /* leaves × (leaves + 1): the last is E */
  mpfr_t *below; /* per element: the row sum by the links at it and below it */
} dense;

static int is_below(const hr2d_hierarchy *h, uint32_t leaf, uint32_t top) {
  for (uint32_t e = leaf;; e = hr2d_element_parent(h, e)) {
    if (e == top) return 1;
    if (e == hr2d_element_parent(h, e)) return 0;
  }
}

static mpfr_ptr entry(dense *d, int k, int m) {
  return d->row[k * (d->leaves + 1) + m];
}

/* Multiplies `part` by the share of a leaf in what comes from above to `top`, per length.  What
   comes from above to an element of a closed room is 1 − below; differences below 1e-14 are
   roundings. */
static void take_share(const dense *d, const hr2d_hierarchy *h, uint32_t leaf, uint32_t top,
                       mpfr_t part) {
  mpfr_t mine, other, mean;
  mpfr_inits2(PRECISION, mine, other, mean, (mpfr_ptr)0);
  for (uint32_t e = leaf; e != top; e = hr2d_element_parent(h, e)) {
    const uint32_t first = d->element[hr2d_element_parent(h, e)].child;
    mpfr_ui_sub(mine, 1, d->below[e], RN);
    mpfr_ui_sub(other, 1, d->below[e == first ? first + 1 : first], RN);
    mpfr_sub(mean, mine, other, RN);
    if (fabs(mpfr_get_d(mean, RN)) <= 1e-14) continue;
    mpfr_add(mean, mine, other, RN);
    mpfr_div_2ui(mean, mean, 1, RN);
    mpfr_mul(part, part, mine, RN);
    mpfr_div(part, part, mean, RN);
  }
  mpfr_clears(mine, other, mean, (mpfr_ptr)0);
}

/* Sets `below` from the links; elements have higher numbers than their parents. */
static void sum_below(dense *d, const test_links *t, size_t elements) {
  mpfr_t part;
  mpfr_init2(part, PRECISION);
  d->below = malloc(elements * sizeof *d->below);
  for (size_t e = 0; e < elements; e++) {
    mpfr_init2(d->below[e], PRECISION);
    mpfr_set_zero(d->below[e], 1);
  }
  for (uint64_t k = 0; k < 2 * hr2d_linkset_size(t->links); k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k / 2);
    const uint32_t e = k % 2 ? link.pair.second : link.pair.first;
    mpfr_set_d(part, link.exchange_area, RN);
    mpfr_div_d(part, part, d->element[e].length, RN);
    mpfr_add(d->below[e], d->below[e], part, RN);
  }
  for (size_t e = elements; e-- > 0;) {
    const uint32_t child = d->element[e].child;
    if (!child) continue;
    mpfr_add(part, d->below[child], d->below[child + 1], RN);
    mpfr_div_2ui(part, part, 1, RN);
    mpfr_add(d->below[e], d->below[e], part, RN);
  }
  mpfr_clear(part);
}

/* Adds −K of a link from `from` to `to`. */
static void spread_link(dense *d, const hr2d_hierarchy *h, double area, uint32_t to,
                        uint32_t from) {
  mpfr_t part;
  mpfr_init2(part, PRECISION);
  for (int k = 0; k < d->leaves; k++) {
    if (!is_below(h, d->leaf[k], to)) continue;
    for (int m = 0; m < d->leaves; m++) {
      if (!is_below(h, d->leaf[m], from)) continue;
      mpfr_set_d(part, area, RN);
      mpfr_mul_d(part, part, d->element[d->leaf[m]].length, RN);
      mpfr_div_d(part, part, d->element[from].length, RN);
      mpfr_div_d(part, part, d->element[to].length, RN);
      take_share(d, h, d->leaf[k], to, part);
      take_share(d, h, d->leaf[m], from, part);
      mpfr_sub(entry(d, k, m), entry(d, k, m), part, RN);
    }
  }
  mpfr_clear(part);
}

/* 1 − ρ(K + D) with rows of K + D that sum to 1, as the room is closed. */
static void close_rows(dense *d, const hr2d_scene *scene) {
  mpfr_t sum;
  mpfr_init2(sum, PRECISION);
  for (int k = 0; k < d->leaves; k++) {
    const uint32_t patch = d->element[d->leaf[k]].patch;
    mpfr_set_ui(sum, 1, RN);
    for (int m = 0; m < d->leaves; m++) mpfr_add(sum, sum, entry(d, k, m), RN);
    mpfr_sub(entry(d, k, k), entry(d, k, k), sum, RN);
    for (int m = 0; m < d->leaves; m++)
      mpfr_mul_d(entry(d, k, m), entry(d, k, m), hr2d_scene_reflectance(scene, patch, 0), RN);
    mpfr_add_ui(entry(d, k, k), entry(d, k, k), 1, RN);
    mpfr_set_d(entry(d, k, d->leaves), hr2d_scene_emission(scene, patch, 0), RN);
  }
  mpfr_clear(sum);
}

/* Gauss and Jordan; rows are dominated by their diagonals. */
static void eliminate(dense *d) {
  mpfr_t part;
  mpfr_init2(part, PRECISION);
  for (int p = 0; p < d->leaves; p++)
    for (int k = 0; k < d->leaves; k++) {
      if (k == p) continue;
      mpfr_div(part, entry(d, k, p), entry(d, p, p), RN);
      mpfr_neg(part, part, RN);
      for (int m = p; m <= d->leaves; m++)
        mpfr_fma(entry(d, k, m), part, entry(d, p, m), entry(d, k, m), RN);
    }
  for (int k = 0; k < d->leaves; k++)
    mpfr_div(entry(d, k, d->leaves), entry(d, k, d->leaves), entry(d, k, k), RN);
  mpfr_clear(part);
}

/* The larger of ‖B − B_d‖/‖B_d‖ over the leaves and of the same for the averages of the
   patches. */
static double distance(dense *d, const hr2d_solution *solution) {
  double error = 0, size = 0, average[4] = {0}, off = 0;
  mpfr_t difference;
  mpfr_init2(difference, PRECISION);
  for (int k = 0; k < d->leaves; k++) {
    const hr2d_element *e = &d->element[d->leaf[k]];
    const double exact = mpfr_get_d(entry(d, k, d->leaves), RN);
    mpfr_sub_d(difference, entry(d, k, d->leaves),
               hr2d_solution_element(solution, d->leaf[k], 0), RN);
    error += e->length * pow(mpfr_get_d(difference, RN), 2);
    size += e->length * exact * exact;
    average[e->patch] += e->length * exact;
  }
  for (size_t k = 0; k < 4; k++)
    off = fmax(off, fabs(hr2d_solution_average(solution, k, 0) - average[k]));
  mpfr_clear(difference);
  return size > 0 ? fmax(sqrt(error / size), off / sqrt(4 * size)) : error;
}

static void make_dense(dense *d, const test_links *t) {
  const uint64_t elements = hr2d_hierarchy_count(t->hierarchy).elements;
  d->element = hr2d_hierarchy_elements(t->hierarchy);
  d->leaves = 0;
  for (uint32_t e = 0; e < elements; e++)
    if (!d->element[e].child) d->leaf[d->leaves++] = e;
  const int entries = d->leaves * (d->leaves + 1);
  d->row = malloc((size_t)entries * sizeof *d->row);
  for (int k = 0; k < entries; k++) {
    mpfr_init2(d->row[k], PRECISION);
    mpfr_set_zero(d->row[k], 1);
  }
  sum_below(d, t, elements);
  for (uint64_t k = 0; k < hr2d_linkset_size(t->links); k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k);
    spread_link(d, t->hierarchy, link.exchange_area, link.pair.first, link.pair.second);
    spread_link(d, t->hierarchy, link.exchange_area, link.pair.second, link.pair.first);
  }
  close_rows(d, t->scene);
}

/* The error times 1 − ρ. */
static double solution_error(const void *ctx, const double *x) {
  (void)ctx;
  double patch[4][6], max = 0, light = 0;
  if (!(x[EPSILON] >= 0.7 && x[EPSILON] <= 4)) return -1;
  for (int k = 0; k < 4; k++) {
    if (!(x[LOSS + k] >= 0 && x[LOSS + k] <= 8 && x[EMISSION + k] >= 0 &&
          x[EMISSION + k] < 1e9))
      return -1;
    const double rho = 1 - pow(10, -x[LOSS + k]);
    const double wall[6] = {corner[k][0],     corner[k][1],    corner[k + 1][0],
                            corner[k + 1][1], x[EMISSION + k], rho};
    for (int m = 0; m < 6; m++) patch[k][m] = wall[m];
    max = fmax(max, rho);
    light = fmax(light, x[EMISSION + k]);
  }
  if (light < 1e-100) return -1;
  test_links t =
      test_make_links(test_scene((const double(*)[6])patch, 4), NULL, NULL, NULL, NULL);
  double error = -1;
  test_refine(&t, x[EPSILON], 3);
  hr2d_solution *solution = test_solve(&t, 1);
  dense d;
  make_dense(&d, &t);
  eliminate(&d);
  error = distance(&d, solution) * (1 - max);
  for (int k = 0; k < d.leaves * (d.leaves + 1); k++) mpfr_clear(d.row[k]);
  free(d.row);
  for (uint64_t e = 0; e < hr2d_hierarchy_count(t.hierarchy).elements; e++)
    mpfr_clear(d.below[e]);
  free(d.below);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  return error;
}

START_TEST(solutions_hold_their_bound) {
  const hill h = {"solution", NUMBERS, 0, draw_room, solution_error, NULL};
  const double part = test_multiplier();
  hill_hold(&h, (hill_effort){400, 6, part < 0.1 ? 4 : 100}, 980, 1e-15 + ROUNDINGS);
}
END_TEST

TEST_SUITE("bounds of solutions") {
  ADD_TESTS("solutions", solutions_hold_their_bound);
}
