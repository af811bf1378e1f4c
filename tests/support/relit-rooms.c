/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/relit-rooms.h"

#include <math.h>

#include "support/support.h"

const double relit_wall[RELIT_WALLS][4] = {{0, 0, 2, 0}, {2, 0, 2, 1},    {2, 1, 0, 1},
                                           {0, 1, 0, 0}, {.7, .1, 1, .6}, {1, .6, .7, .1}};

void relit_draw(relit_paint *p, randoms *r) {
  for (int k = 0; k < RELIT_WALLS * 2; k++) {
    p->emission[k] = random_below(r, 2) ? random_unit(r) : 0;
    p->reflectance[k] = random_between(r, 0, 0.9);
  }
  p->emission[0] = 1;
  p->background[0] = random_between(r, 0.1, 1);
  p->background[1] = random_between(r, 0.1, 1);
}

/* Open, periodic and sunny scenes lack the ceiling, and mirrored ones the left wall. */
static int is_there(relit_kind kind, int k) {
  if (kind == RELIT_MIRRORED) return k != 3;
  return kind == RELIT_CLOSED || (k != 2 && (kind != RELIT_PERIODIC || (k != 1 && k != 3)));
}

int relit_has_sky(relit_kind kind) {
  return kind == RELIT_OPEN || kind == RELIT_PERIODIC || kind == RELIT_SUNNY;
}

int relit_walls(relit_kind kind) {
  int count = 0;
  for (int k = 0; k < RELIT_WALLS; k++) count += is_there(kind, k);
  return count;
}

hr2d_scene *relit_scene(relit_kind kind, const relit_paint *p, size_t bands) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0, at = 0; k < RELIT_WALLS; k++) {
    if (!is_there(kind, k)) continue;
    hr2d_patch patch =
        test_patch(relit_wall[k][0], relit_wall[k][1], relit_wall[k][2], relit_wall[k][3]);
    patch.emission = p->emission + (size_t)at * bands;
    patch.reflectance = p->reflectance + (size_t)at++ * bands;
    patch.emission_bands = patch.reflectance_bands = bands;
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  const hr2d_segment mirror = {{0, 0}, {0, 1}};
  const hr2d_sun sun = {{-1, -2}, 0.5};
  if (relit_has_sky(kind))
    ck_assert_int_eq(hr2d_scene_set_background(scene, p->background, bands), HR2D_OK);
  if (kind == RELIT_MIRRORED) ck_assert_int_eq(hr2d_scene_add_mirror(scene, mirror), HR2D_OK);
  if (kind == RELIT_PERIODIC)
    ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){2, 0}), HR2D_OK);
  if (kind == RELIT_SUNNY) ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  test_commit(scene);
  return scene;
}

hr2d_operator *relit_operator(const hr2d_scene *scene, double error) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_operator *op = NULL;
  target.error = error;
  const hr2d_status status = hr2d_operator_create(scene, &target, &op, NULL);
  ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
  ck_assert_ptr_nonnull(op);
  return op;
}

hr2d_light relit_light(relit_kind kind, const relit_paint *p) {
  hr2d_light light = HR2D_LIGHT_INIT;
  light.emission.value = p->emission;
  light.reflectance.value = p->reflectance;
  if (relit_has_sky(kind)) light.background.value = p->background;
  return light;
}

hr2d_solution *relit_solve(hr2d_operator *op, const hr2d_light *light, hr2d_account *account) {
  hr2d_solution *solution = NULL;
  const hr2d_status status = hr2d_operator_solve(op, light, NULL, &solution, account);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s", hr2d_operator_message(op));
  ck_assert_ptr_nonnull(solution);
  return solution;
}

/* The largest differences of averages of B and H, as parts of averages that are no less than
   the floor. */
double relit_distance(const hr2d_solution *s, const hr2d_solution *is, int walls,
                      size_t bands) {
  double worst = 0;
  for (size_t b = 0; b < bands; b++)
    for (int h = 0; h < 2; h++) {
      double (*const value)(const hr2d_solution *, size_t, size_t) =
          h ? hr2d_solution_irradiance : hr2d_solution_average;
      double max = 0;
      for (int k = 0; k < walls; k++) max = fmax(max, value(is, (size_t)k, b));
      for (int k = 0; k < walls; k++) {
        const double v = value(is, (size_t)k, b);
        worst = fmax(worst, fabs(value(s, (size_t)k, b) - v) / fmax(v, HR2D_FLOOR * max));
      }
    }
  return worst;
}
