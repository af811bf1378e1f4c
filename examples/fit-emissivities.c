/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Emissivities from measured temperatures, by one of GSL's minimisers.  You learn to change the
   surfaces of a kept operator, and to take derivatives by their emissivities.

   A channel of 3 m by 1 m has a heater of 1500 K at its left end, a cooled wall of 400 K at its
   right end, and a cover of 900 K and emissivity 0.9.  Its floor is of six insulated plates,
   whose temperatures are measured.  The emissivities of heater and cooled wall are wanted.  The
   measurements are those of 0.85 and 0.6, rounded to 1 K: so what is found is off by what 1 K
   does.

   Insulated plates have B = σT⁴: J = Σ (B_k/σT_k⁴ − 1)².  The unknowns are x with
   ε = 1/(1 + exp(−x)), which are free.  Of a patch of given temperature ρ = 1 − ε. */
#include <gsl/gsl_multimin.h>
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

enum { PLATES = 6, HEATER = PLATES, COOLED, COVER, PATCHES };

static const double measured[PLATES] = {1219, 1111, 1037, 991, 960, 936};

typedef struct channel {
  hr2d_operator *op;
  hr2d_status status;
  double found[PLATES]; /* temperatures by the last solve */
} channel;

static hr2d_status make_scene(hr2d_scene **scene) {
  const hr2d_point end[PATCHES - PLATES][2] = {
      {{0, 1}, {0, 0}}, {{3, 0}, {3, 1}}, {{3, 1}, {0, 1}}};
  const double kelvin[] = {1500, 400, 900}, emissivity[] = {.5, .5, .9}, white = .5;
  hr2d_status status = hr2d_scene_create(NULL, scene);
  for (size_t k = 0; k < PATCHES && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    hr2d_thermal thermal = HR2D_THERMAL_INIT;
    const size_t wall = k - PLATES; /* unless it is a plate */
    patch.a = k < PLATES ? (hr2d_point){.5 * (double)k, 0} : end[wall][0];
    patch.b = k < PLATES ? (hr2d_point){.5 * (double)k + .5, 0} : end[wall][1];
    thermal.given = k < PLATES ? HR2D_HEAT_FLUX : HR2D_HEAT_TEMPERATURE;
    thermal.value = k < PLATES ? 0 : kelvin[wall];
    thermal.emissivity = k < PLATES ? &white : &emissivity[wall];
    thermal.emissivity_bands = 1;
    status = hr2d_scene_add_thermal(*scene, &patch, &thermal, NULL);
  }
  return status ? status : hr2d_scene_commit(*scene);
}

static double emissivity_of(const gsl_vector *x, size_t k) {
  return 1 / (1 + exp(-gsl_vector_get(x, k)));
}

/* J, and its derivatives unless `slope` is NULL. */
static void evaluate(const gsl_vector *x, void *ctx, double *j, gsl_vector *slope) {
  channel *c = ctx;
  double reflectance[PATCHES], weight[PATCHES] = {0}, by_reflectance[PATCHES];
  hr2d_light light = HR2D_LIGHT_INIT;
  hr2d_gradient gradient = HR2D_GRADIENT_INIT;
  const hr2d_values none = {NULL, {0, 0, 0}}, of_b = {weight, {0, 0, 0}};
  hr2d_solution *solution = NULL;
  for (size_t k = 0; k < PLATES; k++) reflectance[k] = NAN; /* as in the scene */
  reflectance[HEATER] = 1 - emissivity_of(x, 0);
  reflectance[COOLED] = 1 - emissivity_of(x, 1);
  reflectance[COVER] = .1;
  light.reflectance.value = reflectance;
  light.no_error = 1;
  gradient.reflectance = by_reflectance;
  *j = 0;
  if (!c->status) c->status = hr2d_operator_solve(c->op, &light, NULL, &solution, NULL);
  for (size_t k = 0; k < PLATES && !c->status; k++) {
    const double black = hr2d_black_body(measured[k]);
    const double off = hr2d_solution_average(solution, k, 0) / black - 1;
    c->found[k] = measured[k] * pow(1 + off, .25);
    *j += off * off;
    weight[k] = 2 * off / black;
  }
  if (!c->status && slope)
    c->status = hr2d_operator_gradient(c->op, solution, &of_b, &none, &gradient);
  for (size_t k = 0; k < 2 && slope; k++) {
    const double e = emissivity_of(x, k);
    gsl_vector_set(slope, k, c->status ? 0 : -e * (1 - e) * by_reflectance[HEATER + k]);
  }
  hr2d_solution_destroy(solution);
}

static double value(const gsl_vector *x, void *ctx) {
  double j;
  evaluate(x, ctx, &j, NULL);
  return j;
}

static void derive(const gsl_vector *x, void *ctx, gsl_vector *slope) {
  double j;
  evaluate(x, ctx, &j, slope);
}

static void report(const channel *c, const gsl_vector *x) {
  printf("heater %.3f, cooled wall %.3f\n", emissivity_of(x, 0), emissivity_of(x, 1));
  for (size_t k = 0; k < PLATES; k++)
    printf("plate %zu: measured %.0f K, found %.0f K\n", k + 1, measured[k], c->found[k]);
}

static void fit(channel *c) {
  gsl_multimin_function_fdf f = {value, derive, evaluate, 2, c};
  gsl_vector *x = gsl_vector_calloc(2);
  gsl_multimin_fdfminimizer *m =
      gsl_multimin_fdfminimizer_alloc(gsl_multimin_fdfminimizer_vector_bfgs2, 2);
  int stuck = gsl_multimin_fdfminimizer_set(m, &f, x, .5, .1);
  for (int k = 0; k < 100 && !stuck && !c->status; k++) {
    stuck = gsl_multimin_fdfminimizer_iterate(m);
    if (gsl_multimin_test_gradient(m->gradient, 1e-9) == GSL_SUCCESS) break;
  }
  if (!c->status) value(m->x, c);
  if (!c->status) report(c, m->x);
  gsl_multimin_fdfminimizer_free(m);
  gsl_vector_free(x);
}

int main(void) {
  hr2d_scene *scene = NULL;
  channel c = {0};
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-8;
  c.status = make_scene(&scene);
  if (!c.status) c.status = hr2d_operator_create(scene, &target, &c.op, NULL);
  if (!c.status) fit(&c);
  if (c.status) fprintf(stderr, "%s\n", hr2d_strerror(c.status));
  hr2d_operator_destroy(c.op);
  hr2d_scene_destroy(scene);
  return c.status;
}
