/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bound that oracle.h states for l1, against the textbook's integral in MPFR, on random and
   on hill-climbed pairs.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the inputs. */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdio.h>

#include "independent/mpfr-exchange.h"
#include "independent/mpfr-l1.h"
#include "support/elements.h"
#include "support/hill-climb.h"
#include "support/support.h"

#define BOUND 1e-10

/* The range of coordinates for which oracle.h states the bound; it keeps the cosines at the
   centres large enough, too. */
static int are_elements(const double *x) {
  return element_in_range(x, 8, 400);
}

static void draw_elements(const void *ctx, randoms *r, double *x) {
  element_draw(ctx, r, x);
}

static double estimate(const hr2d_oracle *oracle, hr2d_segment i, hr2d_segment j) {
  const element_pair p = {.element = {element_of(i), element_of(j)}};
  const hr2d_batch batch = element_batch(&p);
  const double error = element_estimate(oracle, &batch);
  ck_assert(error >= 0);
  for (int k = -1; k <= 1; k++) {
    const double epsilon = k ? error * (1 + k * 1e-12) : error;
    if (element_accepted(oracle, &batch, epsilon) != (error <= epsilon)) return NAN;
  }
  return error;
}

static double l1_error(const void *ctx, const double *x) {
  (void)ctx;
  if (!are_elements(x)) return -1;
  const hr2d_segment i = {{x[0], x[1]}, {x[2], x[3]}}, j = {{x[4], x[5]}, {x[6], x[7]}};
  const double exact = mpfr_l1(&i, &j, 1e-11), got = estimate(hr2d_oracle_l1(), i, j);
  if (isnan(got)) return INFINITY;
  if (isnan(exact) || exact < 1e-290) return -1;
  return fabs(got / exact - 1);
}

START_TEST(l1_holds_its_bound) {
  const pair_class *class = &pair_classes[_i];
  const double part = test_multiplier();
  if (part < 0.1 && _i % 6 != 1) return;
  char name[80];
  snprintf(name, sizeof name, "l1, %s", class->name);
  const hill h = {name, 8, 4, draw_elements, l1_error, class};
  /* Three draws at the least, and one climb. */
  const hill_effort effort = {part < 0.5 ? (int)(3 / part) : 6, part < 1 && _i != 1 ? 0 : 1, 6};
  const summit top = hill_climb(&h, effort, 900 + _i);
  if (part < 1 && top.tried == 0) return; /* the few that were drawn do not see each other */
  hill_assert(&h, &top, BOUND);
}
END_TEST

/* The reference against a closed form. */
START_TEST(reference_is_right) {
  for (int k = -8; k <= 8; k += 2) {
    const double d = pow(10, k);
    const hr2d_segment i = {{0, 0}, {1, 0}}, j = {{1, d}, {0, d}};
    const double exact = 1 / (2 * d * pow(sqrt(1 + d * d) + d, 2));
    ck_assert_double_eq_tol(mpfr_l1(&i, &j, 1e-12), exact, 1e-14 * exact);
  }
}
END_TEST

TEST_SUITE("bounds of l1") {
  gsl_set_error_handler_off();
  REPEAT_TESTS(pair_class_count, "l1", l1_holds_its_bound);
  ADD_TESTS("l1", reference_is_right);
}
