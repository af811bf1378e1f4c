/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors of the field of a solution with an account: M and Φ are as near to those of a much
   better solution as they say. */
#include <math.h>
#include <stdlib.h>

#include "support/accuracy-scenes.h"
#include "support/support.h"

enum { POINTS = 200 };
static const double pi = 3.14159265358979323846;

typedef struct light {
  double mean[POINTS * ACCURACY_BANDS], flux[2 * POINTS * ACCURACY_BANDS],
      error[POINTS * ACCURACY_BANDS];
} light;

static hr2d_solution *solve(const hr2d_scene *scene, double error, hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  target.error = error;
  target.points = 1;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
  ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
  return solution;
}

static void look(const hr2d_solution *solution, const hr2d_account *account,
                 const hr2d_point *at, light *to) {
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  options.account = account;
  values.mean = to->mean;
  values.flux = to->flux;
  values.error = to->error;
  ck_assert_int_eq(hr2d_field_at(solution, at, POINTS, &options, &values), HR2D_OK);
}

/* Points between the patches, some of them beside a patch. */
static void draw_points(const hr2d_scene *scene, randoms *r, hr2d_point *at) {
  for (int k = 0; k < POINTS; k++) {
    const size_t n = hr2d_scene_patches(scene);
    const hr2d_segment one = hr2d_scene_segment(scene, (size_t)random_below(r, (int)n)),
                       other = hr2d_scene_segment(scene, (size_t)random_below(r, (int)n));
    const double s = random_unit(r), t = random_unit(r);
    const double u = k % 2 ? random_unit(r) : random_power(r, -6, 0);
    const hr2d_point p = {one.a.x + s * (one.b.x - one.a.x), one.a.y + s * (one.b.y - one.a.y)},
                     q = {other.a.x + t * (other.b.x - other.a.x),
                          other.a.y + t * (other.b.y - other.a.y)};
    at[k] = (hr2d_point){p.x + u * (q.x - p.x), p.y + u * (q.y - p.y)};
  }
}

/* How often a bound that knows only the error of what points gather is too small. */
static int naive_failures;

static void expect_within(const light *is, const light *right, size_t bands, double naive,
                          size_t round, const char *shape) {
  for (size_t k = 0; k < POINTS * bands; k++) {
    if (isnan(is->mean[k])) continue;
    const double off = fabs(is->mean[k] - right->mean[k]);
    const double turned = hypot(is->flux[2 * k] - right->flux[2 * k],
                                is->flux[2 * k + 1] - right->flux[2 * k + 1]);
    const double sum = is->error[k] + right->error[k];
    ck_assert_msg(off <= sum && turned <= pi * sum,
                  "scene %zu, %s: M is off by %g, the flux by %g, with an error of %g", round,
                  shape, off, turned, sum);
    naive_failures += off > naive + right->error[k];
  }
}

START_TEST(fields_are_within_their_errors) {
  const size_t rounds = test_some(60, 4);
  naive_failures = 0;
  for (size_t k = 0; k < rounds; k++) {
    randoms r = randoms_stream(test_seed(), (int)k);
    accuracy_scene drawn = accuracy_draw(test_seed(), (int)k, .9);
    hr2d_scene *scene = accuracy_make(&drawn);
    hr2d_account account, exact_account;
    hr2d_solution *solution = solve(scene, random_power(&r, -6, -2), &account),
                  *exact = solve(scene, 1e-9, &exact_account);
    hr2d_point at[POINTS];
    light *is = malloc(2 * sizeof *is);
    ck_assert_ptr_nonnull(is);
    double max = 0;
    for (size_t p = 0; p < hr2d_scene_patches(scene); p++)
      max = fmax(max, hr2d_solution_average(exact, p, 0));
    draw_points(scene, &r, at);
    look(solution, &account, at, &is[0]);
    look(exact, &exact_account, at, &is[1]);
    expect_within(&is[0], &is[1], hr2d_scene_bands(scene), account.sup.bound * max, k,
                  drawn.shape);
    free(is);
    hr2d_solution_destroy(exact);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
    accuracy_free(&drawn);
  }
  printf("a bound from points alone fails %d times\n", naive_failures);
}
END_TEST

/* Without an account nothing is known, and an account of no error tells nothing. */
START_TEST(unknown_errors_are_no_numbers) {
  hr2d_scene *scene =
      test_scene((const double[][6]){{0, 0, 1, 0, 1, .5}, {1, 1, 0, 1, 0, .5}}, 2);
  hr2d_account account;
  hr2d_solution *solution = solve(scene, 1e-3, &account);
  hr2d_point at[POINTS];
  light to;
  for (int k = 0; k < POINTS; k++) at[k] = (hr2d_point){.5, (k + .5) / POINTS};
  look(solution, NULL, at, &to);
  ck_assert(isnan(to.error[0]));
  look(solution, &account, at, &to);
  ck_assert(to.error[0] > 0 && to.error[0] < .1);
  account.sup.bound = HUGE_VAL;
  look(solution, &account, at, &to);
  ck_assert(isnan(to.error[0]));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Images have the errors of their patches: half of a room at a mirror has those of the whole
   one, or more. */
START_TEST(images_have_errors) {
  hr2d_scene *half = test_new_scene(NULL);
  test_add_patch(half, (hr2d_segment){{0, 0}, {1, 0}}, 0, .5, HR2D_SIDES_FRONT);
  test_add_patch(half, (hr2d_segment){{1, 0}, {1, 1}}, 1, .5, HR2D_SIDES_FRONT);
  test_add_patch(half, (hr2d_segment){{1, 1}, {0, 1}}, 0, .5, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_add_mirror(half, (hr2d_segment){{0, 0}, {0, 1}}), HR2D_OK);
  test_commit(half);
  hr2d_account account, exact_account;
  hr2d_solution *solution = solve(half, 1e-2, &account),
                *exact = solve(half, 1e-9, &exact_account);
  hr2d_point at[POINTS];
  light is, right;
  for (int k = 0; k < POINTS; k++) at[k] = (hr2d_point){.05, (k + .5) / POINTS};
  look(solution, &account, at, &is);
  look(exact, &exact_account, at, &right);
  expect_within(&is, &right, 1, 0, 0, "half a room");
  ck_assert_double_gt(is.error[POINTS / 2], 0);
  hr2d_solution_destroy(exact);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(half);
}
END_TEST

TEST_SUITE("errors of the field") {
  ADD_TESTS("errors", fields_are_within_their_errors, unknown_errors_are_no_numbers,
            images_have_errors);
}
