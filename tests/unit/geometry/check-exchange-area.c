/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas against MPFR on a million hard pairs, and on the worst pairs that
   hill climbing finds; crossed strings in doubles must fail in the same harness.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the pairs. */
#include <check.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "geometry/exchange-area.h"
#include "independent/mpfr-exchange.h"
#include "support/pair-classes.h"
#include "support/plane.h"
#include "support/support.h"

/* The bar of hr2d_exchange_area()'s documentation, and where AF is below DBL_MIN
   the steps of the denormal numbers besides. */
#define BAR            4e-15
#define DENORMAL_STEPS 2

typedef double area_fn(const hr2d_segment *i, const hr2d_segment *j);

typedef struct worst {
  double error; /* relative; infinite where 0 and not 0 disagree */
  pair at;
  int failures;
  int seen; /* pairs with AF > 0 */
} worst;

static double relative_error(area_fn *area_of, const pair *p, int *seen) {
  mpfr_t reference;
  mpfr_init2(reference, MPFR_PREC_MIN);
  mpfr_exchange_area(reference, &p->i, &p->j);
  const double area = area_of(&p->i, &p->j);
  double error;
  *seen = mpfr_sgn(reference) > 0;
  if (!*seen)
    error = area == 0 ? 0 : INFINITY;
  else if (isnan(area))
    error = INFINITY;
  else {
    error = mpfr_relative_error(area, reference);
    const double size = mpfr_get_d(reference, MPFR_RNDN);
    if (isinf(size) && area == size) error = 0;
    if (size < DBL_MIN && fabs(area - size) <= DENORMAL_STEPS * DBL_TRUE_MIN) error = 0;
  }
  mpfr_clear(reference);
  return error;
}

static void note(worst *w, const pair *p, double error, int seen) {
  w->seen += seen;
  w->failures += !(error <= BAR);
  if (error > w->error) {
    w->error = error;
    w->at = *p;
  }
}

static void print_pair(const char *class, const worst *w) {
  const pair *p = &w->at;
  fprintf(stderr, "%s: error %.3g at\n  %a %a  %a %a\n  %a %a  %a %a\n", class, w->error,
          p->i.a.x, p->i.a.y, p->i.b.x, p->i.b.y, p->j.a.x, p->j.a.y, p->j.b.x, p->j.b.y);
}

static worst sample(area_fn *area, const pair_class *class, randoms r, int count) {
  worst w = {0};
  for (int k = 0; k < count; k++) {
    const pair p = draw_pair(class, &r);
    int seen;
    const double error = relative_error(area, &p, &seen);
    note(&w, &p, error, seen);
  }
  return w;
}

START_TEST(every_class_holds_the_bar) {
  const pair_class *class = &pair_classes[_i];
  const int count = test_count(11500 * class->share);
  const worst w = sample(hr2d_exchange_area, class, randoms_stream(test_seed(), _i), count);
  printf("%-22s %8d pairs, %8d with AF > 0, worst error %.2e\n", class->name, count, w.seen,
         w.error);
  if (w.failures) print_pair(class->name, &w);
  ck_assert_int_eq(w.failures, 0);
  ck_assert_int_gt(w.seen, 0);
}
END_TEST

/* Another pair nearby: a few coordinates by ulps, by a small factor or by a step. */
static pair neighbour(randoms *r, pair p) {
  double *at[8] = {&p.i.a.x, &p.i.a.y, &p.i.b.x, &p.i.b.y,
                   &p.j.a.x, &p.j.a.y, &p.j.b.x, &p.j.b.y};
  for (int moves = 1 + random_below(r, 3); moves > 0; moves--) {
    double *x = at[random_below(r, 8)];
    const double other = *at[random_below(r, 8)];
    const double span = random_below(r, 2) ? *x : *x - other;
    const double moved =
        random_below(r, 2) ? random_nudge(r, *x, 4) : *x + span * random_power(r, -16, -0.5);
    if (isfinite(moved)) *x = moved;
  }
  return p;
}

static worst climb(area_fn *area, const pair_class *class, randoms *r, int climbs, int steps) {
  worst best = {0};
  for (int k = 0; k < climbs; k++) {
    pair p = draw_pair(class, r);
    int seen;
    double error = relative_error(area, &p, &seen);
    for (int step = 0; step < steps; step++) {
      const pair q = neighbour(r, p);
      const double e = relative_error(area, &q, &seen);
      note(&best, &q, e, seen);
      if (e >= error) {
        p = q;
        error = e;
      }
    }
  }
  return best;
}

START_TEST(hill_climbing_holds_the_bar) {
  const pair_class *class = &pair_classes[_i];
  randoms r = randoms_stream(test_seed(), 1000 + _i);
  const worst w = climb(hr2d_exchange_area, class, &r, test_count(10), 400);
  printf("%-22s hill climbing, worst error %.2e\n", class->name, w.error);
  if (w.failures) print_pair(class->name, &w);
  ck_assert_int_eq(w.failures, 0);
}
END_TEST

static double strings(const hr2d_segment *i, const hr2d_segment *j) {
  const hr2d_segment f = plane_clipped(*i, *j), g = plane_clipped(*j, *i);
  return 0.5 * (plane_distance(f.a, g.a) + plane_distance(f.b, g.b) - plane_distance(f.a, g.b) -
                plane_distance(f.b, g.a));
}

/* Negative control: the harness finds the digits that crossed strings lose. */
START_TEST(crossed_strings_fail_the_bar) {
  const worst w = sample(strings, &pair_classes[_i], randoms_stream(test_seed(), _i), 2000);
  printf("%-22s crossed strings in doubles fail %d of 2000\n", pair_classes[_i].name,
         w.failures);
  ck_assert_int_gt(w.failures, 20);
}
END_TEST

START_TEST(swapping_changes_no_bit) {
  const pair_class *class = &pair_classes[_i];
  randoms r = randoms_stream(test_seed(), 2000 + _i);
  for (int k = test_count(20000); k > 0; k--) {
    const pair p = draw_pair(class, &r);
    const double ij = hr2d_exchange_area(&p.i, &p.j), ji = hr2d_exchange_area(&p.j, &p.i);
    if (ij == ji && signbit(ij) == signbit(ji)) continue;
    print_pair(class->name, &(worst){.at = p});
    ck_abort_msg("%a and %a", ij, ji);
  }
}
END_TEST

START_TEST(a_batch_has_the_same_bits) {
  enum { PAIRS = 1000 };
  const pair_class *class = &pair_classes[_i];
  randoms r = randoms_stream(test_seed(), 3000 + _i);
  static hr2d_element elements[2 * PAIRS];
  static hr2d_pair pairs[PAIRS];
  static double area[PAIRS];
  for (uint32_t k = 0; k < PAIRS; k++) {
    /* Every other pair generic, so that both paths meet in a block. */
    const pair p = draw_pair(k & 1 ? class : &pair_classes[0], &r);
    elements[2 * k] = (hr2d_element){.a = p.i.a, .b = p.i.b};
    elements[2 * k + 1] = (hr2d_element){.a = p.j.a, .b = p.j.b};
    pairs[k] = (hr2d_pair){2 * k + 1, 2 * k};
  }
  for (size_t count = 0; count <= PAIRS; count += 1 + count / 2) {
    for (size_t k = 0; k < PAIRS; k++) area[k] = -7;
    hr2di_exchange_areas(elements, pairs, count, area);
    for (size_t k = 0; k < PAIRS; k++) {
      const hr2d_segment i = {elements[2 * k].a, elements[2 * k].b};
      const hr2d_segment j = {elements[2 * k + 1].a, elements[2 * k + 1].b};
      ck_assert(area[k] == (k < count ? hr2d_exchange_area(&i, &j) : -7));
    }
  }
}
END_TEST

TEST_SUITE("exchange area") {
  REPEAT_TESTS(pair_class_count, "sampling", every_class_holds_the_bar,
               crossed_strings_fail_the_bar);
  REPEAT_TESTS(pair_class_count, "climbing", hill_climbing_holds_the_bar);
  REPEAT_TESTS(pair_class_count, "bits", swapping_changes_no_bit, a_batch_has_the_same_bits);
}
