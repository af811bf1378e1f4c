/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the edge of a shadow sweeps over an element, B after a gather is off to and fro,
   perhaps on a small part of the receiving element.  The bound of the sup norm holds there,
   too, against an independent method. */
#include <math.h>

#include "independent/sweep-nystrom.h"
#include "support/support.h"

/* Screens under a sky.  At 1e-6 B is off by 1.6e-9 on a part of patch 8 from which the edge of
   a screen sweeps over another one; twice what the bound said without shadow-residuals.c. */
enum { PATCHES = 10, RECEIVER = 8 };
static const double at[PATCHES][4] = {
    {3.111968994140625, 1.3493194580078125, 0.9472503662109375, 1.3896484375},
    {0.9472503662109375, 1.3896484375, 3.111968994140625, 1.3493194580078125},
    {2.9117889404296875, 1.6941986083984375, 3.3916473388671875, 1.58648681640625},
    {3.3916473388671875, 1.58648681640625, 2.9117889404296875, 1.6941986083984375},
    {1.0869903564453125, 2.5702056884765625, 0.506988525390625, 3.4256744384765625},
    {0.506988525390625, 3.4256744384765625, 1.0869903564453125, 2.5702056884765625},
    {3.4516448974609375, 2.9559783935546875, 3.8746490478515625, 2.5650634765625},
    {3.8746490478515625, 2.5650634765625, 3.4516448974609375, 2.9559783935546875},
    {0.3286285400390625, 1.7078704833984375, 1.1951446533203125, 0.8360595703125},
    {0.118743896484375, 3.550811767578125, 0.26531982421875, 3.091522216796875}};
static const double sky = 0.390625, grey = 0.5;

/* The other method knows H to that part of the largest value. */
#define KNOWN 1e-11

static hr2d_scene *make_scene(void) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t p = 0; p < PATCHES; p++)
    ck_assert_int_eq(test_add_patch(scene,
                                    (hr2d_segment){{at[p][0], at[p][1]}, {at[p][2], at[p][3]}},
                                    0, p + 1 < PATCHES ? grey : 0, HR2D_SIDES_FRONT),
                     HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
  test_commit(scene);
  return scene;
}

static swept_solution *solve_otherwise(const swept_light *light, swept_scene *scene) {
  *scene = (swept_scene){{PATCHES, at}, light, 1, {sky}};
  return swept_solve(scene, (swept_mesh){14, 1e-12});
}

typedef struct found {
  hr2d_account account;
  double error; /* of B at points of the receiver, relative to the largest B */
} found;

static found measure(const hr2d_scene *scene, const swept_solution *truth, double target) {
  enum { POINTS = 300 };
  hr2d_target wanted = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  found f = {.error = 0};
  double max = 0;
  wanted.error = target;
  wanted.norm = HR2D_NORM_SUP;
  wanted.floor = 1e-3;
  ck_assert_int_eq(hr2d_solve_to(scene, &wanted, &solution, &f.account), HR2D_OK);
  for (int k = 0; k < POINTS; k++) {
    const double t = (k + 0.5) / POINTS;
    double b, h;
    ck_assert_int_eq(hr2d_solution_gather(solution, RECEIVER, &t, 1, &b), HR2D_OK);
    swept_at(truth, RECEIVER, (real)t, &h);
    f.error = fmax(f.error, fabs(b - grey * h));
    max = fmax(max, grey * h);
  }
  f.error /= max;
  hr2d_solution_destroy(solution);
  return f;
}

START_TEST(bounds_hold_behind_edges) {
  swept_light light[PATCHES];
  swept_scene twin;
  for (size_t p = 0; p < PATCHES; p++)
    light[p] = (swept_light){{0}, {p + 1 < PATCHES ? grey : 0}};
  hr2d_scene *scene = make_scene();
  swept_solution *truth = solve_otherwise(light, &twin);
  for (double target = 1e-4; target > 1e-9; target *= 0.1) {
    const found f = measure(scene, truth, target);
    printf("  %.0e: off by %.2g, estimate %.2g, bound %.2g\n", target, f.error,
           f.account.sup.estimate, f.account.sup.bound);
    ck_assert_double_le(f.error, f.account.sup.bound + KNOWN);
    ck_assert_double_le(f.error, target + KNOWN);
  }
  swept_destroy(truth);
  /* Negative control: beside a wall of another reflectance no bound stands. */
  light[0].reflectance[0] += 1e-5;
  truth = solve_otherwise(light, &twin);
  const found wrong = measure(scene, truth, 1e-8);
  ck_assert_double_gt(wrong.error, wrong.account.sup.bound + KNOWN);
  swept_destroy(truth);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("edges of shadows") {
  ADD_TESTS("edges", bounds_hold_behind_edges);
}
