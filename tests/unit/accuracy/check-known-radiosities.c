/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors where the radiosity is known: from reference tables, from an independent method, and
   from much finer solves.  Targets are met, bounds hold, estimates are close. */
#include <math.h>
#include <string.h>

#include "independent/accuracy-nystrom.h"
#include "support/accuracy-tally.h"
#include "support/support.h"

static double kappa_of(const double (*patch)[6], size_t count) {
  double max = 0;
  for (size_t k = 0; k < count; k++) max = fmax(max, patch[k][5]);
  return 1 / (1 - max);
}

/* B at ¼ and ½ after one more gather, relative to the largest of them. */
static double point_error(const radiosity_scene *s, const hr2d_solution *solution) {
  double worst = 0, max = 0;
  for (size_t k = 0; k < s->patches; k++) max = fmax(max, fmax(s->quarter[k], s->half[k]));
  for (size_t k = 0; k < s->patches; k++) {
    double value[2];
    ck_assert_int_eq(hr2d_solution_gather(solution, k, (const double[]){.25, .5}, 2, value),
                     HR2D_OK);
    worst = fmax(worst, fabs(value[0] - s->quarter[k]) / max);
    worst = fmax(worst, fabs(value[1] - s->half[k]) / max);
  }
  return worst;
}

START_TEST(targets_are_met_on_reference_scenes) {
  const double target[] = {1e-3, 1e-6, 1e-9, 1e-12};
  const radiosity_scenes all = accuracy_reference();
  accuracy_tally t = {0, 0};
  for (size_t k = 0; k < all.count; k++) {
    const radiosity_scene *s = &all.scene[k];
    const double rounding = ACCURACY_ROUNDING * kappa_of(s->patch, s->patches);
    hr2d_scene *scene = radiosity_scene_make(s, NULL);
    ck_assert_ptr_nonnull(scene);
    for (int q = 0; q < 4; q++) {
      hr2d_account a;
      hr2d_solution *solution = accuracy_solve(scene, target[q], HR2D_NORM_AVERAGE, &a);
      const double error = radiosity_average_error(s, solution);
      accuracy_check_account(&a, solution);
      ck_assert_msg(error <= fmax(target[q], rounding), "%s at %g: error %g", s->name,
                    target[q], error);
      ck_assert_msg(accuracy_is_bounded(a.average, error, 1e-14, rounding),
                    "%s at %g: %g above %g", s->name, target[q], error, a.average.bound);
      accuracy_compare(&t, a.average, error, 1e-14, rounding,
                       accuracy_min_estimate(scene, target[q]));
      /* Kinks that do not matter to averages stay inside elements, and points show them. */
      ck_assert_double_le(point_error(s, solution), a.sup.bound + 1e-13);
      if (q == 3) ck_assert_double_le(point_error(s, solution), s->patches > 4 ? 1e-8 : 1e-12);
      hr2d_solution_destroy(solution);
    }
    hr2d_scene_destroy(scene);
  }
  ck_assert_int_gt(t.compared, 10);
  ck_assert_msg(accuracy_is_fair(&t), "%d of %d", t.close, t.compared);
}
END_TEST

static void check_nystrom_at(const nystrom *n, double target, double known, accuracy_tally *t) {
  const double rounding = ACCURACY_ROUNDING * kappa_of(n->patch, 2);
  hr2d_scene *scene = test_scene(n->patch, 2);
  hr2d_account a;
  hr2d_solution *solution = accuracy_solve(scene, target, HR2D_NORM_AVERAGE, &a);
  double error = 0;
  for (size_t k = 0; k < 2; k++)
    error = fmax(error, fabs(hr2d_solution_average(solution, k, 0) / n->average[k] - 1));
  const double *w = n->patch[1];
  ck_assert_msg(error <= target + known + rounding,
                "(%g %g)-(%g %g), rho %g, target %g: error %g", w[0], w[1], w[2], w[3], w[5],
                target, error);
  ck_assert_msg(accuracy_is_bounded(a.average, error, known, rounding),
                "(%g %g)-(%g %g), rho %g, target %g: error %g above %g", w[0], w[1], w[2], w[3],
                w[5], target, error, a.average.bound);
  accuracy_compare(t, a.average, error, known, rounding, 0);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}

/* Averages are known so well, and points as the other method integrates G beside a thin gap. */
static void check_nystrom(const nystrom *n, double known, double points, accuracy_tally *t) {
  for (double target = 1e-3; target > 1e-13; target *= 1e-3)
    check_nystrom_at(n, target, known, t);
  hr2d_scene *scene = test_scene(n->patch, 2);
  hr2d_account a;
  hr2d_solution *solution = accuracy_solve(scene, 1e-14, HR2D_NORM_AVERAGE, &a);
  for (size_t k = 0; k < 2; k++) {
    double value[3];
    ck_assert_int_eq(hr2d_solution_gather(solution, k, n->place, 3, value), HR2D_OK);
    for (int q = 0; q < 3; q++)
      ck_assert_double_le(fabs(value[q] / n->value[k][q] - 1), points);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}

static const double reflectances[] = {.5, .9, .999};

START_TEST(corners_agree_with_another_method) {
  const double angle[] = {20, 30, 60, 90, 120, 150}, rho = reflectances[_i];
  accuracy_tally t = {0, 0};
  for (int k = 0; k < 6; k++) {
    const nystrom n = nystrom_corner(angle[k], k ? 1 : .3, rho);
    check_nystrom(&n, 1e-14, 1e-12, &t);
  }
  ck_assert_msg(accuracy_is_fair(&t), "%d of %d", t.close, t.compared);
}
END_TEST

START_TEST(a_narrow_corner_agrees_with_another_method) {
  accuracy_tally t = {0, 0};
  const double rho = reflectances[_i];
  const nystrom n = nystrom_corner(10, 1, rho);
  check_nystrom(&n, rho > .99 ? 1e-12 : 1e-13, 1e-12, &t);
  ck_assert_msg(accuracy_is_fair(&t), "%d of %d", t.close, t.compared);
}
END_TEST

/* Gaps.  If the floor is much wider than the ceiling, the effect of an end on the floor
   returns to the ceiling. */
START_TEST(gaps_agree_with_another_method) {
  const double gap[][3] = {{.1, 0, 1}, {.01, .3, .7}, {.02, .1, 2}, {1, -.3, .7}, {10, 0, 1}};
  accuracy_tally t = {0, 0};
  for (int k = 0; k < 5; k++) {
    const nystrom n = nystrom_parallel(gap[k][0], gap[k][1], gap[k][2], reflectances[_i]);
    check_nystrom(&n, 1e-14, 1e-10, &t);
  }
  ck_assert_msg(accuracy_is_fair(&t), "%d of %d", t.close, t.compared);
}
END_TEST

/* Walls on a floor of one patch, or of three that end where walls stand. */
static hr2d_scene *make_flooring(int cut, double rho) {
  const double foot[] = {0, 1, 2, 8};
  double patch[8][6];
  size_t count = 0;
  for (int k = 0; k < (cut ? 3 : 1); k++) {
    const double floor[6] = {foot[k], 0, cut ? foot[k + 1] : 8, 0, .6, rho};
    memcpy(patch[count++], floor, sizeof floor);
  }
  const double wall[][6] = {{1, 0, 4.2, 2.6, 0, .9},
                            {4.2, 2.6, 1, 0, 0, .8},
                            {2, 0, 7.8, 5.3, .1, .9},
                            {7.8, 5.3, 2, 0, 0, .7}};
  for (int k = 0; k < 4; k++) memcpy(patch[count++], wall[k], sizeof wall[k]);
  return test_scene((const double(*)[6])patch, count);
}

static void compare_floorings(double rho, double target) {
  const double rounding = 10 * ACCURACY_ROUNDING;
  hr2d_scene *scene[] = {make_flooring(0, rho), make_flooring(1, rho)};
  hr2d_solution *solution[2];
  hr2d_account a[2];
  for (int m = 0; m < 2; m++)
    solution[m] = accuracy_solve(scene[m], target, HR2D_NORM_AVERAGE, &a[m]);
  ck_assert_str_eq(a[0].reason, "");
  for (size_t w = 1; w < 5; w++) {
    const double one = hr2d_solution_average(solution[0], w, 0);
    const double error = fabs(one / hr2d_solution_average(solution[1], w + 2, 0) - 1);
    ck_assert_double_le(error, 2 * target + rounding);
    ck_assert_double_le(error, a[0].average.bound + a[1].average.bound + rounding);
  }
  for (int m = 0; m < 2; m++) {
    hr2d_solution_destroy(solution[m]);
    hr2d_scene_destroy(scene[m]);
  }
}

START_TEST(feet_of_walls_are_as_corners) {
  for (double target = 1e-2; target > 1e-13; target *= 1e-2) {
    compare_floorings(0, target);
    compare_floorings(.9, target);
  }
}
END_TEST

/* Where patches face no other but the surroundings, and hide these from each other: events of
   the background alone. */
static hr2d_scene *make_backs(void) {
  const double light = .5, rho = .9, sky = 1;
  const hr2d_segment at[] = {{{0, 0}, {1, 0}}, {{.1, .5}, {.5, .6}}, {{.4, .9}, {.9, .8}}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < 3; k++)
    ck_assert_int_eq(test_add_patch(scene, at[k], light, rho, HR2D_SIDES_FRONT), HR2D_OK);
  /* The floor's light comes back from a wall. */
  const hr2d_segment wall = {{-1, 1}, {-1, 0}};
  ck_assert_int_eq(test_add_patch(scene, wall, 0, rho, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

/* A wall whose end hangs just above a floor; a narrow room with much reflection, in which few
   coefficients make light. */
static hr2d_scene *make_hard(int k) {
  const double hanging[][6] = {
      {0, 0, 1, 0, 1, .9}, {.45, .01, .45, 1, 0, .9}, {.45, 1, .45, .01, 0, .9}};
  const double narrow[][6] = {{.94264477929416823, .33379757349245182, -.99903169207574294,
                               .043996343351213753, .3615, .999},
                              {-.99903169207574294, .043996343351213753, -.46774801041040093,
                               -.88386186633269315, .65, .999},
                              {-.46774801041040093, -.88386186633269315, .94264477929416823,
                               .33379757349245182, 0, .999}};
  return k == 2 ? make_backs() : test_scene(k ? narrow : hanging, 3);
}

START_TEST(hard_places_are_met) {
  hr2d_scene *scene = make_hard(_i);
  hr2d_account a;
  hr2d_solution *truth = accuracy_solve(scene, 1e-13, HR2D_NORM_AVERAGE, &a);
  for (double target = 1e-2; target > 1e-9; target *= .1)
    for (int norm = 0; norm < (target < 1e-4 ? 1 : 2); norm++) {
      hr2d_solution *solution = accuracy_solve(scene, target, (hr2d_norm)norm, &a);
      ck_assert_str_eq(a.reason, "");
      for (size_t p = 0; p < hr2d_scene_patches(scene); p++) {
        const double right = hr2d_solution_average(truth, p, 0);
        const double error = fabs(hr2d_solution_average(solution, p, 0) / right - 1);
        ck_assert(norm == 1 || error <= target);
        ck_assert_double_le(error, a.average.bound);
      }
      hr2d_solution_destroy(solution);
    }
  hr2d_solution_destroy(truth);
  hr2d_scene_destroy(scene);
}
END_TEST

/* As small as can be had. */
START_TEST(an_error_of_nothing_takes_what_doubles_give) {
  const char *name[] = {"par_d0.1_rho0.9", "orth_touch_rho0.7", "square_rho0.9"};
  const radiosity_scenes all = accuracy_reference();
  for (int k = 0; k < 3; k++) {
    const radiosity_scene *s = radiosity_scenes_find(&all, name[k]);
    hr2d_scene *scene = test_named_scene(name[k]);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_account a;
    hr2d_solution *solution;
    target.error = HR2D_SMALLEST_ERROR;
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &a), HR2D_OK);
    ck_assert_double_le(a.average.estimate, 1e-13);
    if (s) ck_assert_double_le(radiosity_average_error(s, solution), 2e-13);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* The paper's algorithm against the tables. */
START_TEST(errors_of_other_solutions_are_known) {
  const radiosity_scenes all = accuracy_reference();
  for (size_t k = 0; k < all.count; k++) {
    const radiosity_scene *s = &all.scene[k];
    for (int closure = 0; closure < 2; closure++) {
      test_links t = test_make_links(radiosity_scene_make(s, NULL), NULL, NULL, NULL, NULL);
      hr2d_error average, sup;
      test_refine(&t, .1, 8);
      hr2d_solution *solution = test_solve(&t, closure);
      const double error = radiosity_average_error(s, solution);
      ck_assert_int_eq(hr2d_solution_error(solution, NULL, &average, &sup), HR2D_OK);
      if (error > 1e-12)
        ck_assert_msg(fabs(average.estimate / error - 1) < .05, "%s: %g for %g", s->name,
                      average.estimate, error);
      ck_assert_double_ge(average.bound * (1 + 1e-9) + 1e-13, error);
      ck_assert_double_ge(sup.bound, sup.estimate);
      hr2d_solution_destroy(solution);
      test_free_links(&t);
    }
  }
}
END_TEST

/* Negative control: compared with a wrong reference, bound and estimate must fail. */
START_TEST(a_wrong_truth_is_noticed) {
  const radiosity_scenes all = accuracy_reference();
  const radiosity_scene *s = radiosity_scenes_find(&all, "square_rho0.9");
  radiosity_scene wrong = *s;
  accuracy_tally t = {0, 0};
  wrong.average[2] *= 1 + 1e-5;
  hr2d_scene *scene = radiosity_scene_make(s, NULL);
  hr2d_account a;
  hr2d_solution *solution = accuracy_solve(scene, 1e-9, HR2D_NORM_AVERAGE, &a);
  ck_assert(accuracy_is_bounded(a.average, radiosity_average_error(s, solution), 1e-14, 1e-12));
  const double error = radiosity_average_error(&wrong, solution);
  ck_assert(!accuracy_is_bounded(a.average, error, 1e-14, 1e-12));
  accuracy_compare(&t, a.average, error, 1e-14, 1e-12, 0);
  ck_assert_int_eq(t.compared, 1);
  ck_assert(!accuracy_is_fair(&t));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("known radiosities") {
  ADD_TESTS("tables", targets_are_met_on_reference_scenes,
            an_error_of_nothing_takes_what_doubles_give, errors_of_other_solutions_are_known,
            a_wrong_truth_is_noticed);
  REPEAT_TESTS(3, "another method", corners_agree_with_another_method,
               a_narrow_corner_agrees_with_another_method, gaps_agree_with_another_method);
  ADD_TESTS("finer solves", feet_of_walls_are_as_corners);
  REPEAT_TESTS(3, "finer solves", hard_places_are_met);
}
