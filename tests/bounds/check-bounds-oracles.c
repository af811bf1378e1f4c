/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bounds that oracle.h states for size, size2 and bf, against MPFR, on random and
   on hill-climbed elements.  Ends, centres and lengths of these elements vary independently, as
   in no hierarchy.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the inputs. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "independent/mpfr-exchange.h"
#include "support/elements.h"
#include "support/hill-climb.h"
#include "support/plane.h"
#include "support/support.h"

#define ROUNDING 0x1p-53
#define RN       MPFR_RNDN

/* A spread of 2^800 in differences, squared, beside a double's digits. */
enum { PRECISION = 2400 };

/* Ends and centres of two elements, their lengths, and the brightness of the second. */
enum { LENGTHS = 12, BRIGHTNESS = 14, NUMBERS = 15 };

static hr2d_element element_at(const double *x, int k) {
  return (hr2d_element){.a = hill_point(x, 2 * k),
                        .b = hill_point(x, 2 * k + 1),
                        .centre = hill_point(x, 4 + k),
                        .length = x[LENGTHS + k]};
}

static void draw_elements(const void *ctx, randoms *r, double *x) {
  element_draw(ctx, r, x);
  for (int k = 0; k < 2; k++) {
    const double *a = x + 4 * k, *b = a + 2;
    x[8 + 2 * k] = 0.5 * (a[0] + b[0]);
    x[9 + 2 * k] = 0.5 * (a[1] + b[1]);
    x[LENGTHS + k] = hypot(b[0] - a[0], b[1] - a[1]);
  }
  x[BRIGHTNESS] = random_unit(r);
}

/* In units of a scene, and within a factor 2^800 of each other, as oracle.h requires. */
static int are_elements(const double *x) {
  return element_in_range(x, LENGTHS, 800) && x[LENGTHS] > 0 && x[LENGTHS] < 6 &&
         x[LENGTHS + 1] > 0 && x[LENGTHS + 1] < 6;
}

/* The estimate; negative where decisions disagree with it. */
static double ask(const hr2d_oracle *oracle, const double *x) {
  const double brightness[2] = {0, x[BRIGHTNESS]};
  const element_pair p = {{element_at(x, 0), element_at(x, 1)}, brightness};
  const hr2d_batch batch = element_batch(&p);
  const double error = element_estimate(oracle, &batch);
  const double steps[] = {error, nextafter(error, 0), nextafter(error, INFINITY), error * 0.7};
  for (int k = 0; k < 4 && oracle->accept; k++)
    if (element_accepted(oracle, &batch, steps[k]) != (error <= steps[k])) return -1;
  return error;
}

/* r of the centres; 0 where they coincide. */
static void distance_of(mpfr_t r, const double *x) {
  mpfr_distance(r, hill_point(x, 4), hill_point(x, 5));
  mpfr_prec_round(r, 300, RN);
}

static double against(double got, const mpfr_t exact) {
  return got < 0 ? INFINITY : mpfr_double_error(got, exact);
}

static double size_error(const double *x, int power) {
  if (!are_elements(x)) return -1;
  const double got = ask(power == 1 ? hr2d_oracle_size() : hr2d_oracle_size2(), x);
  mpfr_t r;
  mpfr_init2(r, MPFR_PREC_MIN);
  distance_of(r, x);
  double error = got == INFINITY ? 0 : INFINITY;
  if (!mpfr_zero_p(r)) {
    mpfr_d_div(r, fmax(x[LENGTHS], x[LENGTHS + 1]), r, RN);
    if (power == 2) mpfr_sqr(r, r, RN);
    error = against(got, r);
  }
  mpfr_clear(r);
  return error;
}

static double error_of_size(const void *ctx, const double *x) {
  (void)ctx;
  return size_error(x, 1);
}

static double error_of_size2(const void *ctx, const double *x) {
  (void)ctx;
  return size_error(x, 2);
}

static hr2d_segment segment_at(const double *x, int k) {
  return (hr2d_segment){hill_point(x, 2 * k), hill_point(x, 2 * k + 1)};
}

/* AF/min(A_x, A_y)·B_y of some area. */
static void exact_bf(mpfr_t value, const double *x, const mpfr_t area) {
  mpfr_set_prec(value, 300);
  mpfr_div_d(value, area, fmin(x[LENGTHS], x[LENGTHS + 1]), RN);
  mpfr_mul_d(value, value, x[BRIGHTNESS], RN);
}

/* What an AF below DBL_MIN may be off by: its bound, and one step, are 20 steps. */
static double few_steps(const double *x) {
  return 20 * DBL_TRUE_MIN / fmin(x[LENGTHS], x[LENGTHS + 1]) * x[BRIGHTNESS];
}

static double error_of_bf(const void *ctx, const double *x) {
  (void)ctx;
  if (!are_elements(x) || !(x[BRIGHTNESS] >= 0 && x[BRIGHTNESS] <= 1)) return -1;
  const double got = ask(hr2d_oracle_bf(), x);
  if (x[BRIGHTNESS] == 0) return got == 0 ? 0 : INFINITY;
  const hr2d_segment i = segment_at(x, 0), j = segment_at(x, 1);
  mpfr_t area, exact;
  mpfr_inits2(MPFR_PREC_MIN, area, exact, (mpfr_ptr)0);
  mpfr_exchange_area(area, &i, &j);
  exact_bf(exact, x, area);
  double error;
  if (mpfr_cmp_d(area, DBL_MIN) >= 0) {
    error = against(got, exact);
  } else {
    mpfr_sub_d(exact, exact, got, RN);
    error = fabs(mpfr_get_d(exact, RN)) <= few_steps(x) + DBL_TRUE_MIN ? 0 : INFINITY;
  }
  mpfr_clears(area, exact, (mpfr_ptr)0);
  return error;
}

static const struct {
  const char *name;
  double (*error)(const void *ctx, const double *x);
  double bound; /* of oracle.h */
} oracles[] = {{"size", error_of_size, 5 * ROUNDING},
               {"size2", error_of_size2, 10 * ROUNDING},
               {"bf", error_of_bf, 39 * ROUNDING}};
enum { ORACLES = sizeof oracles / sizeof *oracles };

START_TEST(estimates_hold_their_bound) {
  const pair_class *class = &pair_classes[_i / ORACLES];
  char name[80];
  snprintf(name, sizeof name, "%s, %s", oracles[_i % ORACLES].name, class->name);
  const hill h = {name, NUMBERS, 6, draw_elements, oracles[_i % ORACLES].error, class};
  hill_hold(&h, (hill_effort){1000, 8, 600}, 600 + _i, oracles[_i % ORACLES].bound);
}
END_TEST

static int are_in_front(hr2d_segment i, hr2d_segment j) {
  return hr2d_orientation(i.a, i.b, j.a) >= 0 && hr2d_orientation(i.a, i.b, j.b) >= 0;
}

/* Negative control: crossed strings in doubles. */
static double error_of_plain_bf(const void *ctx, const double *x) {
  const hr2d_segment i = segment_at(x, 0), j = segment_at(x, 1);
  if (!(error_of_bf(ctx, x) > 0 && are_in_front(i, j) && are_in_front(j, i))) return -1;
  const double plain = 0.5 *
                       (plane_distance(i.a, j.a) + plane_distance(i.b, j.b) -
                        plane_distance(i.a, j.b) - plane_distance(i.b, j.a)) /
                       fmin(x[LENGTHS], x[LENGTHS + 1]) * x[BRIGHTNESS];
  mpfr_t area, exact;
  mpfr_inits2(MPFR_PREC_MIN, area, exact, (mpfr_ptr)0);
  mpfr_exchange_area(area, &i, &j);
  exact_bf(exact, x, area);
  const double error = mpfr_double_error(plain, exact);
  mpfr_clears(area, exact, (mpfr_ptr)0);
  return error;
}

START_TEST(rounded_strings_fail) {
  const hill h = {"plain bf", NUMBERS, 6, draw_elements, error_of_plain_bf, &pair_classes[0]};
  hill_exceed(&h, (hill_effort){0, 10, 400}, 700, 1e-6);
}
END_TEST

TEST_SUITE("bounds of oracles") {
  REPEAT_TESTS(ORACLES * pair_class_count, "oracles", estimates_hold_their_bound);
  ADD_TESTS("oracles", rounded_strings_fail);
}
