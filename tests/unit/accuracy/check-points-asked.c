/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors at points are measured where they are asked for: averages alone gather at no point,
   and have the same errors to the last bit. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "estimate/corner-residuals.h"
#include "links/linkset-impl.h"
#include "support/memory.h"
#include "support/support.h"

static const double pi = 3.14159265358979323846;

enum { SIDES = 20 };

/* A convex room: nothing shades, and the only gathers are those at its corners. */
static hr2d_scene *convex_room(const hr2d_allocator *hooks) {
  hr2d_scene *scene = test_new_scene(hooks);
  for (int k = 0; k < SIDES; k++) {
    const double from = 2 * pi * k / SIDES, to = 2 * pi * ((k + 1) % SIDES) / SIDES;
    test_add_patch(scene, (hr2d_segment){{cos(from), sin(from)}, {cos(to), sin(to)}}, k == 0,
                   .6, HR2D_SIDES_FRONT);
  }
  test_commit(scene);
  return scene;
}

/* Panels over a floor, in a row without end: points see past its images. */
static hr2d_scene *row_of_panels(const hr2d_allocator *hooks) {
  hr2d_scene *scene = test_new_scene(hooks);
  test_add_patch(scene, (hr2d_segment){{0, .5}, {.8, 1}}, 1, .3, HR2D_SIDES_BOTH);
  test_add_patch(scene, (hr2d_segment){{0, 0}, {2, 0}}, 0, .5, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){2, 0}), HR2D_OK);
  test_commit(scene);
  return scene;
}

typedef struct answer {
  hr2d_solution *solution;
  hr2d_account account;
} answer;

static answer solve(const hr2d_scene *scene, double error, hr2d_norm norm, int points) {
  hr2d_target target = HR2D_TARGET_INIT;
  answer a;
  target.error = error;
  target.norm = norm;
  target.points = points;
  const hr2d_status status = hr2d_solve_to(scene, &target, &a.solution, &a.account);
  ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
  ck_assert_ptr_nonnull(a.solution);
  return a;
}

static int same(hr2d_error a, hr2d_error b) {
  return a.estimate == b.estimate && a.bound == b.bound;
}

static void expect_unknown(const hr2d_account *a) {
  ck_assert(isnan(a->sup.estimate) && isnan(a->sup.bound));
  ck_assert(isnan(a->irradiance_sup.estimate) && isnan(a->irradiance_sup.bound));
}

static void expect_known(const hr2d_account *a) {
  ck_assert(isfinite(a->sup.bound) && a->sup.bound >= a->sup.estimate);
  ck_assert(isfinite(a->irradiance_sup.bound) && a->irradiance_sup.estimate > 0);
}

static void compare(const hr2d_scene *scene, double error) {
  const answer alone = solve(scene, error, HR2D_NORM_AVERAGE, 0),
               all = solve(scene, error, HR2D_NORM_AVERAGE, 1);
  expect_unknown(&alone.account);
  expect_known(&all.account);
  ck_assert(isfinite(alone.account.average.bound));
  ck_assert(same(alone.account.average, all.account.average));
  ck_assert(same(alone.account.irradiance, all.account.irradiance));
  ck_assert_uint_eq(alone.account.solves, all.account.solves);
  ck_assert_uint_eq(alone.account.links, all.account.links);
  ck_assert_uint_eq(alone.account.kernels, all.account.kernels);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    for (size_t b = 0; b < hr2d_scene_bands(scene); b++)
      ck_assert_double_eq(hr2d_solution_average(alone.solution, k, b),
                          hr2d_solution_average(all.solution, k, b));
  hr2d_solution_destroy(alone.solution);
  hr2d_solution_destroy(all.solution);
}

/* Gaps, shadows, corners, a sky, a period and bands. */
START_TEST(averages_have_the_same_errors_without_points) {
  const char *const file[] = {"lit-room.geojson", "partition.geojson", "solar-panels.geojson",
                              "street-canyon.geojson", "enfilade.geojson"};
  for (size_t k = 0; k < sizeof file / sizeof *file; k++)
    for (int digits = 2; digits < 7; digits += 2) {
      hr2d_scene *scene = test_shipped_scene(file[k]);
      compare(scene, pow(10, -digits));
      hr2d_scene_destroy(scene);
    }
  hr2d_scene *row = row_of_panels(NULL);
  compare(row, 1e-3);
  hr2d_scene_destroy(row);
}
END_TEST

START_TEST(the_sup_norm_asks_for_points) {
  hr2d_scene *scene = test_shipped_scene("partition.geojson");
  const answer a = solve(scene, 1e-2, HR2D_NORM_SUP, 0),
               b = solve(scene, 1e-2, HR2D_NORM_SUP, 1);
  expect_known(&a.account);
  ck_assert(same(a.account.sup, b.account.sup));
  ck_assert(same(a.account.irradiance_sup, b.account.irradiance_sup));
  hr2d_solution_destroy(a.solution);
  hr2d_solution_destroy(b.solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The points that an account is known to gather at: at corners, and, to look past the images of
   a period, three of each leaf of the cell. */
static long count_points(const hr2d_scene *scene, const hr2d_solution *solution, int period) {
  const hr2d_linkset *links = hr2d_solution_links(solution);
  const hr2d_hierarchy *h = hr2d_linkset_hierarchy(links);
  long points = (long)hr2di_contacts_points(links);
  for (uint64_t k = 0; k < hr2d_hierarchy_count(h).elements && period; k++) {
    const hr2d_element *e = &hr2d_hierarchy_elements(h)[k];
    if (e->patch < hr2d_scene_patches(scene) && !e->child) points += 3;
  }
  return points;
}

static long count_allocations(test_memory *memory, const hr2d_scene *scene, int points,
                              int period, long *gathered) {
  const long before = LONG_MAX / 2;
  memory->until_failure = before;
  const answer a = solve(scene, 1e-3, HR2D_NORM_AVERAGE, points);
  const long made = before - memory->until_failure;
  *gathered = count_points(scene, a.solution, period);
  hr2d_solution_destroy(a.solution);
  return made;
}

/* Each gather at a point takes memory: without points there are at least as many allocations
   less. */
START_TEST(averages_gather_at_no_point) {
  hr2d_scene *(*const make[])(const hr2d_allocator *) = {convex_room, row_of_panels};
  for (int period = 0; period < 2; period++) {
    test_memory memory = {.until_failure = LONG_MAX / 2};
    const hr2d_allocator hooks = test_hooks(&memory);
    hr2d_scene *scene = make[period](&hooks);
    long points;
    const long alone = count_allocations(&memory, scene, 0, period, &points);
    const long all = count_allocations(&memory, scene, 1, period, &points);
    printf("scene %d: %ld allocations, %ld with %ld points\n", period, alone, all, points);
    ck_assert_int_ge(points, 2 * (period ? 3 : SIDES));
    ck_assert_int_ge(all - alone, points);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Solutions by links: what is asked for is measured. */
START_TEST(other_solutions_are_measured_as_asked) {
  test_links t =
      test_make_links(test_shipped_scene("partition.geojson"), NULL, NULL, NULL, NULL);
  hr2d_solution *solution;
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_account a, b;
  hr2d_error sup;
  test_refine(&t, .5, 24);
  ck_assert_int_eq(hr2d_solve(t.links, NULL, &solution), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_account(solution, NULL, &a), HR2D_OK);
  expect_unknown(&a);
  how.points = 1;
  ck_assert_int_eq(hr2d_solution_account(solution, &how, &b), HR2D_OK);
  expect_known(&b);
  ck_assert_double_eq_tol(a.average.estimate, b.average.estimate, a.average.bound / 10);
  /* The distance from a reference is the error up to that of the reference. */
  ck_assert_double_le(2 * a.average.estimate - a.average.bound, b.average.bound);
  ck_assert_int_eq(hr2d_solution_error(solution, NULL, NULL, &sup), HR2D_OK);
  ck_assert(same(sup, b.sup) || fabs(sup.estimate - b.sup.estimate) <= b.sup.bound / 10);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("points asked") {
  ADD_TESTS("points", averages_have_the_same_errors_without_points,
            the_sup_norm_asks_for_points, averages_gather_at_no_point,
            other_solutions_are_measured_as_asked);
}
