/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gradients of functionals of B and H against central differences of solves. */
#include <math.h>

#include "support/support.h"

/* A room with a screen: ax ay bx by.  Patch 0 has a temperature, patch 1 a flux where there is
   one band. */
static const double wall[][4] = {{0, 0, 2, 0}, {2, 0, 2, 1},    {2, 1, .3, 1},
                                 {0, 1, 0, 0}, {.7, .1, 1, .6}, {1, .6, .7, .1}};
enum { WALLS = sizeof wall / sizeof *wall, VALUES = 2 * WALLS };

typedef enum surroundings { ROOM, MIRRORED, PERIODIC, SPECTRAL, KINDS } surroundings;

typedef struct stage {
  surroundings kind;
  size_t bands;
  hr2d_scene *scene;
  hr2d_operator *op;
  double emission[VALUES], reflectance[VALUES],
      temperature[WALLS]; /* NaN where there is none */
  double v[VALUES], w[VALUES];
} stage;

static void add(stage *s, int k) {
  static const double ones[] = {1, 1}, half[] = {.5, .5};
  hr2d_patch patch = test_patch(wall[k][0], wall[k][1], wall[k][2], wall[k][3]);
  hr2d_thermal t = HR2D_THERMAL_INIT;
  t.given = k == 0 ? HR2D_HEAT_TEMPERATURE : HR2D_HEAT_FLUX;
  t.value = k == 0 ? 300 : 40;
  t.emissivity = half;
  t.emissivity_bands = s->bands;
  if (k == 0 || (k == 1 && s->bands == 1)) {
    ck_assert_int_eq(hr2d_scene_add_thermal(s->scene, &patch, &t, NULL), HR2D_OK);
    return;
  }
  patch.emission = ones;
  patch.reflectance = half;
  patch.emission_bands = patch.reflectance_bands = s->bands;
  ck_assert_int_eq(hr2d_scene_add(s->scene, &patch, NULL), HR2D_OK);
}

static void begin(stage *s, surroundings kind, randoms *r) {
  const double wavelength = 10;
  const hr2d_segment mirror = {{0, 0}, {0, 1}};
  hr2d_target target = HR2D_TARGET_INIT;
  *s = (stage){.kind = kind, .bands = kind == SPECTRAL ? 2 : 1, .scene = test_new_scene(NULL)};
  if (s->bands > 1)
    ck_assert_int_eq(hr2d_scene_set_wavelengths(s->scene, &wavelength, 1), HR2D_OK);
  for (int k = 0; k < WALLS; k++) add(s, k);
  if (kind == MIRRORED) ck_assert_int_eq(hr2d_scene_add_mirror(s->scene, mirror), HR2D_OK);
  if (kind == PERIODIC)
    ck_assert_int_eq(hr2d_scene_set_period(s->scene, (hr2d_point){2, 0}), HR2D_OK);
  test_commit(s->scene);
  target.error = 1e-9; /* so that differences have digits */
  target.threads = 2;
  hr2d_status status = hr2d_operator_create(s->scene, &target, &s->op, NULL);
  ck_assert(s->op && (status == HR2D_OK || status == HR2D_EACCURACY));
  for (size_t k = 0; k < WALLS; k++) {
    s->temperature[k] = k == 0 ? random_between(r, 300, 600) : NAN;
    for (size_t b = 0; b < s->bands; b++) {
      const size_t at = k * s->bands + b;
      s->emission[at] = k == 0 || (k == 1 && s->bands == 1) ? NAN : random_between(r, 50, 500);
      s->reflectance[at] = k == 1 && s->bands == 1 ? NAN : random_between(r, 0.1, 0.8);
      s->v[at] = random_between(r, -1, 1);
      s->w[at] = random_between(r, -1, 1);
    }
  }
}

static void end(stage *s) {
  hr2d_operator_destroy(s->op);
  hr2d_scene_destroy(s->scene);
}

static hr2d_solution *solve(stage *s) {
  hr2d_light light = HR2D_LIGHT_INIT;
  hr2d_solution *solution = NULL;
  light.emission.value = s->emission;
  light.reflectance.value = s->reflectance;
  light.temperature.value = s->temperature;
  light.no_error = 1;
  ck_assert_msg(!hr2d_operator_solve(s->op, &light, NULL, &solution, NULL), "%s",
                hr2d_operator_message(s->op));
  return solution;
}

static double functional(stage *s) {
  double sum = 0;
  hr2d_solution *solution = solve(s);
  for (size_t k = 0; k < WALLS * s->bands; k++)
    sum += s->v[k] * hr2d_solution_average(solution, k / s->bands, k % s->bands) +
           s->w[k] * hr2d_solution_irradiance(solution, k / s->bands, k % s->bands);
  hr2d_solution_destroy(solution);
  return sum;
}

/* By four values: the error falls like h⁴. */
static double difference(stage *s, double *x, double h) {
  const double is = *x, step[] = {-2, -1, 1, 2},
               weight[] = {1. / 12, -2. / 3, 2. / 3, -1. / 12};
  double sum = 0;
  for (int k = 0; k < 4; k++) {
    *x = is + step[k] * h;
    sum += weight[k] * functional(s);
  }
  *x = is;
  return sum / h;
}

static double largest(const double *of, size_t count) {
  double max = 0;
  for (size_t k = 0; k < count; k++)
    if (!isnan(of[k])) max = fmax(max, fabs(of[k]));
  return max;
}

static void compare(stage *s, double *x, const double *gradient, size_t count, double h) {
  const double max = largest(gradient, count);
  ck_assert_double_gt(max, 0);
  for (size_t k = 0; k < count; k++) {
    ck_assert_int_eq(isnan(gradient[k]), isnan(x[k]));
    if (!isnan(x[k])) ck_assert_double_eq_tol(difference(s, &x[k], h), gradient[k], 1e-8 * max);
  }
}

START_TEST(gradients_are_limits_of_differences) {
  const surroundings kind = (surroundings)_i;
  randoms r = randoms_stream(test_seed(), 1 + _i);
  stage s;
  double emission[VALUES], reflectance[VALUES], temperature[WALLS];
  begin(&s, kind, &r);
  hr2d_solution *solution = solve(&s);
  const hr2d_values v = {s.v, {0, 0, 0}}, w = {s.w, {0, 0, 0}};
  hr2d_gradient gradient = HR2D_GRADIENT_INIT;
  gradient.emission = emission;
  gradient.reflectance = reflectance;
  gradient.temperature = temperature;
  ck_assert_msg(!hr2d_operator_gradient(s.op, solution, &v, &w, &gradient), "%s",
                hr2d_operator_message(s.op));
  /* Of patches with heat E cannot be set, but its derivative is told. */
  for (size_t k = 0; k < WALLS * s.bands; k++) {
    ck_assert(isfinite(emission[k]));
    if (isnan(s.emission[k])) emission[k] = NAN;
  }
  compare(&s, s.emission, emission, WALLS * s.bands, 1);
  compare(&s, s.reflectance, reflectance, WALLS * s.bands, 1e-3);
  compare(&s, s.temperature, temperature, WALLS, 0.5);
  /* Without an array for it the others are the same. */
  double again[VALUES];
  gradient = (hr2d_gradient)HR2D_GRADIENT_INIT;
  gradient.reflectance = again;
  ck_assert_int_eq(hr2d_operator_gradient(s.op, solution, &v, &w, &gradient), HR2D_OK);
  for (size_t k = 0; k < WALLS * s.bands; k++)
    ck_assert(again[k] == reflectance[k] || (isnan(again[k]) && isnan(reflectance[k])));
  /* Of no functional it is 0. */
  gradient.emission = emission;
  ck_assert_int_eq(hr2d_operator_gradient(s.op, solution, NULL, NULL, &gradient), HR2D_OK);
  for (size_t k = 0; k < WALLS * s.bands; k++) ck_assert_double_eq(emission[k], 0);
  hr2d_solution_destroy(solution);
  end(&s);
}
END_TEST

TEST_SUITE("gradients") {
  REPEAT_TESTS(KINDS, "operator", gradients_are_limits_of_differences);
}
