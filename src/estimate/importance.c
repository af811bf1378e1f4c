/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The adjoint equation (Smits, Arvo, Salesin 1992).  An error r in B = E + ρKB changes averages
   over a patch, with χ = 1 on it, by ∫ ψ r:
     B̄ = (1/A)∫ B   by ψ = χ/A + Kφ, with φ the radiosity of a source ρχ/A,
     H̄ = (1/A)∫ KB  by ψ = Kφ, with φ the radiosity of a source χ/A:
   light sent back from the patch that is asked for.  One φ of the sum of all sources, each over
   its average, serves all. */
#include "estimate/importance.h"

#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/equation.h"

/* Of the solve: even lights of dark patches have some digits. */
#define LIGHTS 1e-9

static int by_index(const void *a, const void *b) {
  const size_t i = *(const size_t *)a, j = *(const size_t *)b;
  return (i > j) - (i < j);
}

int hr2di_is_important(const hr2d_target *target, size_t patch) {
  return !target->important || bsearch(&patch, target->important, target->important_count,
                                       sizeof patch, by_index) != NULL;
}

/* For each patch and band, 1/(A·average) of B and of H where the patch counts, otherwise 0;
   times the largest average B of the band, `max`, so that it is a moderate number over A. */
typedef struct wanted {
  double *max;  /* bands */
  double *of_b; /* patches × bands */
  double *of_h;
} wanted;

typedef double average_of(const hr2d_solution *, size_t patch, size_t band);

static double largest(const hr2d_solution *solution, average_of *average, size_t band) {
  double max = 0;
  for (size_t k = 0; k < solution->hierarchy->scene->patches; k++)
    max = fmax(max, average(solution, k, band));
  return max;
}

static void want(const hr2d_solution *solution, average_of *average, const hr2d_target *target,
                 const double *upper, double *of, hr2di_watch *watch) {
  const hr2d_hierarchy *h = solution->hierarchy;
  const size_t patches = h->scene->patches, bands = h->scene->bands;
  for (size_t b = 0; b < bands; b++) {
    const double floor = target->floor * largest(solution, average, b);
    for (size_t k = 0; k < patches && !hr2di_watch_work(watch, 2); k++) {
      const double lower = fmax(average(solution, k, b), floor);
      const int counts = lower > 0 && hr2di_is_important(target, k);
      /* H may be smaller than B beyond all bounds; its weight is 1 long before. */
      of[k * bands + b] = counts ? fmin(upper[b] / lower, 1e100) / h->element[k].length : 0;
    }
  }
}

/* Solves for φ; eq->irradiance becomes Kφ.  The norm of a solve has the largest sources, which
   are those of dark patches. */
static hr2d_status solve_adjoint(hr2di_equation *eq, const wanted *w) {
  const hr2di_transport *t = &eq->transport;
  double min = HUGE_VAL, max = 0;
  for (size_t k = 0; k < eq->field && !hr2di_watch_work(t->watch, 1); k++) {
    const size_t item = k / t->bands;
    const uint32_t patch = t->hierarchy->element[t->leaf[item / t->order]].patch;
    const size_t at = patch * t->bands + k % t->bands;
    eq->source[k] = item % t->order == 0 ? w->of_b[at] : 0;
    eq->y[k] = 0;
  }
  hr2di_equation_scatter(eq, eq->source);
  for (size_t k = 0; k < eq->field && !hr2di_watch_work(t->watch, 1); k++) {
    const size_t item = k / t->bands;
    const uint32_t patch = t->hierarchy->element[t->leaf[item / t->order]].patch;
    const size_t at = patch * t->bands + k % t->bands;
    if (item % t->order == 0) eq->source[k] += w->of_h[at];
    if (eq->source[k] > 0) min = fmin(min, eq->source[k]);
    max = fmax(max, eq->source[k]);
  }
  if (hr2di_watch_status(t->watch)) return hr2di_watch_status(t->watch);
  eq->background = 0;
  eq->options.tolerance = max > 0 ? fmax(1e-6 * min / max, 1e-14) : 1e-6;
  return hr2di_equation_solve(eq);
}

/* The least average that is larger than 0, relative to the largest, over all bands; no less
   than the floor. */
static double contrast_of(const hr2d_solution *solution, average_of *average,
                          const hr2d_target *target) {
  const hr2d_scene *scene = solution->hierarchy->scene;
  double lower = 1;
  for (size_t b = 0; b < scene->bands; b++) {
    const double max = largest(solution, average, b);
    for (size_t k = 0; k < scene->patches; k++) {
      const double is = average(solution, k, b);
      if (is > 0) lower = fmin(lower, fmax(is / max, target->floor));
    }
  }
  return lower;
}

double hr2di_least_irradiance(const hr2d_solution *solution, const hr2d_target *target) {
  const hr2d_scene *scene = solution->hierarchy->scene;
  double least = 1;
  for (size_t b = 0; b < scene->bands; b++) {
    const double max = largest(solution, hr2d_solution_irradiance, b);
    for (size_t k = 0; k < hr2di_scene_cell(scene); k++) {
      const double is = hr2d_solution_irradiance(solution, k, b);
      if (is > 0 && hr2di_is_important(target, k)) least = fmin(least, is / max);
    }
  }
  return least;
}

static hr2d_status set_lights(hr2di_equation *eq, const hr2d_solution *solution,
                              const hr2d_target *target, const wanted *w,
                              hr2di_primal_dual *lights) {
  hr2di_transport *t = &eq->transport;
  const hr2d_hierarchy *h = t->hierarchy;
  const size_t values = h->elements * t->bands;
  const hr2d_status status = hr2di_hierarchy_clone(h, &lights->trees);
  if (status) return status;
  lights->radiosity = hr2di_alloc(&t->alloc, values, sizeof *lights->radiosity);
  lights->importance = hr2di_alloc(&t->alloc, values, sizeof *lights->importance);
  if (!lights->radiosity || !lights->importance) return HR2D_ENOMEM;
  lights->contrast = fmin(contrast_of(solution, hr2d_solution_average, target),
                          contrast_of(solution, hr2d_solution_irradiance, target));
  hr2di_transport_pull(t, eq->radiosity);
  for (size_t k = 0; k < values; k++) {
    const double max = w->max[k % t->bands];
    lights->radiosity[k] = fmax(0, solution->value[k]);
    lights->importance[k] = max > 0 ? t->up[k / t->bands * t->width + k % t->bands] / max : 0;
  }
  return hr2di_watch_work(t->watch, values / 8);
}

void hr2di_primal_dual_clear(hr2di_primal_dual *lights, const hr2d_scene *scene) {
  hr2di_alloc_free(&scene->alloc, lights->radiosity);
  hr2di_alloc_free(&scene->alloc, lights->importance);
  hr2d_hierarchy_destroy(lights->trees);
  *lights = (hr2di_primal_dual){0};
}

static hr2d_status find_lights(const hr2di_graded *coarse, const hr2d_target *target,
                               hr2di_primal_dual *lights) {
  const hr2d_scene *scene = coarse->hierarchy->scene;
  const hr2d_allocator *alloc = &coarse->links->alloc;
  const size_t values = scene->patches * scene->bands;
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.threads = target->threads;
  options.progress = target->progress;
  options.progress_ctx = target->progress_ctx;
  hr2di_equation eq;
  const hr2di_equation_how how = hr2di_equation_how_of(coarse->links);
  hr2d_status status =
      hr2di_equation_init(&eq, coarse->links, coarse->links->hierarchy->scene, &how, &options);
  double *space = hr2di_alloc_zero(alloc, 2 * values + scene->bands, sizeof *space);
  if (!status && !space) status = HR2D_ENOMEM;
  if (!status) {
    const wanted w = {space, space + scene->bands, space + scene->bands + values};
    for (size_t b = 0; b < scene->bands; b++)
      w.max[b] = largest(coarse->solution, hr2d_solution_average, b);
    want(coarse->solution, hr2d_solution_average, target, w.max, w.of_b, &eq.watch);
    want(coarse->solution, hr2d_solution_irradiance, target, w.max, w.of_h, &eq.watch);
    status = hr2di_watch_status(&eq.watch);
    if (!status) status = solve_adjoint(&eq, &w);
    if (!status) status = set_lights(&eq, coarse->solution, target, &w, lights);
    if (!status) status = hr2di_watch_status(&eq.watch);
  }
  hr2di_alloc_free(alloc, space);
  hr2di_equation_clear(&eq);
  return status;
}

/* What the caller's callback said: it may use any status. */
typedef struct listener {
  const hr2d_target *target;
  hr2d_status said;
} listener;

static hr2d_status listen(void *ctx, const hr2d_progress *progress) {
  listener *l = ctx;
  l->said = l->target->progress(l->target->progress_ctx, progress);
  return l->said;
}

/* Whether something else than the scene or memory ended a coarse solve. */
static int is_spared(hr2d_status status) {
  return status == HR2D_EMAX_ELEMENTS || status == HR2D_EMAX_LINKS ||
         status == HR2D_EMAX_BYTES || status == HR2D_ENOT_CONVERGED;
}

hr2d_status hr2di_importance(const hr2d_scene *scene, const hr2d_target *given,
                             hr2di_beam_cache *beam_cache, hr2di_primal_dual *lights,
                             hr2di_survey *survey, hr2di_message *message) {
  const hr2di_resolution fineness = {.order = 1,
                                     .target = 0.1,
                                     .tolerance = LIGHTS,
                                     .norm = given->norm,
                                     .beam_cache = beam_cache};
  listener l = {.target = given};
  hr2d_target heard = *given, *target = &heard;
  if (given->progress) {
    heard.progress = listen;
    heard.progress_ctx = &l;
  }
  hr2di_graded coarse;
  hr2d_status status = hr2di_graded_refine(&coarse, scene, &fineness, target, message);
  if (!status) *survey = coarse.survey;
  if (!status) status = hr2di_graded_solve(&coarse, &fineness, target, message);
  if (!status) {
    status = find_lights(&coarse, target, lights);
    if (status) hr2di_message_fail(message, status, "importance: %s", hr2d_strerror(status));
  }
  hr2di_graded_clear(&coarse);
  status = hr2di_share_agree(given->share, status);
  if (status) hr2di_primal_dual_clear(lights, scene);
  double said = l.said != HR2D_OK;
  hr2di_share_begin(given->share);
  if (hr2di_share_combine(given->share, HR2D_OK, HR2D_COMBINE_MOST, &said, 1)) return status;
  return !(said > 0) && is_spared(status) ? HR2D_OK : status;
}
