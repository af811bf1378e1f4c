/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors of solutions that had no target: of B and of H, averages and at points, where light
   changes in places that no leaf of the solution shows. */
#include <math.h>

#include "support/accuracy-scenes.h"
#include "support/support.h"

/* A solution by links, and all that it needs. */
typedef struct stage {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  hr2d_account account;
} stage;

static void clear(stage *s) {
  hr2d_solution_destroy(s->solution);
  hr2d_linkset_destroy(s->links);
  hr2d_hierarchy_destroy(s->hierarchy);
  hr2d_scene_destroy(s->scene);
}

/* Solves with constants on elements, and measures the errors. */
static stage measure(hr2d_scene *scene, double epsilon, unsigned order) {
  stage s = {.scene = scene};
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_target how = HR2D_TARGET_INIT;
  refine.epsilon = epsilon;
  how.error = 1e-8;
  how.points = 1;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &s.hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_set_order(s.hierarchy, order), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(s.hierarchy, NULL, NULL, NULL, NULL, &s.links), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(s.links, &refine), HR2D_OK);
  const hr2d_status status = hr2d_solve(s.links, NULL, &s.solution);
  if (status == HR2D_ENOT_CONVERGED) return s; /* rows of coarse links may exceed 1 */
  ck_assert_int_eq(status, HR2D_OK);
  ck_assert_int_eq(hr2d_solution_account(s.solution, &how, &s.account), HR2D_OK);
  return s;
}

/* An error that is known to be at least `min`, and about `about`. */
static void expect_error(hr2d_error e, double min, double about) {
  ck_assert_double_ge(e.bound, min);
  ck_assert_double_ge(e.estimate, 0.9 * about);
  ck_assert_double_le(e.bound, 1.5 * about + 1e-12);
}

/* A slit of the sun, .01 wide, on a ground of one leaf.  Right: B there is at least ½ and no
   more than all light ½(1 + .01); the leaf has the average of .01 sun and some sky. */
START_TEST(slit_of_the_sun) {
  const double sky = 0.01;
  const hr2d_sun sun = {.direction = {0, -1}, .irradiance = 1};
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_patch(scene, (hr2d_segment){{0, 0}, {1, 0}}, 0, .5, HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{-30, 20}, {.12, 20}}, 0, .5, HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{.13, 20}, {30, 20}}, 0, .5, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  test_commit(scene);
  stage s = measure(scene, 10, 1);
  const double is = hr2d_solution_at(s.solution, 0, .125, 0);
  /* Of the largest B, that of the sunlit slit or of the tops of the shades: ½(1 + sky). */
  expect_error(s.account.sup, (.5 - is) / .505, (.5 - is) / .505);
  ck_assert_double_ge(s.account.irradiance_sup.bound, (1 - 2 * is) / 1.01);
  clear(&s);
}
END_TEST

/* A lamp .02 wide and .01 above a floor of one leaf.  Below its middle ½ ∫ cos θ is the sine of
   the angle to its ends, 1/√2, less what the lamp gets back, for it is black. */
START_TEST(lamp_beside_a_floor) {
  hr2d_scene *scene =
      test_scene((const double[][6]){{0, 0, 1, 0, 0, .5}, {.63, .01, .61, .01, 1, 0}}, 2);
  stage s = measure(scene, 10, 1);
  const double right = sqrt(.5), is = hr2d_solution_irradiance_at(s.solution, 0, .62, 0);
  expect_error(s.account.sup, .5 * (right - is), .5 * (right - is));
  expect_error(s.account.irradiance_sup, (right - is) / right, (right - is) / right);
  clear(&s);
}
END_TEST

/* Two black plates, 2 wide and 1 apart, one of E = 1: H in the middle is 1/√2, the sine to the
   ends; the average is the form factor √(1 + ¼) − ½ (crossed strings). */
START_TEST(black_plates_have_errors_of_h) {
  hr2d_scene *scene =
      test_scene((const double[][6]){{2, 1, 0, 1, 1, 0}, {0, 0, 2, 0, 0, 0}}, 2);
  stage s = measure(scene, 10, 1);
  const double average = sqrt(1.25) - .5, middle = sqrt(.5), end = 1 / sqrt(5);
  ck_assert_double_eq_tol(hr2d_solution_irradiance(s.solution, 1, 0), average, 1e-12);
  ck_assert_double_le(s.account.irradiance.bound, 1e-9);
  const double max = fmax(middle - average, average - end) / middle;
  expect_error(s.account.irradiance_sup, max, max);
  clear(&s);
}
END_TEST

/* What is on elements, and what points gather from a much better solution. */
static double worst_error(const stage *s, const hr2d_solution *exact, int irradiance,
                          randoms *r) {
  const size_t bands = hr2d_scene_bands(s->scene);
  double worst = 0, value[ACCURACY_BANDS], largest[ACCURACY_BANDS] = {0};
  for (int pass = 0; pass < 2; pass++)
    for (size_t p = 0; p < hr2d_scene_patches(s->scene); p++)
      for (int k = 0; k < 60; k++) {
        const double u = random_unit(r), near = random_power(r, -9, -1);
        const double t = k % 3 == 0 ? u : k % 3 == 1 ? near : 1 - near;
        ck_assert_int_eq((irradiance ? hr2d_solution_gather_irradiance
                                     : hr2d_solution_gather)(exact, p, &t, 1, value),
                         HR2D_OK);
        for (size_t b = 0; b < bands; b++) {
          largest[b] = fmax(largest[b], value[b]);
          const double is = (irradiance ? hr2d_solution_irradiance_at
                                        : hr2d_solution_at)(s->solution, p, t, b);
          if (pass && largest[b] > 0) worst = fmax(worst, fabs(is - value[b]) / largest[b]);
        }
      }
  return worst;
}

START_TEST(random_scenes_are_within_the_bounds) {
  const size_t rounds = test_some(40, 3);
  for (size_t k = 0; k < rounds; k++) {
    randoms r = randoms_stream(test_seed(), (int)k);
    accuracy_scene drawn = accuracy_draw(test_seed(), (int)k, .9);
    hr2d_scene *scene = accuracy_make(&drawn);
    stage s = measure(scene, random_power(&r, -2, 1), k % 4 == 3 ? 3 : 1);
    if (!s.solution) {
      clear(&s);
      accuracy_free(&drawn);
      continue;
    }
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *exact;
    target.error = 1e-9;
    const hr2d_status status = hr2d_solve_to(scene, &target, &exact, NULL);
    ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    const double b = worst_error(&s, exact, 0, &r), h = worst_error(&s, exact, 1, &r);
    ck_assert_msg(b <= s.account.sup.bound + 1e-12, "scene %zu, %s: B %g, bound %g", k,
                  drawn.shape, b, s.account.sup.bound);
    ck_assert_msg(h <= s.account.irradiance_sup.bound + 1e-12, "scene %zu, %s: H %g, bound %g",
                  k, drawn.shape, h, s.account.irradiance_sup.bound);
    ck_assert_double_ge(s.account.sup.estimate, 0.5 * b - 1e-9);
    hr2d_solution_destroy(exact);
    clear(&s);
    accuracy_free(&drawn);
  }
}
END_TEST

START_TEST(both_calls_say_the_same) {
  hr2d_scene *scene =
      test_scene((const double[][6]){{0, 0, 1, 0, 1, .5}, {0, 1, 0, 0, 0, .7}}, 2);
  stage s = measure(scene, .3, 1);
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_error average, sup;
  how.error = 1e-8;
  ck_assert_int_eq(hr2d_solution_error(s.solution, &how, &average, &sup), HR2D_OK);
  ck_assert_double_eq_tol(average.estimate, s.account.average.estimate, 1e-7);
  ck_assert_double_eq_tol(sup.estimate, s.account.sup.estimate, 1e-7);
  ck_assert_uint_eq(s.account.order, 1);
  ck_assert_uint_eq(s.account.links, hr2d_linkset_counts(s.links).links);
  ck_assert_uint_eq(s.account.solves, 1);
  clear(&s);
}
END_TEST

TEST_SUITE("measured errors") {
  ADD_TESTS("errors", slit_of_the_sun, lamp_beside_a_floor, black_plates_have_errors_of_h,
            random_scenes_are_within_the_bounds, both_calls_say_the_same);
}
