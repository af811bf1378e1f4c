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

static const double targets[] = {1e-3, 1e-6, 1e-9};
enum { TARGETS = sizeof targets / sizeof *targets };

/* A plate's end over the middle of another one is not on it. */
START_TEST(plates_face_to_face) {
  for (size_t k = 0; k < GAPS; k++)
    for (size_t t = 0; t < TARGETS; t++) {
      if (!test_meets(k, t, TARGETS)) continue;
      compare(gap[k], gap[k], 2, targets[t], 64 * gap[k]);
      compare(gap[k], 2 * gap[k], 1.25, targets[t], 64 * gap[k]);
    }
}
END_TEST

START_TEST(plates_that_meet_at_one_end) {
  for (size_t k = 0; k < GAPS; k++)
    for (size_t t = 0; t < TARGETS; t++)
      if (test_meets(k, t, TARGETS)) compare(0, gap[k], 1, targets[t], 64 * gap[k]);
}
END_TEST

/* Beside the end of the lit plate, and beside its foot on the longer one, light changes within
   some gaps.  As a function of the distance in gaps it is the same for all narrow gaps. */
enum { POINTS = 8 };
#define LONGER 1.25

typedef struct layer {
  double h[POINTS], b[POINTS];
  hr2d_account account;
} layer;

static layer solve_layer(double width, double target, hr2d_norm norm) {
  static const double away[POINTS] = {0, .5, 1, 4, 0, 1, -1, 4};
  hr2d_scene *scene = plates(width, width, LONGER);
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  layer l;
  how.error = target;
  how.norm = norm;
  how.points = 1;
  const hr2d_status status = hr2d_solve_to(scene, &how, &solution, &l.account);
  ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
  for (size_t k = 0; k < POINTS; k++) {
    const size_t patch = k >= 4;
    const double off = away[k] * width;
    const double t = patch ? (LONGER - 1 + off) / LONGER : 1 - off;
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, patch, &t, 1, &l.h[k]), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather(solution, patch, &t, 1, &l.b[k]), HR2D_OK);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return l;
}

/* Values at points of gaps of 1e-7 are within this of their limits. */
#define NARROW 1e-5

static void compare_layers(const layer *is, const layer *right, double width) {
  const double max = 1 / (1 - RHO_0 * RHO_1);
  const double allowed_h = is->account.irradiance_sup.bound * max + NARROW;
  const double allowed_b = is->account.sup.bound * max + NARROW;
  for (size_t k = 0; k < POINTS; k++) {
    ck_assert_msg(fabs(is->h[k] - right->h[k]) <= allowed_h,
                  "gap %g, point %zu: H of %g and %g, bound %g", width, k, is->h[k],
                  right->h[k], allowed_h);
    ck_assert_msg(fabs(is->b[k] - right->b[k]) <= allowed_b,
                  "gap %g, point %zu: B of %g and %g, bound %g", width, k, is->b[k],
                  right->b[k], allowed_b);
  }
}

START_TEST(light_changes_within_gaps) {
  const layer right = solve_layer(1e-7, 1e-7, HR2D_NORM_SUP);
  ck_assert_double_lt(right.account.irradiance_sup.bound, NARROW);
  ck_assert_double_gt(fabs(right.h[0] - right.h[3]), 0.01); /* or nothing is tested */
  for (size_t k = 0; k < GAPS; k++)
    for (size_t t = 0; t < 2; t++) {
      if (!test_meets(k, t, 2)) continue;
      const layer average = solve_layer(gap[k], targets[t], HR2D_NORM_AVERAGE);
      const layer sup = solve_layer(gap[k], targets[t], HR2D_NORM_SUP);
      compare_layers(&average, &right, gap[k]);
      compare_layers(&sup, &right, gap[k]);
      if (gap[k] > 1e-10) ck_assert_double_lt(sup.account.irradiance_sup.bound, 0.01);
    }
}
END_TEST

/* A plan with eleven decimals.  Lines through the ends of two walls that are nearly in one line
   pass the feet of others within 1e-11, so that elements end beside feet, and not only there.
 */
static const double plan[][6] = {
    {-3e-11, -0.0, 4.57383802471, -2.01990240447, 1, .5},
    {4.57383802471, -2.01990240447, 7.44209943908, 4.47494759069, 0, .5},
    {7.44209943908, 4.47494759069, 2.86826141431, 6.49484999514, 0, .5},
    {2.86826141431, 6.49484999514, -3e-11, -0.0, 0, .5},
    {2.141096548688621, 4.848268306199442, 4.24506204009, 3.91911320019, 0, .5},
    {4.24506204009, 3.91911320019, 2.141096548688621, 4.848268306199442, 0, .5},
    {4.88539936357, 3.63632686351, 6.714934573464015, 2.828365901773809, 0, .5},
    {6.714934573464015, 2.828365901773809, 4.88539936357, 3.63632686351, 0, .5},
    {1.373533634997699, 3.110209856808681, 3.11159208441, 2.34264694315, 0, .5},
    {3.11159208441, 2.34264694315, 1.373533634997699, 3.110209856808681, 0, .5},
    {3.75192940789, 2.05986060652, 5.947371659754003, 1.090307452352648, 0, .5},
    {5.947371659754003, 1.090307452352648, 3.75192940789, 2.05986060652, 0, .5},
    {3.513247956137045, 4.242297584883309, 3.67484014848, 4.60820462685, 0, .5},
    {3.67484014848, 4.60820462685, 3.513247956137045, 4.242297584883309, 0, .5},
    {3.95762648513, 5.24854195034, 4.240412821760488, 5.888879273796394, 0, .5},
    {4.240412821760488, 5.888879273796394, 3.95762648513, 5.24854195034, 0, .5},
};

/* Such elements do not see past the wall that stands on them. */
START_TEST(elements_end_beside_feet) {
  const size_t patches = sizeof plan / sizeof *plan;
  hr2d_scene *scene = test_scene(plan, patches);
  double average[2][16], bound[2];
  for (int k = 0; k < 2; k++) {
    hr2d_target how = HR2D_TARGET_INIT;
    hr2d_solution *solution;
    hr2d_account a;
    how.error = k ? 1e-7 : 1e-4;
    ck_assert_int_eq(hr2d_solve_to(scene, &how, &solution, &a), HR2D_OK);
    for (size_t p = 0; p < patches; p++) average[k][p] = hr2d_solution_average(solution, p, 0);
    bound[k] = a.average.bound;
    hr2d_solution_destroy(solution);
  }
  for (size_t p = 0; p < patches; p++)
    ck_assert_double_le(fabs(average[0][p] / average[1][p] - 1), bound[0] + bound[1]);
  hr2d_scene_destroy(scene);
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
  ADD_TESTS("plates", plates_face_to_face, plates_that_meet_at_one_end,
            light_changes_within_gaps, elements_end_beside_feet, a_wide_gap_is_told);
}
