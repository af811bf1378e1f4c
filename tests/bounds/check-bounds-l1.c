/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bound that oracle.h states of l1, against the textbook's integral in MPFR, on random and
   on hill-climbed pairs.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the inputs. */
#include <float.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdio.h>

#include "independent/mpfr-exchange.h"
#include "independent/mpfr-l1.h"
#include "support/hill-climb.h"
#include "support/support.h"

#define BOUND 1e-10

/* As oracle.h has it, and cosines at the centres that are no smaller than it says. */
static int are_elements(const double *x) {
  double least = INFINITY, most = 0;
  for (int k = 0; k < 8; k++) {
    const double size = fabs(x[k]);
    most = fmax(most, size);
    if (size > 0) least = fmin(least, size);
  }
  return most < 2 && least >= 0x1p-400 * most;
}

static void draw_elements(const void *ctx, randoms *r, double *x) {
  const pair p = draw_pair(ctx, r);
  const hr2d_point point[4] = {p.i.a, p.i.b, p.j.a, p.j.b};
  double most = DBL_TRUE_MIN;
  for (int k = 0; k < 4; k++) most = fmax(most, fmax(fabs(point[k].x), fabs(point[k].y)));
  for (int k = 0; k < 4; k++) {
    x[2 * k] = ldexp(point[k].x, -ilogb(most));
    x[2 * k + 1] = ldexp(point[k].y, -ilogb(most));
  }
}

static double estimate(const hr2d_oracle *oracle, const double *x) {
  hr2d_element element[2];
  for (int k = 0; k < 2; k++) {
    const double *a = x + 4 * k;
    element[k] = (hr2d_element){.a = {a[0], a[1]}, .b = {a[2], a[3]}};
    element[k].centre = (hr2d_point){0.5 * (a[0] + a[2]), 0.5 * (a[1] + a[3])};
    element[k].length = hypot(a[2] - a[0], a[3] - a[1]);
  }
  const hr2d_pair asked = {0, 1};
  const hr2d_batch batch = {
      .struct_size = sizeof batch, .elements = element, .pairs = &asked, .count = 1, .unit = 1};
  double error;
  ck_assert_int_eq(oracle->estimate(NULL, &batch, &error), HR2D_OK);
  ck_assert(error >= 0);
  for (int k = -1; k <= 1; k++) {
    const double epsilon = k ? error * (1 + k * 1e-12) : error;
    unsigned char accepted = 7;
    ck_assert_int_eq(oracle->accept(NULL, &batch, epsilon, &accepted), HR2D_OK);
    if (accepted != (error <= epsilon)) return NAN;
  }
  return error;
}

static double l1_error(const void *ctx, const double *x) {
  (void)ctx;
  if (!are_elements(x)) return -1;
  const hr2d_segment i = {{x[0], x[1]}, {x[2], x[3]}}, j = {{x[4], x[5]}, {x[6], x[7]}};
  const double exact = mpfr_l1(&i, &j, 1e-11), got = estimate(hr2d_oracle_l1(), x);
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
  const hill_effort effort = {6, part < 1 ? 0 : 1, 6};
  const summit top = hill_climb(&h, effort, 900 + _i);
  if (part < 1 && top.tried == 0) return; /* the few that were drawn do not see each other */
  hill_assert(&h, &top, BOUND);
}
END_TEST

/* The reference against what has a closed form. */
START_TEST(reference_is_right) {
  for (int k = -8; k <= 8; k += 2) {
    const double d = pow(10, k);
    const hr2d_segment i = {{0, 0}, {1, 0}}, j = {{1, d}, {0, d}};
    const double exact = 1 / (2 * d * pow(sqrt(1 + d * d) + d, 2));
    ck_assert_double_eq_tol(mpfr_l1(&i, &j, 1e-12), exact, 1e-14 * exact);
  }
}
END_TEST

int main(void) {
  printf("seed %lu\n", test_seed());
  fflush(stdout);
  gsl_set_error_handler_off();
  Suite *suite = suite_create("bounds of l1");
  TCase *tc = tcase_create("l1");
  tcase_add_loop_test(tc, l1_holds_its_bound, 0, pair_class_count);
  tcase_add_test(tc, reference_is_right);
  suite_add_tcase(suite, tc);
  return test_run(suite);
}
