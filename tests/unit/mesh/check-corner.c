/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exponent of a corner against its definition, by quadrature.

   With t = e^s the kernel's integral is sin²α ∫₀^∞ cosh((γ+½)s) / (2cosh s − 2cosα)^{3/2} ds.
   In sinh(s/2) = sin(α/2) sinh u it is, without cancellation for any angle,

     K̂(γ) − 1 = −sin²(α/2) + 2cos²(α/2) ∫₀^∞ sinh((1+γ)s/2) sinh(γs/2) / cosh(s/2) / cosh²u du.
 */
#include <check.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>

#include "mesh/corner-exponent.h"
#include "support/support.h"

#define PI 3.14159265358979323846

enum { LIMIT = 1000 };

static gsl_integration_workspace *space;

static double integral(double (*f)(double, void *), void *params, double from, double to) {
  gsl_function function = {f, params};
  double value, error;
  const int status =
      gsl_integration_qags(&function, from, to, 1e-300, 1e-12, LIMIT, space, &value, &error);
  ck_assert_msg(status == GSL_SUCCESS || status == GSL_EROUND, "%s", gsl_strerror(status));
  ck_assert_double_le(error, 1e-10 * fabs(value) + 1e-300);
  return value;
}

typedef struct transform {
  double angle, gamma;
} transform;

static double definition(double t, void *params) {
  const transform *f = params;
  const double distance = (1 - t) * (1 - t) + 4 * t * pow(sin(.5 * f->angle), 2);
  return .5 * pow(sin(f->angle), 2) * t * pow(t, f->gamma) / (distance * sqrt(distance));
}

/* Of the part beyond 1, in 1/t. */
static double definition_beyond(double t, void *params) {
  return definition(1 / t, params) / (t * t);
}

static double by_definition(double angle, double gamma) {
  transform f = {angle, gamma};
  return integral(definition, &f, 0, 1) + integral(definition_beyond, &f, 0, 1);
}

/* As exponentials: e^(γs − 2u) and what tends to 1. */
static double excess_density(double u, void *params) {
  const transform *f = params;
  const double sine = sin(.5 * f->angle);
  const double s = u < 300 ? 2 * asinh(sine * sinh(u)) : 2 * (log(sine) + u);
  return 2 * exp(f->gamma * s - 2 * u) * expm1(-(1 + f->gamma) * s) * expm1(-f->gamma * s) /
         ((1 + exp(-s)) * pow(1 + exp(-2 * u), 2));
}

/* K̂ − 1. */
static double excess(double angle, double gamma) {
  transform f = {angle, gamma};
  const double end = 25 / (1 - gamma), s = sin(.5 * angle), c = cos(.5 * angle);
  double sum = 0, from = 0, to = 1;
  for (; from < end; from = to, to *= 2) sum += integral(excess_density, &f, from, to);
  return 2 * c * c * sum - s * s;
}

START_TEST(test_reference) {
  gsl_set_error_handler_off();
  space = gsl_integration_workspace_alloc(LIMIT);
  for (double angle = .3; angle < 3; angle += .3)
    for (double gamma = 0; gamma < .95; gamma += .15)
      ck_assert_double_eq_tol(by_definition(angle, gamma) - 1, excess(angle, gamma), 1e-9);
  for (double angle = .05; angle < PI; angle += .05)
    ck_assert_double_eq_tol(by_definition(angle, 0), .5 * (1 + cos(angle)), 1e-9);
  gsl_integration_workspace_free(space);
}
END_TEST

/* √(ρ1ρ2) K̂ − 1, over √(ρ1ρ2). */
static double gain(double angle, double rho1, double rho2, double gamma) {
  const double product = rho1 * rho2, root = sqrt(product);
  const double lost = (1 - rho1) + rho1 * (1 - rho2);
  return excess(angle, gamma) - lost / (root * (1 + root));
}

static const double angles[] = {1e-8, 1e-5, 1e-3,          .05,       PI / 18,
                                .7,   1.2,  PI / 2 - 1e-3, PI / 2,    PI / 2 + 1e-3,
                                2,    2.6,  3.1,           PI - 1e-4, PI - 1e-8};
static const double reflectances[] = {1e-12, 1e-6, 1e-3, .1, .5, .9, .999, 1 - 1e-9, 1};

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define ACCURACY     1e-9

START_TEST(test_root) {
  gsl_set_error_handler_off();
  space = gsl_integration_workspace_alloc(LIMIT);
  int inside = 0;
  for (size_t k = 0; k < COUNT(angles); k++)
    for (size_t i = 0; i < COUNT(reflectances); i++)
      for (size_t j = i; j < COUNT(reflectances); j++) {
        const double angle = angles[k], r = reflectances[i], q = reflectances[j];
        const double gamma = hr2di_corner_exponent(angle, r, q);
        ck_assert(gamma >= 0 && gamma <= 1);
        ck_assert_double_eq(gamma, hr2di_corner_exponent(angle, r, q));
        ck_assert_double_eq_tol(gamma, hr2di_corner_exponent(angle, q, r), 1e-13);
        /* Closer to the pole the quadrature would have too far to go. */
        const double below = fmin(gamma - ACCURACY, 1 - 1e-3), above = gamma + ACCURACY;
        if (below > 0)
          ck_assert_msg(gain(angle, r, q, below) < 0, "%g %g %g: %.17g", angle, r, q, gamma);
        if (above < 1 - 1e-3) {
          ck_assert_msg(gain(angle, r, q, above) > 0, "%g %g %g: %.17g", angle, r, q, gamma);
          inside++;
        }
      }
  ck_assert_int_gt(inside, 200);
  gsl_integration_workspace_free(space);
}
END_TEST

/* Where K̂ has its pole: η K̂ tends to 2 sin²(α/2) cos²(α/2), so that
   γ = 1 − ½ sin²α √(ρ1ρ2) + O(ρ1ρ2 ln(ρ1ρ2)) for dark walls. */
START_TEST(test_dark) {
  for (size_t k = 0; k < COUNT(angles); k++) {
    const double half = .5 * pow(sin(angles[k]), 2);
    for (double rho = 1e-2; rho > 1e-12; rho *= .1) {
      const double gamma = hr2di_corner_exponent(angles[k], rho, rho);
      ck_assert_double_eq_tol(gamma, 1 - half * rho, 4 * rho * rho + 1e-13);
    }
    ck_assert_double_eq(hr2di_corner_exponent(angles[k], 0, .5), 1);
    ck_assert_double_eq(hr2di_corner_exponent(angles[k], .5, 0), 1);
    ck_assert_double_eq(hr2di_corner_exponent(angles[k], 0, 0), 1);
  }
}
END_TEST

/* The brighter the walls and the narrower the corner, the steeper is the radiosity. */
START_TEST(test_monotonic) {
  for (size_t k = 0; k < COUNT(angles); k++) {
    double last = 1;
    for (size_t i = 0; i < COUNT(reflectances); i++) {
      const double gamma = hr2di_corner_exponent(angles[k], reflectances[i], .99);
      ck_assert_double_le(gamma, last);
      last = gamma;
    }
  }
  double last = 0;
  for (size_t k = 0; k < COUNT(angles); k++) {
    const double gamma = hr2di_corner_exponent(angles[k], 1, 1);
    ck_assert_double_gt(gamma, last);
    last = gamma;
  }
}
END_TEST

TEST_SUITE("corner") {
  ADD_TESTS("exponent", test_reference, test_root, test_dark, test_monotonic);
}
