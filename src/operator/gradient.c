/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Derivatives by the adjoint equation.

   J = Σ vB̄ + wH̄ = ⟨v/A, B⟩ + ⟨w/A, KB + S⟩ with ⟨f, g⟩ = ∫fg, and B = Q + ρ(KB + S) is changed
   by δB = (I − ρK)⁻¹(δQ + Hδρ).  K is self-adjoint, so that (I − ρK)⁻ᵀ = I + K(I − ρK)⁻¹ρ and

     δJ = ⟨u, δQ + Hδρ⟩,   u = v/A + KX,   X = (ρv + w)/A + ρKX.
   On panes ρ is S, which is symmetric as well. */
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sized-struct.h"
#include "operator/operator-impl.h"
#include "scene/panes.h"
#include "solution/solution-impl.h"
#include "solve/existence.h"

/* The primal H and the adjoint u on leaves, both as coefficients. */
typedef struct adjoint {
  hr2d_operator *op;
  const hr2d_values *v, *w;
  double *irradiance; /* of B, as the equation has it */
  int *exponent;      /* per band: X and u are 2^exponent times what the equation holds */
} adjoint;

static double weight_at(const adjoint *a, const hr2d_values *from, size_t patch, size_t band) {
  const size_t cell = hr2di_scene_cell(a->op->scene);
  if (!from || !from->value) return 0;
  return hr2di_values_at(from, cell, a->op->scene->bands, 0,
                         hr2di_scene_original(a->op->scene, patch), band);
}

/* (ρv + w)/A on a patch. */
static double source_at(const adjoint *a, size_t patch, size_t band) {
  const hr2d_scene *relit = a->op->kept->relit;
  const size_t other = hr2di_scene_other_side(relit, patch);
  return (hr2di_pane_sum(relit, patch, band, weight_at(a, a->v, patch, band),
                         weight_at(a, a->v, other, band)) +
          weight_at(a, a->w, patch, band)) /
         relit->patch[patch].length;
}

static hr2d_status check_weights(adjoint *a) {
  hr2d_operator *op = a->op;
  for (size_t b = 0; b < op->scene->bands; b++)
    for (size_t k = 0; k < hr2di_scene_cell(op->scene); k++)
      if (!isfinite(weight_at(a, a->v, k, b)) || !isfinite(weight_at(a, a->w, k, b)))
        return hr2di_message_fail(&op->message, HR2D_EINVAL, "a weight of %s is not finite",
                                  hr2di_patch_label(op->scene, k).text);
  return HR2D_OK;
}

/* H = KB + S of the solution: what B = Q + ρH reflects, without the mean that closure has
 * moved. */
static hr2d_status gather_primal(adjoint *a, const hr2d_solution *solution) {
  hr2di_equation *eq = &a->op->eq;
  const hr2di_transport *t = &eq->transport;
  hr2d_status status = hr2di_solution_restrict(solution, t->hierarchy, t->leaf, t->leaves,
                                               t->order, eq->radiosity, t->watch);
  if (status) return status;
  for (size_t k = 0; k < eq->field; k++)
    eq->radiosity[k] = ldexp(eq->radiosity[k], -eq->exponent[k % t->bands]);
  hr2di_equation_gather(eq, eq->radiosity);
  for (size_t k = 0; k < eq->field; k++)
    a->irradiance[k] = ldexp(eq->irradiance[k], eq->exponent[k % t->bands]);
  return t->failed;
}

/* Solves for X; eq->irradiance is KX then. */
static hr2d_status solve_adjoint(adjoint *a) {
  hr2di_equation *eq = &a->op->eq;
  const hr2di_transport *t = &eq->transport;
  for (size_t b = 0; b < t->bands; b++) {
    double max = 0;
    for (size_t k = 0; k < a->op->scene->patches; k++)
      max = fmax(max, fabs(source_at(a, k, b)));
    a->exponent[b] = max > 0 ? ilogb(max) : 0;
  }
  for (size_t k = 0; k < eq->field; k++) eq->source[k] = eq->y[k] = 0;
  for (size_t leaf = 0; leaf < t->leaves; leaf++)
    for (size_t b = 0; b < t->bands; b++)
      eq->source[leaf * t->width + b] =
          ldexp(source_at(a, t->hierarchy->element[t->leaf[leaf]].patch, b), -a->exponent[b]);
  eq->background = 0;
  eq->enough = (hr2di_stopping_test){0};
  eq->residuals = 0;
  return hr2di_equation_solve(eq);
}

static void add_to(double *array, size_t k, double value) {
  if (array) array[k] += value;
}

/* Adds ∫u and ∫uH of a leaf. */
static void add_leaf(const adjoint *a, size_t leaf, hr2d_gradient *to) {
  const hr2di_equation *eq = &a->op->eq;
  const hr2di_transport *t = &eq->transport;
  const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
  const double length = t->hierarchy->element[t->leaf[leaf]].length;
  for (size_t b = 0; b < t->bands; b++) {
    const double *h = a->irradiance + leaf * t->width + b,
                 *kx = eq->irradiance + leaf * t->width + b;
    double sum = 0;
    for (size_t l = 0; l < t->order; l++)
      sum += ldexp(kx[l * t->bands], a->exponent[b]) * h[l * t->bands];
    const double v = weight_at(a, a->v, patch, b) / a->op->scene->patch[patch].length;
    add_to(to->emission, patch * t->bands + b, length * (v + ldexp(kx[0], a->exponent[b])));
    add_to(to->reflectance, patch * t->bands + b, length * (sum + v * h[0]));
  }
}

/* By T of a patch, and by ρ where E = (1 − ρ − τ)σT⁴ follows it. */
static void add_heat(const hr2d_operator *op, size_t patch, const double *by_emission,
                     hr2d_gradient *to) {
  const hr2d_scene *relit = op->kept->relit;
  const size_t bands = op->scene->bands;
  const hr2d_heat heat = hr2d_scene_heat(op->scene, patch, NULL);
  const double kelvin = relit->patch[patch].light->given, black = hr2d_black_body(kelvin);
  if (to->temperature) to->temperature[patch] = heat == HR2D_HEAT_TEMPERATURE ? 0 : NAN;
  for (size_t b = 0; b < bands && heat != HR2D_HEAT_NONE; b++) {
    const double rest = hr2di_scene_absorptance(relit, patch, b);
    const double rise = by_emission[patch * bands + b];
    if (heat != HR2D_HEAT_TEMPERATURE && to->reflectance)
      to->reflectance[patch * bands + b] = NAN;
    if (heat != HR2D_HEAT_TEMPERATURE) continue;
    add_to(to->reflectance, patch * bands + b,
           -rise * hr2di_scene_band_part(op->scene, kelvin, b) * black);
    if (kelvin > 0)
      add_to(to->temperature, patch,
             rise * rest * hr2di_scene_band_rise(op->scene, kelvin, b) * 4 * black / kelvin);
  }
}

static hr2d_status differentiate(adjoint *a, const hr2d_solution *solution, hr2d_gradient *to) {
  hr2d_operator *op = a->op;
  const hr2di_transport *t = &op->eq.transport;
  const size_t cell = hr2di_scene_cell(op->scene), count = cell * op->scene->bands;
  hr2d_status status = gather_primal(a, solution);
  if (!status) status = solve_adjoint(a);
  if (status) return status;
  for (size_t k = 0; k < count; k++) {
    if (to->emission) to->emission[k] = 0;
    if (to->reflectance) to->reflectance[k] = 0;
  }
  for (size_t leaf = 0; leaf < t->leaves; leaf++)
    if (t->hierarchy->element[t->leaf[leaf]].patch < cell) add_leaf(a, leaf, to);
  for (size_t k = 0; k < cell; k++) add_heat(op, k, to->emission, to);
  return HR2D_OK;
}

/* X exists if B does wherever light is sent. */
static hr2d_status check_existence(hr2d_operator *op, hr2di_watch *watch) {
  hr2d_scene *relit = op->kept->relit;
  for (size_t k = 0; k < hr2di_scene_cell(relit); k++)
    for (size_t b = 0; b < relit->bands; b++) hr2di_relit_emission(relit, k)[b] = 1;
  return hr2di_existence_check(op->kept->links, relit, watch);
}

/* The relit scene gets the light of the solution. */
static hr2d_status return_to(hr2d_operator *op, const hr2d_solution *solution) {
  hr2d_scene *relit = op->kept->relit;
  hr2di_watch watch;
  hr2d_status status = hr2di_operator_resize(op, 1);
  hr2di_scene_watch(op->scene, &watch, op->target.progress, op->target.progress_ctx, "solve");
  if (!status) status = hr2di_relit_renew(relit, solution->own_scene, &watch);
  if (!status) status = check_existence(op, &watch);
  if (!status) status = hr2di_relit_renew(relit, solution->own_scene, &watch);
  return status ? status : hr2di_operator_begin(op);
}

static hr2d_status check(hr2d_operator *op, const hr2d_solution *solution,
                         const hr2d_gradient *gradient, hr2d_gradient *to) {
  if (hr2di_sized_copy(to, sizeof *to, gradient))
    return hr2di_message_fail(&op->message, HR2D_EINVAL, "struct_size is not set");
  if (solution->kept != op->kept)
    return hr2di_message_fail(&op->message, HR2D_EINVAL,
                              "the solution is none of this operator");
  if (solution->bands != op->scene->bands)
    return hr2di_message_fail(&op->message, HR2D_EINVAL, "the solution has several lights");
  return HR2D_OK;
}

hr2d_status hr2d_operator_gradient(hr2d_operator *op, const hr2d_solution *solution,
                                   const hr2d_values *v, const hr2d_values *w,
                                   hr2d_gradient *gradient) {
  if (!op || !solution || !gradient) return HR2D_EINVAL;
  hr2d_gradient to = HR2D_GRADIENT_INIT;
  hr2d_status status = hr2di_operator_enter(op);
  if (status) return status;
  status = check(op, solution, gradient, &to);
  if (status) return hr2di_operator_end(op, status);
  const size_t count = hr2di_scene_cell(op->scene) * op->scene->bands;
  adjoint a = {.op = op, .v = v, .w = w};
  status = check_weights(&a);
  if (!status) status = return_to(op, solution);
  if (status) return hr2di_operator_end(op, status);
  const hr2d_allocator *alloc = &op->scene->alloc;
  double *emission = to.emission ? NULL : hr2di_alloc(alloc, count, sizeof *emission);
  a.irradiance = hr2di_alloc(alloc, op->eq.field, sizeof *a.irradiance);
  a.exponent = hr2di_alloc(alloc, op->scene->bands, sizeof *a.exponent);
  if (!to.emission) to.emission = emission;
  if (!to.emission || !a.irradiance || !a.exponent) status = HR2D_ENOMEM;
  if (!status) status = differentiate(&a, solution, &to);
  hr2di_alloc_free(alloc, emission);
  hr2di_alloc_free(alloc, a.irradiance);
  hr2di_alloc_free(alloc, a.exponent);
  return hr2di_operator_end(op, status);
}
