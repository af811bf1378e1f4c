/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lamp powers for a wanted illumination, by one of GSL's minimisers.  You learn to take the
   gradient of a function of averages from an operator, at the price of one solve for any number
   of unknowns.

   A hall of 10 m by 3 m has lamps in every other metre of its ceiling.  Its floor is to have
   100 W/m², and 200 on the three metres at the left.  Powers are at least 0, so the unknowns
   are their square roots x.  J = Σ (H_k − wanted_k)² has weights ∂J/∂H_k = 2(H_k − wanted_k),
   and ∂J/∂x_j = 2x_j ∂J/∂E_j. */
#include <gsl/gsl_multimin.h>
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

enum { METRES = 10, LAMPS = METRES / 2, PATCHES = 2 * METRES + 2 };

typedef struct hall {
  hr2d_operator *op;
  hr2d_status status;
  double irradiance[METRES]; /* of the floor, by the last solve */
  int solves;
} hall;

static size_t lamp(size_t k) {
  return 2 * k;
}
static size_t floor_patch(size_t k) {
  return METRES + k;
}
static double wanted(size_t k) {
  return k < 3 ? 200 : 100;
}

/* The ceiling from the right, the floor from the left, and the walls at both ends. */
static hr2d_status make_scene(hr2d_scene **scene) {
  hr2d_status status = hr2d_scene_create(NULL, scene);
  for (size_t k = 0; k < PATCHES && !status; k++) {
    const double at = k < METRES ? METRES - (double)k : (double)k - METRES;
    const double emission = k < METRES && k % 2 == 0 ? 100 : 0,
                 reflectance = k < METRES ? .7 : .4;
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = k < METRES ? (hr2d_point){at, 3} : (hr2d_point){at, 0};
    patch.b = k < METRES ? (hr2d_point){at - 1, 3} : (hr2d_point){at + 1, 0};
    if (k == PATCHES - 2) patch.a = (hr2d_point){METRES, 0}, patch.b = (hr2d_point){METRES, 3};
    if (k == PATCHES - 1) patch.a = (hr2d_point){0, 3}, patch.b = (hr2d_point){0, 0};
    patch.emission = &emission;
    patch.reflectance = &reflectance;
    patch.emission_bands = patch.reflectance_bands = 1;
    status = hr2d_scene_add(*scene, &patch, NULL);
  }
  return status ? status : hr2d_scene_commit(*scene);
}

/* J, and its derivatives unless `slope` is NULL. */
static void evaluate(const gsl_vector *x, void *ctx, double *j, gsl_vector *slope) {
  hall *h = ctx;
  double emission[PATCHES] = {0}, weight[PATCHES] = {0}, by_emission[PATCHES];
  hr2d_light light = HR2D_LIGHT_INIT;
  hr2d_gradient gradient = HR2D_GRADIENT_INIT;
  const hr2d_values none = {NULL, {0, 0, 0}}, of_h = {weight, {0, 0, 0}};
  hr2d_solution *solution = NULL;
  for (size_t k = 0; k < LAMPS; k++) emission[lamp(k)] = pow(gsl_vector_get(x, k), 2);
  light.emission.value = emission;
  light.no_error = 1;
  gradient.emission = by_emission;
  *j = 0;
  if (!h->status) h->status = hr2d_operator_solve(h->op, &light, NULL, &solution, NULL);
  for (size_t k = 0; k < METRES && !h->status; k++) {
    h->irradiance[k] = hr2d_solution_irradiance(solution, floor_patch(k), 0);
    *j += pow(h->irradiance[k] - wanted(k), 2);
    weight[floor_patch(k)] = 2 * (h->irradiance[k] - wanted(k));
  }
  if (!h->status && slope)
    h->status = hr2d_operator_gradient(h->op, solution, &none, &of_h, &gradient);
  for (size_t k = 0; k < LAMPS && slope; k++)
    gsl_vector_set(slope, k, h->status ? 0 : 2 * gsl_vector_get(x, k) * by_emission[lamp(k)]);
  h->solves++;
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

static void report(const hall *h, const gsl_vector *x) {
  printf("lamps from the left, W/m²:");
  for (size_t k = LAMPS; k-- > 0;) printf(" %.0f", pow(gsl_vector_get(x, k), 2));
  printf("\nfloor from the left, W/m²:");
  for (size_t k = 0; k < METRES; k++) printf(" %.0f", h->irradiance[k]);
  printf("\n%s\n", h->solves < 300 ? "fewer than 300 solves" : "more solves than expected");
}

static int minimise(hall *h) {
  gsl_multimin_function_fdf f = {value, derive, evaluate, LAMPS, h};
  gsl_vector *x = gsl_vector_alloc(LAMPS);
  gsl_multimin_fdfminimizer *m =
      gsl_multimin_fdfminimizer_alloc(gsl_multimin_fdfminimizer_vector_bfgs2, LAMPS);
  gsl_vector_set_all(x, 20);
  int stuck = gsl_multimin_fdfminimizer_set(m, &f, x, 1, .1);
  for (int k = 0; k < 100 && !stuck && !h->status; k++) {
    stuck = gsl_multimin_fdfminimizer_iterate(m);
    if (gsl_multimin_test_gradient(m->gradient, 1e-3) == GSL_SUCCESS) break;
  }
  if (!h->status) {
    value(m->x, h);
    report(h, m->x);
  }
  gsl_multimin_fdfminimizer_free(m);
  gsl_vector_free(x);
  return h->status;
}

int main(void) {
  hr2d_scene *scene = NULL;
  hall h = {0};
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-8;
  h.status = make_scene(&scene);
  if (!h.status) h.status = hr2d_operator_create(scene, &target, &h.op, NULL);
  if (!h.status) minimise(&h);
  if (h.status) fprintf(stderr, "%s\n", hr2d_strerror(h.status));
  hr2d_operator_destroy(h.op);
  hr2d_scene_destroy(scene);
  return h.status;
}
