/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bickley functions, transmittances and their means, against integrals in numbers of 200 bits.
 */
#include <math.h>
#include <mpfr.h>

#include "base/bickley.h"
#include "support/support.h"

enum { BITS = 200 };

/* Ki_n(x), the integral of e^(−x cosh t)/coshⁿ t over t > 0, by the trapezoidal rule, which
   converges like e^(−c/h) there. */
static void bickley(mpfr_t out, unsigned long n, double x) {
  const double step = fmin(1. / 13, 0.4 / sqrt(fmax(x, 1)));
  mpfr_t c, term, limit;
  mpfr_inits2(BITS, c, term, limit, (mpfr_ptr)0);
  mpfr_set_d(out, -x, MPFR_RNDN);
  mpfr_exp(out, out, MPFR_RNDN);
  mpfr_div_2ui(out, out, 1, MPFR_RNDN);
  for (unsigned long k = 1;; k++) {
    mpfr_set_d(c, step, MPFR_RNDN);
    mpfr_mul_ui(c, c, k, MPFR_RNDN);
    mpfr_cosh(c, c, MPFR_RNDN);
    mpfr_mul_d(term, c, -x, MPFR_RNDN);
    mpfr_exp(term, term, MPFR_RNDN);
    mpfr_pow_ui(c, c, n, MPFR_RNDN);
    mpfr_div(term, term, c, MPFR_RNDN);
    mpfr_add(out, out, term, MPFR_RNDN);
    mpfr_div_2ui(limit, out, 170, MPFR_RNDN);
    if (mpfr_cmp(term, limit) < 0) break;
  }
  mpfr_mul_d(out, out, step, MPFR_RNDN);
  mpfr_clears(c, term, limit, (mpfr_ptr)0);
}

/* (4/π) of a number. */
static void by_quarter_pi(mpfr_t x) {
  mpfr_t pi;
  mpfr_init2(pi, BITS);
  mpfr_const_pi(pi, MPFR_RNDN);
  mpfr_div(x, x, pi, MPFR_RNDN);
  mpfr_mul_2ui(x, x, 2, MPFR_RNDN);
  mpfr_clear(pi);
}

/* T(x) in a section, and with `mean` the mean of T from x to y. */
static void passing(mpfr_t out, hr2d_section section, double x, double y, int mean) {
  mpfr_t other, width;
  mpfr_inits2(BITS, other, width, (mpfr_ptr)0);
  if (section == HR2D_SECTION_LONG) {
    bickley(out, 3 + (unsigned long)mean, x);
    bickley(other, 3 + (unsigned long)mean, y);
    by_quarter_pi(out);
    by_quarter_pi(other);
  } else {
    mpfr_set_d(out, -x, MPFR_RNDN);
    mpfr_exp(out, out, MPFR_RNDN);
    mpfr_set_d(other, -y, MPFR_RNDN);
    mpfr_exp(other, other, MPFR_RNDN);
  }
  if (mean) {
    mpfr_sub(out, out, other, MPFR_RNDN);
    mpfr_set_d(width, y, MPFR_RNDN);
    mpfr_sub_d(width, width, x, MPFR_RNDN);
    mpfr_div(out, out, width, MPFR_RNDN);
  }
  mpfr_clears(other, width, (mpfr_ptr)0);
}

/* |got − exact|/exact */
static double off(double got, const mpfr_t exact) {
  mpfr_t d;
  mpfr_init2(d, BITS);
  mpfr_sub_d(d, exact, got, MPFR_RNDN);
  mpfr_div(d, d, exact, MPFR_RNDN);
  const double relative = fabs(mpfr_get_d(d, MPFR_RNDN));
  mpfr_clear(d);
  return relative;
}

/* Depths on both sides of every piece of the tables, and of all sizes. */
static double draw_depth(randoms *r, int n) {
  static const double edge[] = {1, 2, 4, 8, 16, 64, 700};
  if (n % 4 == 0) return random_nudge(r, edge[random_below(r, 6)], 2);
  return n % 2 ? random_power(r, -8, 2.8) : random_between(r, 0, 50);
}

START_TEST(bickley_functions_have_their_digits) {
  double worst = 0;
  mpfr_t exact;
  mpfr_init2(exact, BITS);
  for (int n = 0; n < test_count(3000); n++) {
    randoms r = randoms_stream(test_seed(), n);
    const double x = draw_depth(&r, n);
    bickley(exact, 2, x);
    worst = fmax(worst, off(hr2di_bickley_2(x), exact));
    bickley(exact, 3, x);
    worst = fmax(worst, off(hr2di_bickley_3(x), exact));
    bickley(exact, 4, x);
    worst = fmax(worst, off(hr2di_bickley_4(x), exact));
    /* negative control: the next function is another one */
    ck_assert_double_gt(off(hr2di_bickley_3(x), exact), 1e-4);
  }
  mpfr_clear(exact);
  printf("Ki_2 to Ki_4 are off by at most %.1e of themselves\n", worst);
  ck_assert_double_lt(worst, 1.1e-15);
}
END_TEST

START_TEST(what_is_absorbed_has_its_own_digits) {
  double arrives = 0, absorbed = 0;
  mpfr_t exact;
  mpfr_init2(exact, BITS);
  for (int n = 0; n < test_count(3000); n++) {
    randoms r = randoms_stream(test_seed() + 1, n);
    const double x = n % 3 ? draw_depth(&r, n) : random_power(&r, -15, -2);
    const hr2d_section section = n % 2 ? HR2D_SECTION_FLAT : HR2D_SECTION_LONG;
    const hr2di_passage p = hr2di_passage_at(section, x);
    passing(exact, section, x, x, 0);
    arrives = fmax(arrives, off(p.arrives, exact));
    mpfr_ui_sub(exact, 1, exact, MPFR_RNDN);
    absorbed = fmax(absorbed, off(p.absorbed, exact));
  }
  mpfr_clear(exact);
  printf("T is off by at most %.1e of itself, 1 − T by %.1e\n", arrives, absorbed);
  ck_assert_double_lt(arrives, 1.1e-15);
  ck_assert_double_lt(absorbed, 1.1e-15);
}
END_TEST

START_TEST(a_difference_from_one_would_lose_digits) {
  mpfr_t exact;
  mpfr_init2(exact, BITS);
  passing(exact, HR2D_SECTION_LONG, 1e-9, 1e-9, 0);
  mpfr_ui_sub(exact, 1, exact, MPFR_RNDN);
  const hr2di_passage p = hr2di_passage_at(HR2D_SECTION_LONG, 1e-9);
  ck_assert_double_lt(off(p.absorbed, exact), 1e-15);
  ck_assert_double_gt(off(1 - p.arrives, exact), 1e-10);
  mpfr_clear(exact);
}
END_TEST

/* Two depths: apart, near to each other, and one of them 0 as at a corner. */
static void draw_depths(randoms *r, int n, double *x, double *y) {
  *x = random_power(r, -8, 2.2);
  *y = n % 3 == 0   ? *x * (1 + random_power(r, -9, 0))
       : n % 3 == 1 ? random_power(r, -8, 2.2)
                    : 0;
}

START_TEST(means_over_chords_have_their_digits) {
  double arrives = 0, absorbed = 0;
  mpfr_t exact;
  mpfr_init2(exact, BITS);
  for (int n = 0; n < test_count(3000); n++) {
    randoms r = randoms_stream(test_seed() + 2, n);
    const hr2d_section section = n % 2 ? HR2D_SECTION_FLAT : HR2D_SECTION_LONG;
    double x, y;
    draw_depths(&r, n, &x, &y);
    if (x == y) continue;
    const hr2di_passage p = hr2di_passage_mean(section, x, y);
    const hr2di_passage q = hr2di_passage_mean(section, y, x);
    ck_assert(p.arrives == q.arrives && p.absorbed == q.absorbed);
    /* In the long section the integral of T is that of Ki_3, −Ki_4. */
    passing(exact, section, x, y, 1);
    arrives = fmax(arrives, off(p.arrives, exact));
    mpfr_ui_sub(exact, 1, exact, MPFR_RNDN);
    absorbed = fmax(absorbed, off(p.absorbed, exact));
  }
  mpfr_clear(exact);
  printf("means of T are off by at most %.1e of themselves, of 1 − T by %.1e\n", arrives,
         absorbed);
  ck_assert_double_lt(arrives, 1e-14);
  ck_assert_double_lt(absorbed, 4e-15);
}
END_TEST

START_TEST(means_around_points_are_of_ki_2) {
  double worst = 0;
  mpfr_t exact;
  mpfr_init2(exact, BITS);
  for (int n = 0; n < test_count(1000); n++) {
    randoms r = randoms_stream(test_seed() + 3, n);
    const double x = n % 3 ? draw_depth(&r, n) : random_power(&r, -12, -2);
    const hr2di_passage p = hr2di_passage_of_mean(HR2D_SECTION_LONG, x);
    const hr2di_passage flat = hr2di_passage_of_mean(HR2D_SECTION_FLAT, x);
    bickley(exact, 2, x);
    worst = fmax(worst, off(p.arrives, exact));
    mpfr_ui_sub(exact, 1, exact, MPFR_RNDN);
    worst = fmax(worst, off(p.absorbed, exact));
    ck_assert(flat.arrives == hr2di_passage_at(HR2D_SECTION_FLAT, x).arrives);
  }
  mpfr_clear(exact);
  ck_assert_double_lt(worst, 1.1e-15);
}
END_TEST

START_TEST(nothing_and_everything) {
  for (int s = 0; s < 2; s++) {
    const hr2d_section section = s ? HR2D_SECTION_FLAT : HR2D_SECTION_LONG;
    const hr2di_passage none = hr2di_passage_at(section, 0),
                        all = hr2di_passage_at(section, 1e9);
    const hr2di_passage mean = hr2di_passage_mean(section, 0, 0);
    ck_assert(none.arrives == 1 && none.absorbed == 0);
    ck_assert(mean.arrives == 1 && mean.absorbed == 0);
    ck_assert(all.arrives == 0 && all.absorbed == 1);
    ck_assert_double_gt(hr2di_passage_at(section, 700).arrives, 0);
  }
}
END_TEST

TEST_SUITE("bickley") {
  ADD_TESTS("bickley", bickley_functions_have_their_digits, what_is_absorbed_has_its_own_digits,
            a_difference_from_one_would_lose_digits, means_over_chords_have_their_digits,
            means_around_points_are_of_ki_2, nothing_and_everything);
}
