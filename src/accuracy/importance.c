/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The adjoint equation (Smits, Arvo, Salesin 1992).  An error r in B = E + ρKB changes
   B̄ = (1/A)∫ B over a patch by ∫ ψ r, ψ = χ/A + Kφ, where χ is 1 on the patch and φ = ρψ is the
   radiosity of a source ρχ/A: light sent back from the patch that is asked for. */
#include "accuracy/importance.h"

#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/equation.h"

/* The least weight, so that no patch is entirely unimportant. */
#define LEAST 1e-12

/* Solves for φ; eq->irradiance becomes Kφ. */
static hr2d_status solve_adjoint(hr2di_equation *eq, size_t patch) {
  const hr2di_transport *t = &eq->transport;
  const double area = t->hierarchy->element[patch].length;
  for (size_t k = 0; k < eq->field; k++) {
    const size_t item = k / t->bands;
    const int on = t->hierarchy->element[t->leaf[item / t->order]].patch == patch;
    const int constant = item % t->order == 0;
    eq->source[k] = on && constant ? eq->root_rho[k] * eq->root_rho[k] / area : 0;
    eq->y[k] = 0;
  }
  eq->background = 0;
  return hr2di_equation_solve(eq);
}

/* ∫ ψ B over each patch, per band, into `product`. */
static void multiply(hr2di_equation *eq, const hr2d_solution *solution, size_t patch,
                     double *product) {
  const hr2di_transport *t = &eq->transport;
  const double area = t->hierarchy->element[patch].length;
  double *radiosity = eq->work;
  hr2di_solution_restrict(solution, t->hierarchy, t->leaf, t->leaves, t->order, radiosity,
                          t->watch);
  for (size_t k = 0; k < eq->field; k++) {
    const size_t item = k / t->bands;
    const hr2d_element *e = &t->hierarchy->element[t->leaf[item / t->order]];
    const int own = e->patch == patch && item % t->order == 0;
    const double psi = eq->irradiance[k] + (own ? 1 / area : 0);
    product[e->patch * t->bands + k % t->bands] += e->length * psi * radiosity[k];
  }
}

static hr2d_status weigh(const hr2di_graded *coarse, size_t patch, const hr2d_target *target,
                         double *weight) {
  const hr2d_scene *scene = coarse->hierarchy->scene;
  const hr2d_allocator *alloc = &coarse->links->alloc;
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.threads = target->threads;
  options.progress = target->progress;
  options.progress_ctx = target->progress_ctx;
  options.tolerance = 1e-6;
  hr2di_equation eq;
  hr2d_status status = hr2di_equation_init(&eq, coarse->links, &options);
  double *product = hr2di_alloc_zero(alloc, scene->patches * scene->bands, sizeof *product);
  if (!status && !product) status = HR2D_ENOMEM;
  if (!status) status = solve_adjoint(&eq, patch);
  if (!status) multiply(&eq, coarse->solution, patch, product);
  for (size_t k = 0; k < scene->patches && !status; k++) {
    weight[k] = LEAST;
    for (size_t b = 0; b < scene->bands; b++) {
      const double average = hr2d_solution_average(coarse->solution, patch, b);
      if (average > 0) weight[k] = fmax(weight[k], product[k * scene->bands + b] / average);
    }
    weight[k] = fmin(weight[k], 1);
  }
  hr2di_alloc_free(alloc, product);
  hr2di_equation_clear(&eq);
  return status;
}

hr2d_status hr2di_importance(const hr2d_scene *scene, size_t patch, const hr2d_target *target,
                             double *weight, hr2di_message *message) {
  const hr2di_resolution fineness = {.order = 2, .target = 0.1, .norm = target->norm};
  hr2di_graded coarse;
  hr2d_status status = hr2di_graded_refine(&coarse, scene, NULL, &fineness, target, message);
  if (!status) status = hr2di_graded_solve(&coarse, target, message);
  if (!status) {
    status = weigh(&coarse, patch, target, weight);
    if (status) hr2di_message_fail(message, status, "importance: %s", hr2d_strerror(status));
  }
  hr2di_graded_clear(&coarse);
  return status;
}
