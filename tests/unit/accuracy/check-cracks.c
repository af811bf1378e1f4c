/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plates that nearly touch, down to some roundings of each other.  Between them light goes to
   and fro as if their gap were 0: B_0 = E + ρ_0 H_0, H_0 = ρ_1 B_0, up to a few gaps, and H_1
   is B_0 on the part that faces the other plate. */
#include <math.h>

#include "support/support.h"

enum { PLATES = 3 };

#define RHO_0 .5
#define RHO_1 .8

/* A lit plate of length 1, one of `length` over it, and a third one that these two hide from
   each other in part. */
static hr2d_scene *plates(double start, double end, double length) {
  const double patch[PLATES][6] = {
      {0, 0, 1, 0, 1, RHO_0}, {length, start, 0, end, 0, RHO_1}, {1, -2, 2, -2, 0, .5}};
  return test_scene(patch, PLATES);
}

static void compare(double start, double end, double length, double target, double allowed) {
  hr2d_scene *scene = plates(start, end, length);
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  hr2d_account a;
  how.error = target;
  ck_assert_int_eq(hr2d_solve_to(scene, &how, &solution, &a), HR2D_OK);
  const double lit = 1 / (1 - RHO_0 * RHO_1);
  const double right[2][2] = {{lit, RHO_1 * lit / length}, {RHO_1 * lit, lit / length}};
  for (size_t k = 0; k < 2; k++) {
    const double off_b = fabs(hr2d_solution_average(solution, k, 0) / right[0][k] - 1);
    const double off_h = fabs(hr2d_solution_irradiance(solution, k, 0) / right[1][k] - 1);
    ck_assert_msg(off_b <= a.average.bound + allowed, "%g, %g: B of %zu off by %g, bound %g",
                  end, target, k, off_b, a.average.bound);
    ck_assert_msg(off_h <= a.irradiance.bound + allowed, "%g, %g: H of %zu off by %g, bound %g",
                  end, target, k, off_h, a.irradiance.bound);
    ck_assert_double_le(off_b, target + allowed);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}

static const double gap[] = {1e-9, 1e-11, 1e-12, 1e-13, 3e-14, 1e-14, 5e-15};
enum { GAPS = sizeof gap / sizeof *gap };

/* A plate's end over the middle of another one is not on it. */
START_TEST(plates_face_to_face) {
  for (int k = 0; k < GAPS; k++)
    for (double target = 1e-3; target > 1e-10; target *= 1e-3) {
      compare(gap[k], gap[k], 2, target, 64 * gap[k]);
      compare(gap[k], 2 * gap[k], 1.25, target, 64 * gap[k]);
    }
}
END_TEST

START_TEST(plates_that_meet_at_one_end) {
  for (int k = 0; k < GAPS; k++)
    for (double target = 1e-3; target > 1e-10; target *= 1e-3)
      compare(0, gap[k], 1, target, 64 * gap[k]);
}
END_TEST

/* With a gap that light leaves by, the values are others. */
START_TEST(a_wide_gap_is_told) {
  hr2d_scene *scene = plates(.1, .1, 1);
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  ck_assert_int_eq(hr2d_solve_to(scene, &how, &solution, NULL), HR2D_OK);
  ck_assert_double_lt(hr2d_solution_average(solution, 0, 0), .99 / (1 - RHO_0 * RHO_1));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("cracks") {
  ADD_TESTS("plates", plates_face_to_face, plates_that_meet_at_one_end, a_wide_gap_is_told);
}
