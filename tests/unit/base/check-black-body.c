/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of a black body's emission between two wavelengths: published tables, and the series
   in numbers of 256 bits. */
#include <float.h>
#include <math.h>
#include <mpfr.h>

#include "support/support.h"

enum { BITS = 256 };

/* f(λT), λT in µm K, to the five digits that textbooks of heat transfer tabulate.  Their c₂ is
   up to 2e-5 larger, which is one unit of their last digit.  At Wien's 2897.772 the part is
   0.250055. */
static const double table[][2] = {{1000, .00032},  {2000, .06673},  {2897.772, .250055},
                                  {3000, .27322},  {4000, .48085},  {4107.3, .5},
                                  {5000, .63371},  {6000, .73777},  {8000, .85624},
                                  {10000, .91415}, {20000, .98555}, {50000, .99890}};

START_TEST(tabulated_digits_are_met) {
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    const double part = hr2d_black_body_part(1000, 0, table[k][0] / 1000);
    const double rest = hr2d_black_body_part(250, table[k][0] / 250, INFINITY);
    ck_assert_double_eq_tol(part, table[k][1], 2e-5);
    ck_assert_double_eq_tol(rest, 1 - table[k][1], 2e-5);
  }
}
END_TEST

/* The scale 15/π⁴ times a sum. */
static void times_scale(mpfr_t sum) {
  mpfr_t pi;
  mpfr_init2(pi, BITS);
  mpfr_const_pi(pi, MPFR_RNDN);
  mpfr_pow_ui(pi, pi, 4, MPFR_RNDN);
  mpfr_mul_ui(sum, sum, 15, MPFR_RNDN);
  mpfr_div(sum, sum, pi, MPFR_RNDN);
  mpfr_clear(pi);
}

/* (15/π⁴) ∫ u³/(eᵘ − 1) over u > x: Σ e^{-nx} (x³/n + 3x²/n² + 6x/n³ + 6/n⁴). */
static void tail(mpfr_t sum, mpfr_t x) {
  mpfr_t term, power, factor;
  mpfr_inits2(BITS, term, power, factor, (mpfr_ptr)0);
  mpfr_neg(factor, x, MPFR_RNDN);
  mpfr_exp(factor, factor, MPFR_RNDN);
  mpfr_set_ui(power, 1, MPFR_RNDN);
  mpfr_set_ui(sum, 0, MPFR_RNDN);
  const unsigned long terms = 2 + (unsigned long)(190 / mpfr_get_d(x, MPFR_RNDN));
  for (unsigned long n = 1; n <= terms; n++) {
    mpfr_mul(power, power, factor, MPFR_RNDN);
    mpfr_mul_ui(term, x, n, MPFR_RNDN); /* ((nx + 3)nx + 6)nx + 6 */
    mpfr_t nx;
    mpfr_init2(nx, BITS);
    mpfr_set(nx, term, MPFR_RNDN);
    mpfr_add_ui(term, term, 3, MPFR_RNDN);
    mpfr_mul(term, term, nx, MPFR_RNDN);
    mpfr_add_ui(term, term, 6, MPFR_RNDN);
    mpfr_mul(term, term, nx, MPFR_RNDN);
    mpfr_add_ui(term, term, 6, MPFR_RNDN);
    mpfr_clear(nx);
    for (int k = 0; k < 4; k++) mpfr_div_ui(term, term, n, MPFR_RNDN);
    mpfr_mul(term, term, power, MPFR_RNDN);
    mpfr_add(sum, sum, term, MPFR_RNDN);
  }
  times_scale(sum);
  mpfr_clears(term, power, factor, (mpfr_ptr)0);
}

/* The part below a wavelength. */
static void below(mpfr_t sum, double c2, double kelvin, double wavelength) {
  mpfr_t x;
  mpfr_init2(x, BITS);
  if (!(wavelength < INFINITY)) {
    mpfr_set_ui(sum, 1, MPFR_RNDN);
  } else if (wavelength <= 0) {
    mpfr_set_ui(sum, 0, MPFR_RNDN);
  } else {
    mpfr_set_d(x, c2, MPFR_RNDN);
    mpfr_mul_ui(x, x, 1000000, MPFR_RNDN);
    mpfr_div_d(x, x, kelvin, MPFR_RNDN);
    mpfr_div_d(x, x, wavelength, MPFR_RNDN);
    tail(sum, x);
  }
  mpfr_clear(x);
}

static double exact(double c2, double kelvin, double from, double to) {
  mpfr_t low, high;
  mpfr_inits2(BITS, low, high, (mpfr_ptr)0);
  below(low, c2, kelvin, from);
  below(high, c2, kelvin, to);
  mpfr_sub(high, high, low, MPFR_RNDN);
  const double part = mpfr_get_d(high, MPFR_RNDN);
  mpfr_clears(low, high, (mpfr_ptr)0);
  return part;
}

/* The error in units of the bound of the header. */
static double error_of(double c2, double kelvin, double from, double to) {
  const double truth = exact(c2, kelvin, from, to), x = 14387.76877 / (to * kelvin);
  const double error = fabs(hr2d_black_body_part(kelvin, from, to) - truth);
  return truth > 1e-300 ? error / (truth * (20 + 4 * x) * DBL_EPSILON) : error > 1e-300;
}

START_TEST(the_bound_of_the_header_holds) {
  randoms r = randoms_stream(test_seed(), 0);
  const int cases = test_count(3000);
  double worst = 0;
  for (int k = 0; k < cases; k++) {
    const double kelvin = random_power(&r, 0, 4);
    double at[2];
    at[0] = 14387.76877 / (kelvin * random_power(&r, -1.3, 2.8));
    at[1] = k % 3 == 0   ? 14387.76877 / (kelvin * random_power(&r, -1.3, 2.8))
            : k % 3 == 1 ? at[0] * (1 + random_power(&r, -14, 0))
                         : INFINITY;
    if (k % 7 == 0) at[0] = 0;
    const double from = fmin(at[0], at[1]), to = fmax(at[0], at[1]);
    const double error = error_of(HR2D_SECOND_RADIATION_CONSTANT, kelvin, from, to);
    worst = fmax(worst, error);
    ck_assert_msg(error <= 1, "%.17g K, %.17g to %.17g: %g bounds", kelvin, from, to, error);
  }
  printf("the largest error is %.2f of its bound\n", worst);
}
END_TEST

START_TEST(bands_sum_to_one) {
  randoms r = randoms_stream(test_seed(), 1);
  for (int k = 0; k < 100; k++) {
    const double kelvin = random_power(&r, 0, 4);
    double sum = 0, from = 0;
    for (int band = 0; band < 20; band++) {
      const double to = band < 19 ? from + 14388 / kelvin * random_power(&r, -3, 0) : INFINITY;
      sum += hr2d_black_body_part(kelvin, from, to);
      from = to;
    }
    ck_assert_double_eq_tol(sum, 1, 1e-14);
  }
}
END_TEST

START_TEST(limits_are_kept) {
  ck_assert_double_eq(hr2d_black_body_part(300, 0, INFINITY), 1);
  ck_assert_double_eq(hr2d_black_body_part(300, 5, 5), 0);
  ck_assert_double_eq(hr2d_black_body_part(0, 0, 1e300), 0);
  ck_assert_double_eq(hr2d_black_body_part(0, 10, INFINITY), 1);
  ck_assert_double_eq(hr2d_black_body_part(1e-300, 0, 1e-300), 0);
  ck_assert_double_eq_tol(hr2d_black_body_part(1e300, 1e-300, INFINITY), 1, 1e-15);
  ck_assert_double_nan(hr2d_black_body_part(-1, 0, 1));
  ck_assert_double_nan(hr2d_black_body_part(300, 2, 1));
  ck_assert_double_nan(hr2d_black_body_part(300, -1, 1));
  ck_assert_double_nan(hr2d_black_body_part(NAN, 0, 1));
  ck_assert_double_nan(hr2d_black_body_part(300, 0, NAN));
  ck_assert_double_eq_tol(hr2d_black_body(1000), 56703.74419, 1e-9);
}
END_TEST

/* Another last digit of c₂ is far beyond the bound. */
START_TEST(another_constant_is_noticed) {
  ck_assert_double_le(error_of(HR2D_SECOND_RADIATION_CONSTANT, 1000, 0, 3), 1);
  ck_assert_double_gt(error_of(HR2D_SECOND_RADIATION_CONSTANT * (1 + 1e-12), 1000, 0, 3), 1);
  ck_assert_double_gt(fabs(hr2d_black_body_part(1000, 0, 3) - table[4][1]), 2e-5);
}
END_TEST

TEST_SUITE("black body") {
  ADD_TESTS("parts", tabulated_digits_are_met, the_bound_of_the_header_holds, bands_sum_to_one,
            limits_are_kept, another_constant_is_noticed);
}
