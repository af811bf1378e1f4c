/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bounds that study.h states for the fits, against normal equations in MPFR with so many
   digits that none is lost, on rows that are close together, far from 0, or as large as counts
   can be.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the inputs. */
#include <math.h>
#include <mpfr.h>
#include <stdio.h>
#include <string.h>

#include "support/hill-climb.h"
#include "support/support.h"

#define RN MPFR_RNDN

enum { ROWS = 10, PRECISION = 1000 };

/* Numbers: where the N begin and how far they reach, as powers of 2, the powers of L, then for
   each row a place in the range and the noise of L. */
enum { START, RANGE, POWER, NOISE, PLACES, NUMBERS = PLACES + ROWS };

static void draw_rows(const void *ctx, randoms *r, double *x) {
  (void)ctx;
  x[START] = random_between(r, 0, 63);
  x[RANGE] = random_between(r, 5, 62);
  x[POWER] = random_between(r, 0, 40);
  x[NOISE] = random_between(r, -40, 0);
  for (int k = 0; k < ROWS; k++) x[PLACES + k] = random_unit(r);
}

static int is_in(double x, double low, double high) {
  return x >= low && x <= high;
}

/* 0 where the numbers are no rows that fill their range. */
static int make_rows(const double *x, hr2d_study_row *rows) {
  if (!is_in(x[START], 0, 63) || !is_in(x[RANGE], 5, 62) || !is_in(x[POWER], 0, 40) ||
      !is_in(x[NOISE], -40, 0))
    return 0;
  memset(rows, 0, ROWS * sizeof *rows);
  int inner = 0;
  for (int k = 0; k < ROWS; k++) {
    const double place = k == 0 ? 0 : k == 1 ? 1 : x[PLACES + k];
    if (!is_in(place, 0, 1)) return 0;
    inner += is_in(place, 0.2, 0.8);
    rows[k].counts.elements = (uint64_t)exp2(x[START]) + (uint64_t)(exp2(x[RANGE]) * place);
    const double links = exp2(x[POWER]) * (1 + place * (3 + 7 * place)) +
                         exp2(x[POWER] + 18 + x[NOISE]) * x[PLACES + (3 * k + 1) % ROWS];
    rows[k].counts.links = 1 + (uint64_t)fmin(fabs(links), 0x1p62);
  }
  return inner > 0;
}

/* A long of some machines holds less than a count. */
static void set_count(mpfr_t z, uint64_t count) {
  mpfr_set_ui(z, (unsigned long)(count >> 32), RN);
  mpfr_mul_2ui(z, z, 32, RN);
  mpfr_add_ui(z, z, (unsigned long)(count & UINT32_MAX), RN);
}

/* sum += n^p L^q */
static void add_power(mpfr_t sum, uint64_t n, int p, uint64_t l, int q) {
  mpfr_t t, x;
  mpfr_inits2(PRECISION, t, x, (mpfr_ptr)0);
  mpfr_set_ui(t, 1, RN);
  set_count(x, n);
  for (; p > 0; p--) mpfr_mul(t, t, x, RN);
  set_count(x, l);
  for (; q > 0; q--) mpfr_mul(t, t, x, RN);
  mpfr_add(sum, sum, t, RN);
  mpfr_clears(t, x, (mpfr_ptr)0);
}

/* z = log(n/m) */
static void set_log_ratio(mpfr_t z, uint64_t n, uint64_t m) {
  mpfr_t t;
  mpfr_init2(t, PRECISION);
  set_count(z, n);
  set_count(t, m);
  mpfr_div(z, z, t, RN);
  mpfr_log(z, z, RN);
  mpfr_clear(t);
}

static void determinant(mpfr_t z, mpfr_t m[3][3]) {
  mpfr_t t;
  mpfr_init2(t, PRECISION);
  mpfr_set_zero(z, 1);
  for (int k = 0; k < 3; k++) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    mpfr_fmms(t, m[1][p], m[2][q], m[1][q], m[2][p], RN);
    mpfr_fma(z, m[0][k], t, z, RN);
  }
  mpfr_clear(t);
}

/* a, b, c by Cramer's rule. */
static void exact_fit(const hr2d_study_row *rows, mpfr_t fit[3]) {
  mpfr_t power[5], right[3], m[3][3], whole;
  mpfr_init2(whole, PRECISION);
  for (int p = 0; p < 5; p++) {
    mpfr_init2(power[p], PRECISION);
    mpfr_set_zero(power[p], 1);
    for (int k = 0; k < ROWS; k++) add_power(power[p], rows[k].counts.elements, p, 1, 0);
  }
  for (int p = 0; p < 3; p++) {
    mpfr_init2(right[p], PRECISION);
    mpfr_set_zero(right[p], 1);
    for (int k = 0; k < ROWS; k++)
      add_power(right[p], rows[k].counts.elements, p, rows[k].counts.links, 1);
    for (int q = 0; q < 3; q++) mpfr_init2(m[p][q], PRECISION);
  }
  for (int column = -1; column < 3; column++) {
    for (int p = 0; p < 3; p++)
      for (int q = 0; q < 3; q++) mpfr_set(m[p][q], q == column ? right[p] : power[p + q], RN);
    if (column < 0) {
      determinant(whole, m);
      continue;
    }
    determinant(fit[column], m);
    mpfr_div(fit[column], fit[column], whole, RN);
  }
  for (int p = 0; p < 5; p++) mpfr_clear(power[p]);
  for (int p = 0; p < 3; p++) {
    mpfr_clear(right[p]);
    for (int q = 0; q < 3; q++) mpfr_clear(m[p][q]);
  }
  mpfr_clear(whole);
}

static double off(double value, const mpfr_t exact, double size) {
  mpfr_t d;
  mpfr_init2(d, PRECISION);
  mpfr_sub_d(d, exact, value, RN);
  const double error = fabs(mpfr_get_d(d, RN)) / size;
  mpfr_clear(d);
  return error;
}

/* The slope of logarithms, and the sizes of both. */
static void exact_slope(const hr2d_study_row *rows, mpfr_t slope, double *size) {
  mpfr_t x, y, sum[4];
  double max_x = 0, max_y = 0;
  mpfr_inits2(PRECISION, x, y, sum[0], sum[1], sum[2], sum[3], (mpfr_ptr)0);
  for (int k = 0; k < 4; k++) mpfr_set_zero(sum[k], 1);
  for (int k = 0; k < ROWS; k++) {
    set_log_ratio(x, rows[k].counts.elements, rows[0].counts.elements);
    set_log_ratio(y, rows[k].counts.links, rows[0].counts.links);
    max_x = fmax(max_x, fabs(mpfr_get_d(x, RN)));
    max_y = fmax(max_y, fabs(mpfr_get_d(y, RN)));
    mpfr_add(sum[0], sum[0], x, RN);
    mpfr_add(sum[1], sum[1], y, RN);
    mpfr_fma(sum[2], x, x, sum[2], RN);
    mpfr_fma(sum[3], x, y, sum[3], RN);
  }
  mpfr_mul_ui(sum[2], sum[2], ROWS, RN);
  mpfr_mul_ui(sum[3], sum[3], ROWS, RN);
  mpfr_fms(x, sum[0], sum[0], sum[2], RN);
  mpfr_fms(y, sum[0], sum[1], sum[3], RN);
  mpfr_div(slope, y, x, RN);
  *size = max_y / max_x;
  mpfr_clears(x, y, sum[0], sum[1], sum[2], sum[3], (mpfr_ptr)0);
}

/* The largest error of a, b, c and the slope, in what study.h allows per unit. */
static double fit_error(const void *ctx, const double *x) {
  (void)ctx;
  hr2d_study_row rows[ROWS];
  hr2d_study_fit fit;
  if (!make_rows(x, rows)) return -1;
  if (hr2d_study_fit_rows(rows, ROWS, &fit)) return INFINITY;
  mpfr_t exact[3], slope;
  for (int k = 0; k < 3; k++) mpfr_init2(exact[k], PRECISION);
  mpfr_init2(slope, PRECISION);
  exact_fit(rows, exact);
  double spread = 0, size;
  exact_slope(rows, slope, &size);
  const uint64_t first = rows[0].counts.links, min = rows[0].counts.elements;
  for (int k = 0; k < ROWS; k++) {
    const uint64_t links = rows[k].counts.links;
    spread = fmax(spread, (double)(links > first ? links - first : first - links));
  }
  const double half = 0.5 * (double)(rows[1].counts.elements - min), l = (double)first;
  const double ratio = ((double)min + half) / half;
  double worst = off(fit.a, exact[0], spread * pow(1 + ratio, 2) + l);
  worst = fmax(worst, off(fit.b, exact[1], spread * (1 + 2 * ratio) / half));
  worst = fmax(worst, off(fit.c, exact[2], spread / half / half));
  if (size > 0) worst = fmax(worst, off(fit.slope, slope, size));
  for (int k = 0; k < 3; k++) mpfr_clear(exact[k]);
  mpfr_clear(slope);
  return worst;
}

START_TEST(fits_hold_their_bounds) {
  const hill h = {"fit", NUMBERS, 0, draw_rows, fit_error, NULL};
  hill_hold(&h, (hill_effort){2000, 6, 300}, 950, 1e-14);
}
END_TEST

/* Counts that doubles cannot tell apart, and those that they can, but not their x. */
START_TEST(close_and_uneven_counts) {
  hr2d_study_row rows[5] = {{.epsilon = 1}};
  hr2d_study_fit fit;
  for (uint64_t k = 0; k < 5; k++) {
    rows[k].counts.elements = 1000000000000000000u + 3 * k;
    rows[k].counts.links = 900000000000000000u + 2 * k + 7 * k * k;
  }
  ck_assert_int_eq(hr2d_study_fit_rows(rows, 5, &fit), HR2D_OK);
  ck_assert_double_eq_tol(fit.c, 7. / 9, 1e-12);
  ck_assert_double_eq_tol(fit.r2, 1, 1e-14);
  rows[0].counts.elements = 1;
  rows[1].counts.elements = 2;
  ck_assert_int_eq(hr2d_study_fit_rows(rows, 3, &fit), HR2D_EINVAL);
}
END_TEST

TEST_SUITE("bounds of fits") {
  ADD_TESTS("fits", fits_hold_their_bounds, close_and_uneven_counts);
}
