/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mirrors and periods at scales by powers of two, up to the ends of a double: no bit changes.
 */
#include <hr2d/symmetry.h>
#include <math.h>
#include <string.h>

#include "support/support.h"

enum { KINDS = 3, POINTS = 5 };

static hr2d_point at_scale(double x, double y, int e) {
  return (hr2d_point){ldexp(x, e), ldexp(y, e)};
}

static void add(hr2d_scene *scene, const double p[4], hr2d_sides sides, int e) {
  const hr2d_segment s = {at_scale(p[0], p[1], e), at_scale(p[2], p[3], e)};
  ck_assert_int_eq(test_add_patch(scene, s, .25, .5, sides), HR2D_OK);
}

/* Raised panels along an oblique period, under a sky with a piece; a shelf between two mirrors;
   a quarter of a room at oblique ones. */
static hr2d_scene *make(int kind, int e) {
  static const double ground[] = {0, 0, 2, .5}, panel[] = {.4, .9, 1.4, 1.5},
                      shelf[] = {.5, .5, 1, 1.25}, wall[] = {2, -2, 3, -1};
  const hr2d_sky_piece piece = {-30, 20};
  const double light = 3, grey = 1;
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &grey, 1), HR2D_OK);
  add(scene, ground, HR2D_SIDES_FRONT, e);
  if (kind == 0) {
    add(scene, panel, HR2D_SIDES_BOTH, e);
    hr2d_scene_set_sky(scene, &piece, 1, &light, 1);
    hr2d_scene_set_period(scene, at_scale(2, .5, e));
  } else if (kind == 1) {
    add(scene, shelf, HR2D_SIDES_BOTH, e);
    for (int k = 0; k < 2; k++)
      hr2d_scene_add_mirror(scene,
                            (hr2d_segment){at_scale(2 * k, 0, e), at_scale(2 * k, 1, e)});
  } else {
    add(scene, wall, HR2D_SIDES_FRONT, e);
    hr2d_scene_add_mirror(scene, (hr2d_segment){at_scale(0, 1, e), at_scale(-1, 0, e)});
    hr2d_scene_add_mirror(scene, (hr2d_segment){at_scale(3, 0, e), at_scale(4, -1, e)});
  }
  test_commit(scene);
  return scene;
}

typedef struct seen {
  size_t images;
  double cut_off, average[3], gather[3], mean[POINTS], past[POINTS];
  double estimate, bound;
} seen;

static seen look(int kind, int e) {
  hr2d_scene *scene = make(kind, e);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  hr2d_account account;
  seen s;
  memset(&s, 0, sizeof s);
  target.error = 1e-4;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &account), HR2D_OK);
  s.images = hr2d_scene_images(scene);
  s.cut_off = hr2d_scene_cut_off(scene);
  s.estimate = account.average.estimate;
  s.bound = account.average.bound;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const double middle = .5;
    s.average[k] = hr2d_solution_average(solution, k, 0);
    ck_assert_int_eq(hr2d_solution_gather(solution, k, &middle, 1, &s.gather[k]), HR2D_OK);
  }
  hr2d_point at[POINTS];
  for (int k = 0; k < POINTS; k++) at[k] = at_scale(.25 + .375 * k, .75 + .25 * k, e);
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  values.mean = s.mean;
  values.cut_off = s.past;
  ck_assert_int_eq(hr2d_field_at(solution, at, POINTS, NULL, &values), HR2D_OK);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return s;
}

START_TEST(a_power_of_two_changes_no_bit) {
  static const int exponents[] = {1, -40, 300, 500, 700, 1000, -500, -700, -980};
  const seen first = look(_i, 0);
  ck_assert(_i > 0 || first.cut_off > 0);
  for (size_t k = 0; k < sizeof exponents / sizeof *exponents; k++) {
    const seen s = look(_i, exponents[k]);
    ck_assert_msg(memcmp(&s, &first, sizeof s) == 0,
                  "2^%d: %zu and %zu images, B %.17g and %.17g, M %.17g and %.17g",
                  exponents[k], s.images, first.images, s.average[0], first.average[0],
                  s.mean[1], first.mean[1]);
  }
}
END_TEST

TEST_SUITE("image-scales") {
  REPEAT_TESTS(KINDS, "all", a_power_of_two_changes_no_bit);
}
