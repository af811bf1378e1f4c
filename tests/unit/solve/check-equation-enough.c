/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A solve that ends where nothing is off any more is right in the dark, too, with fewer gathers
   than the norm asks for. */
#include <math.h>

#include "estimate/graded-solve.h"
#include "solve/equation.h"
#include "solve/solve-how.h"
#include "support/slow-scenes.h"
#include "support/support.h"

enum { PATCHES = 400 };

#define FLOOR 1e-12

/* Squares in a room, dark in its depth. */
static hr2d_scene *squares(hr2di_graded *graded) {
  hr2d_scene *scene = NULL;
  hr2di_message message;
  const hr2di_resolution fineness = {.order = 2, .target = 0.1};
  const hr2d_target target = HR2D_TARGET_INIT;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(slow_add(scene, SLOW_SQUARES, PATCHES), HR2D_OK);
  test_commit(scene);
  ck_assert_int_eq(hr2di_graded_refine(graded, scene, &fineness, &target, &message), HR2D_OK);
  return scene;
}

static hr2d_solution *solve(hr2d_linkset *links, double tolerance, double relative) {
  hr2d_solution *solution = NULL;
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.tolerance = tolerance;
  hr2di_equation_how how = hr2di_equation_how_of(links);
  how.enough = (hr2di_stopping_test){.part = relative, .floor = FLOOR};
  ck_assert_int_eq(hr2di_solve(links, &how, &options, &solution), HR2D_OK);
  return solution;
}

/* The largest relative error of an average of H. */
static double max_off(const hr2d_solution *s, const hr2d_solution *exact, size_t patches) {
  double max = 0;
  for (size_t k = 0; k < patches; k++) {
    const double h = hr2d_solution_irradiance(exact, k, 0);
    max = fmax(max, fabs(hr2d_solution_irradiance(s, k, 0) - h) / h);
  }
  return max;
}

START_TEST(dark_patches_are_right) {
  hr2di_graded graded;
  hr2d_scene *scene = squares(&graded);
  const size_t n = hr2d_scene_patches(scene);
  hr2d_solution *exact = solve(graded.links, 1e-15, 0);
  for (double part = 1e-2; part > 1e-9; part *= 0.01) {
    hr2d_solution *norm = solve(graded.links, part, 0);
    hr2d_solution *dark = solve(graded.links, 1e-15, part);
    const double off = max_off(dark, exact, n);
    printf("%.0e: off by %.1e after %llu gathers, by the norm %.1e\n", part, off,
           (unsigned long long)hr2d_solution_work(dark).gathers, max_off(norm, exact, n));
    ck_assert_double_le(off, 4 * part);
    ck_assert_uint_lt(hr2d_solution_work(dark).gathers, hr2d_solution_work(exact).gathers);
    ck_assert_double_gt(max_off(norm, exact, n), 4 * part); /* the norm is not enough */
    hr2d_solution_destroy(norm);
    hr2d_solution_destroy(dark);
  }
  hr2d_solution_destroy(exact);
  hr2di_graded_clear(&graded);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("end of a solve") {
  ADD_TESTS("dark", dark_patches_are_right);
}
