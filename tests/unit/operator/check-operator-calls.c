/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls of an operator: warm starts, values that are not valid, light that elements do not
   know, calls from callbacks, and stops. */
#include <math.h>
#include <string.h>

#include "support/relit-rooms.h"
#include "support/support.h"

/* A warm start takes fewer gathers, and gives the same values. */
START_TEST(a_warm_start_is_shorter) {
  randoms r = randoms_stream(test_seed(), 60);
  relit_paint first;
  relit_draw(&first, &r);
  hr2d_scene *scene = relit_scene(RELIT_CLOSED, &first, 1);
  hr2d_operator *op = relit_operator(scene, 1e-9);
  hr2d_light light = relit_light(RELIT_CLOSED, &first);
  hr2d_solution *cold = relit_solve(op, &light, NULL), *start, *warm = NULL;
  first.emission[0] *= 1 + 1e-7;
  start = relit_solve(op, &light, NULL);
  ck_assert_int_eq(hr2d_operator_solve(op, &light, cold, &warm, NULL), HR2D_OK);
  ck_assert_double_le(relit_distance(warm, start, RELIT_WALLS, 1), 1e-9);
  ck_assert_uint_lt(hr2d_solution_work(warm).gathers, hr2d_solution_work(start).gathers);
  hr2d_solution_destroy(cold);
  hr2d_solution_destroy(warm);
  hr2d_operator_destroy(op); /* a solution may be read after it */
  ck_assert_double_gt(hr2d_solution_average(start, 0, 0), 0.5);
  const double middle = 0.5;
  double b;
  ck_assert_int_eq(hr2d_solution_gather(start, 0, &middle, 1, &b), HR2D_OK);
  ck_assert_double_gt(b, 0.5);
  hr2d_solution_destroy(start);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A lamp in the shade of a screen, where the scene had light elsewhere: the elements were not
   divided for it, and the account says so instead of a target that is missed in silence. */
START_TEST(elements_that_do_not_suffice_are_told) {
  relit_paint first = {.emission = {1}, .reflectance = {.5, .5, .5, .5, 0, 0}}, other = first;
  for (int k = 0; k < RELIT_WALLS; k++) other.emission[k] = k == 4;
  for (int k = 0; k < RELIT_WALLS; k++) other.reflectance[k] = 0.95;
  first.reflectance[0] = first.reflectance[1] = 0; /* nothing to resolve there */
  hr2d_scene *scene = relit_scene(RELIT_CLOSED, &first, 1);
  hr2d_operator *op = relit_operator(scene, 1e-9);
  const hr2d_light light = relit_light(RELIT_CLOSED, &other);
  hr2d_solution *solution = NULL;
  hr2d_account account;
  ck_assert_int_eq(hr2d_operator_solve(op, &light, NULL, &solution, &account), HR2D_EACCURACY);
  ck_assert_ptr_nonnull(strstr(account.reason, "make an operator"));
  ck_assert_double_gt(account.average.estimate, 1e-9);
  ck_assert_double_lt(account.average.estimate, 1);
  hr2d_solution_destroy(solution);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

static void expect(hr2d_operator *op, const hr2d_light *light, const char *phrase) {
  hr2d_solution *solution = (hr2d_solution *)op;
  ck_assert_int_eq(hr2d_operator_solve(op, light, NULL, &solution, NULL), HR2D_EINVAL);
  ck_assert_ptr_null(solution);
  ck_assert_msg(strstr(hr2d_operator_message(op), phrase) != NULL, "%s",
                hr2d_operator_message(op));
}

START_TEST(values_that_are_not_valid_are_named) {
  const double nan[] = {1, NAN, 1, 1, 1, 1}, minus[] = {1, 1, 1, -1, 1, 1},
               many[] = {0, 0, 1.5, 0, 0, 0}, near[] = {1, 1.0000001, 1, 1, 1, 1}, one = 1;
  randoms r = randoms_stream(test_seed(), 70);
  relit_paint first;
  relit_draw(&first, &r);
  hr2d_scene *scene = relit_scene(RELIT_CLOSED, &first, 1);
  hr2d_operator *op = relit_operator(scene, 1e-2);
  hr2d_light light = HR2D_LIGHT_INIT;
  light.emission.value = nan;
  expect(op, &light, "light 0: emission of patch 1 is nan");
  light.emission.value = minus;
  expect(op, &light, "emission of patch 3 is -1: it must be at least 0");
  light.emission.value = NULL;
  light.reflectance.value = many;
  expect(op, &light, "reflectance of patch 2 is 1.5: it must be from 0 to 1");
  light.reflectance.value = NULL;
  light.temperature.value = minus;
  expect(op, &light, "temperature of patch 0 is 1: it has none");
  light.temperature.value = NULL;
  light.flux.value = minus;
  expect(op, &light, "flux of patch 0 is 1: it has none");
  light.flux.value = NULL;
  light.background.value = &one;
  expect(op, &light, "the background is 1: the scene has none");
  light.background.value = NULL;
  light.sun.value = &one;
  expect(op, &light, "the scene has no sun");
  light.sun.value = NULL;
  light.reflectance.value = near;
  expect(op, &light, "reflectance of patch 1 is 1.0000001:");
  hr2d_solution *own = relit_solve(op, NULL, NULL); /* it can be used all the same */
  ck_assert_str_eq(hr2d_operator_message(op), "");
  hr2d_solution_destroy(own);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Light for which no elements were made, and which the scene cannot have. */
START_TEST(light_that_elements_do_not_know_is_refused) {
  static const hr2d_sky_piece piece[] = {{-50, -10}, {20, 60}}, even[] = {{-60, -20}, {20, 60}};
  const double same[] = {1, 1}, jumps[] = {.5, 2}, both[] = {2, 2}, dark[] = {0, 0}, one = 1;
  const double *const sky[] = {same, dark, both, jumps};
  const char *const why[] = {"does not change at the bearing", "has no light",
                             "under mirrors the pieces", NULL};
  const hr2d_segment mirror = {{0, 0}, {0, 1}},
                     wall_at[] = {{{.5, 0}, {4, 0}}, {{2, 1}, {1, 1}}};
  for (int k = 0; k < 4; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    for (int m = 0; m < 2; m++)
      ck_assert_int_eq(test_add_patch(scene, wall_at[m], 1 - m, .5, HR2D_SIDES_FRONT), HR2D_OK);
    if (k != 1) ck_assert_int_eq(hr2d_scene_set_background(scene, &one, 1), HR2D_OK);
    if (k == 2) ck_assert_int_eq(hr2d_scene_add_mirror(scene, mirror), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_set_sky(scene, k == 2 ? even : piece, 2, sky[k], 1), HR2D_OK);
    test_commit(scene);
    hr2d_operator *op = relit_operator(scene, 1e-4);
    hr2d_light light = HR2D_LIGHT_INIT;
    light.sky.value = jumps;
    if (why[k])
      expect(op, &light, why[k]);
    else
      hr2d_solution_destroy(relit_solve(op, &light, NULL));
    hr2d_operator_destroy(op);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A call from a callback of another one is refused, and harms nothing. */
typedef struct intruder {
  hr2d_operator *op;
  int refused;
} intruder;

static hr2d_status intrude(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  intruder *i = ctx;
  hr2d_solution *none = NULL;
  double response[RELIT_WALLS];
  i->refused += hr2d_operator_solve(i->op, NULL, NULL, &none, NULL) == HR2D_ESTATE;
  i->refused += hr2d_operator_response(i->op, NULL, 0, 1, response) == HR2D_ESTATE;
  return HR2D_OK;
}

START_TEST(calls_from_callbacks_are_refused) {
  randoms r = randoms_stream(test_seed(), 90);
  relit_paint first;
  relit_draw(&first, &r);
  hr2d_scene *scene = relit_scene(RELIT_CLOSED, &first, 1);
  hr2d_operator *op = relit_operator(scene, 1e-4);
  intruder i = {op, 0};
  hr2d_solution *alone = relit_solve(op, NULL, NULL);
  hr2d_scene_set_progress(scene, intrude, &i);
  hr2d_solution *disturbed = relit_solve(op, NULL, NULL);
  hr2d_scene_set_progress(scene, NULL, NULL);
  ck_assert_int_gt(i.refused, 1);
  ck_assert_mem_eq(hr2d_solution_field(alone), hr2d_solution_field(disturbed),
                   hr2d_solution_field_size(alone) * sizeof(double));
  hr2d_solution_destroy(alone);
  hr2d_solution_destroy(disturbed);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

/* With ρ = 1 everywhere light that is sent has no solution; in the dark B = 0 has no gradient.
 */
START_TEST(a_gradient_without_an_adjoint_is_refused) {
  relit_paint white = {.emission = {0}}, grey = white;
  for (int k = 0; k < RELIT_WALLS; k++) white.reflectance[k] = 1;
  for (int k = 0; k < RELIT_WALLS; k++) grey.reflectance[k] = 0.5;
  hr2d_scene *scene = relit_scene(RELIT_CLOSED, &grey, 1);
  hr2d_operator *op = relit_operator(scene, 1e-4);
  const hr2d_light light = relit_light(RELIT_CLOSED, &white);
  double emission[RELIT_WALLS];
  const hr2d_values weights = {grey.reflectance, {0, 0, 0}};
  hr2d_gradient gradient = HR2D_GRADIENT_INIT;
  gradient.emission = emission;
  for (int k = 0; k < 2; k++) {
    hr2d_solution *dark = relit_solve(op, k ? NULL : &light, NULL);
    ck_assert_int_eq(hr2d_operator_gradient(op, dark, &weights, NULL, &gradient),
                     k ? HR2D_OK : HR2D_ENO_SOLUTION);
    hr2d_solution_destroy(dark);
  }
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_status stop(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  int *left = ctx;
  return --*left < 0 ? HR2D_STOPPED : HR2D_OK;
}

START_TEST(a_stopped_solve_can_be_made_again) {
  randoms r = randoms_stream(test_seed(), 80);
  relit_paint first;
  relit_draw(&first, &r);
  hr2d_scene *scene = relit_scene(RELIT_OPEN, &first, 1);
  hr2d_operator *op = relit_operator(scene, 1e-6);
  hr2d_account before, after;
  hr2d_solution *whole = relit_solve(op, NULL, &before), *again, *none = NULL;
  hr2d_operator_destroy(op);
  int stops = 0;
  hr2d_status status = HR2D_STOPPED;
  for (int k = 0; k < 100 && status;
       k++) { /* also while the account is made for the first time */
    int left = k;
    op = relit_operator(scene, 1e-6);
    for (int twice = 0; twice < 2; twice++) {
      hr2d_scene_set_progress(scene, stop, &left);
      status = hr2d_operator_solve(op, NULL, NULL, &none, NULL);
      hr2d_scene_set_progress(scene, NULL, NULL);
      stops += status == HR2D_STOPPED;
      if (status == HR2D_STOPPED) ck_assert_ptr_null(none);
      hr2d_solution_destroy(none);
      left = k;
      again = relit_solve(op, NULL, &after);
      ck_assert_mem_eq(hr2d_solution_field(whole), hr2d_solution_field(again),
                       hr2d_solution_field_size(whole) * sizeof(double));
      ck_assert_mem_eq(&before.average, &after.average, sizeof before.average);
      hr2d_solution_destroy(again);
    }
    hr2d_operator_destroy(op);
  }
  ck_assert_int_gt(stops, 6);
  hr2d_solution_destroy(whole);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A start that is farther off than darkness is not begun with: not a digit is lost. */
START_TEST(a_start_that_is_no_use_does_no_harm) {
  randoms r = randoms_stream(test_seed(), 100);
  relit_paint first;
  relit_draw(&first, &r);
  hr2d_scene *scene = relit_scene(RELIT_CLOSED, &first, 1);
  hr2d_operator *op = relit_operator(scene, 1e-10);
  const hr2d_light light = relit_light(RELIT_CLOSED, &first);
  hr2d_solution *cold = relit_solve(op, &light, NULL);
  for (int digits = 0; digits <= 200; digits += 20) {
    relit_paint bright = first;
    for (int k = 0; k < RELIT_WALLS; k++) bright.emission[k] *= pow(10, digits);
    const hr2d_light brighter = relit_light(RELIT_CLOSED, &bright);
    hr2d_solution *start = relit_solve(op, &brighter, NULL), *warm = NULL;
    hr2d_account account;
    ck_assert_int_eq(hr2d_operator_solve(op, &light, start, &warm, &account), HR2D_OK);
    ck_assert_double_le(relit_distance(warm, cold, RELIT_WALLS, 1), 1e-12);
    hr2d_solution_destroy(start);
    hr2d_solution_destroy(warm);
  }
  hr2d_solution_destroy(cold);
  hr2d_operator_destroy(op);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("operator calls") {
  ADD_TESTS("starts", a_warm_start_is_shorter, a_start_that_is_no_use_does_no_harm);
  ADD_TESTS("refused", elements_that_do_not_suffice_are_told,
            values_that_are_not_valid_are_named, light_that_elements_do_not_know_is_refused,
            calls_from_callbacks_are_refused, a_gradient_without_an_adjoint_is_refused);
  ADD_TESTS("stops", a_stopped_solve_can_be_made_again);
}
