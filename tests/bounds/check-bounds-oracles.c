/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bounds that oracle.h states for size, size2, bf and l1-grid, against MPFR, on random and
   on hill-climbed elements.  Ends, centres and lengths of these elements vary independently, as
   in no hierarchy.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the inputs. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "independent/mpfr-exchange.h"
#include "support/elements.h"
#include "support/hill-climb.h"
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

/* value ← value · |(b−a) × d| / (length r) */
static void times_cosine(mpfr_t value, const hr2d_element *e, const mpfr_t dx, const mpfr_t dy,
                         const mpfr_t r) {
  mpfr_t u, v;
  mpfr_inits2(PRECISION, u, v, (mpfr_ptr)0);
  mpfr_set_d(u, e->b.x, RN);
  mpfr_sub_d(u, u, e->a.x, RN);
  mpfr_mul(u, u, dy, RN);
  mpfr_set_d(v, e->b.y, RN);
  mpfr_sub_d(v, v, e->a.y, RN);
  mpfr_mul(v, v, dx, RN);
  mpfr_sub(u, u, v, RN);
  mpfr_abs(u, u, RN);
  mpfr_div_d(u, u, e->length, RN);
  mpfr_div(u, u, r, RN);
  mpfr_mul(value, value, u, RN);
  mpfr_clears(u, v, (mpfr_ptr)0);
}

static void exact_bf(mpfr_t value, const double *x, const mpfr_t r) {
  const hr2d_element i = element_at(x, 0), j = element_at(x, 1);
  mpfr_t dx, dy;
  mpfr_inits2(PRECISION, dx, dy, (mpfr_ptr)0);
  mpfr_set_d(dx, j.centre.x, RN);
  mpfr_sub_d(dx, dx, i.centre.x, RN);
  mpfr_set_d(dy, j.centre.y, RN);
  mpfr_sub_d(dy, dy, i.centre.y, RN);
  mpfr_set_prec(value, 300);
  mpfr_set_d(value, fmax(i.length, j.length), RN);
  mpfr_mul_d(value, value, x[BRIGHTNESS], RN);
  mpfr_div_2ui(value, value, 1, RN);
  mpfr_div(value, value, r, RN);
  times_cosine(value, &i, dx, dy, r);
  times_cosine(value, &j, dx, dy, r);
  mpfr_clears(dx, dy, (mpfr_ptr)0);
}

static double error_of_bf(const void *ctx, const double *x) {
  (void)ctx;
  if (!are_elements(x) || !(x[BRIGHTNESS] >= 0 && x[BRIGHTNESS] <= 1)) return -1;
  const double got = ask(hr2d_oracle_bf(), x);
  if (x[BRIGHTNESS] == 0) return got == 0 ? 0 : INFINITY;
  mpfr_t r, exact;
  mpfr_inits2(MPFR_PREC_MIN, r, exact, (mpfr_ptr)0);
  distance_of(r, x);
  double error = got == INFINITY ? 0 : INFINITY;
  if (!mpfr_zero_p(r)) {
    exact_bf(exact, x, r);
    error = against(got, exact);
  }
  mpfr_clears(r, exact, (mpfr_ptr)0);
  return error;
}

static const struct {
  const char *name;
  double (*error)(const void *ctx, const double *x);
  double bound; /* of oracle.h */
} oracles[] = {{"size", error_of_size, 5 * ROUNDING},
               {"size2", error_of_size2, 10 * ROUNDING},
               {"bf", error_of_bf, 24 * ROUNDING}};
enum { ORACLES = sizeof oracles / sizeof *oracles };

START_TEST(estimates_hold_their_bound) {
  const pair_class *class = &pair_classes[_i / ORACLES];
  char name[80];
  snprintf(name, sizeof name, "%s, %s", oracles[_i % ORACLES].name, class->name);
  const hill h = {name, NUMBERS, 6, draw_elements, oracles[_i % ORACLES].error, class};
  hill_hold(&h, (hill_effort){1000, 8, 600}, 600 + _i, oracles[_i % ORACLES].bound);
}
END_TEST

/* Negative control: cosines from rounded products, of G in plain doubles. */
static double error_of_plain_bf(const void *ctx, const double *x) {
  const hr2d_element i = element_at(x, 0), j = element_at(x, 1);
  const double dx = j.centre.x - i.centre.x, dy = j.centre.y - i.centre.y, r = hypot(dx, dy);
  if (!(error_of_bf(ctx, x) > 0 && r > 0 && x[BRIGHTNESS] > 0)) return -1;
  const double cos_i = fabs((i.b.x - i.a.x) * dy - (i.b.y - i.a.y) * dx) / (r * i.length);
  const double cos_j = fabs((j.b.x - j.a.x) * dy - (j.b.y - j.a.y) * dx) / (r * j.length);
  const double plain = cos_i * cos_j / (2 * r) * fmax(i.length, j.length) * x[BRIGHTNESS];
  mpfr_t exact, exact_r;
  mpfr_inits2(MPFR_PREC_MIN, exact, exact_r, (mpfr_ptr)0);
  distance_of(exact_r, x);
  exact_bf(exact, x, exact_r);
  const double error = mpfr_double_error(plain, exact);
  mpfr_clears(exact, exact_r, (mpfr_ptr)0);
  return error;
}

START_TEST(rounded_cosines_fail) {
  const hill h = {"plain bf", NUMBERS, 6, draw_elements, error_of_plain_bf, &pair_classes[0]};
  hill_exceed(&h, (hill_effort){0, 10, 400}, 700, 1e-6);
}
END_TEST

TEST_SUITE("bounds of oracles") {
  REPEAT_TESTS(ORACLES * pair_class_count, "oracles", estimates_hold_their_bound);
  ADD_TESTS("oracles", rounded_cosines_fail);
}
