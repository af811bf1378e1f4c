/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of any solution, by comparison with one that is known to be much better. */
#include <hr2d/accuracy.h>
#include <math.h>

#include "accuracy/importance.h"
#include "accuracy/target.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"

/* A reference is good enough if its bound is at most this part of the distance. */
#define ENOUGH 0.05
#define FIRST  1e-4
#define FINEST 1e-14

/* Points of each leaf: just inside its ends, and between them. */
static const double place[] = {1e-9, 0.25, 0.5, 0.75, 1 - 1e-9};
enum { PLACES = sizeof place / sizeof *place };

/* Of the patches that count, relative to averages but to no less than the floor, as the errors
   of hr2d_solve_to(). */
static double average_distance(const hr2d_solution *solution, const hr2d_solution *reference,
                               const hr2d_target *target) {
  const hr2d_scene *scene = solution->hierarchy->scene;
  double worst = 0;
  for (size_t b = 0; b < scene->bands; b++) {
    double max = 0;
    for (size_t k = 0; k < scene->patches; k++)
      max = fmax(max, hr2d_solution_average(reference, k, b));
    for (size_t k = 0; k < scene->patches; k++) {
      const double right = hr2d_solution_average(reference, k, b);
      const double error = fabs(hr2d_solution_average(solution, k, b) - right);
      if (error > 0 && hr2di_is_important(target, k))
        worst = fmax(worst, error / fmax(right, target->floor * max));
    }
  }
  return worst;
}

static double sup_distance(const hr2d_solution *solution, const hr2d_solution *reference) {
  const hr2d_hierarchy *h = solution->hierarchy;
  double worst = 0;
  for (size_t b = 0; b < solution->bands; b++) {
    double error = 0, max = 0;
    for (uint32_t e = 0; e < solution->elements; e++) {
      const uint32_t patch = h->element[e].patch;
      if (h->element[e].child && h->element[e].child < solution->elements) continue;
      const double from = hr2di_element_start(h, e);
      const double size = h->element[e].length / h->element[patch].length;
      for (int k = 0; k < PLACES; k++) {
        const double t = fmin(from + place[k] * size, 1);
        const double right = hr2d_solution_at(reference, patch, t, b);
        max = fmax(max, right);
        error = fmax(error, fabs(hr2d_solution_at(solution, patch, t, b) - right));
      }
    }
    if (error > 0) worst = fmax(worst, error / max);
  }
  return worst;
}

static int is_enough(const hr2d_error *error, const hr2d_error *reference) {
  return !error || reference->bound <= ENOUGH * error->estimate;
}

/* Compares with a reference.  `enough` receives 1 if the reference is good enough, or the best
   that can be made.  Returns HR2D_OK, HR2D_EACCURACY if no reference could be made, or another
   status of hr2d_solve_to(). */
static hr2d_status compare(const hr2d_solution *solution, const hr2d_target *target,
                           hr2d_error *average, hr2d_error *sup, int *enough) {
  hr2d_solution *reference = NULL;
  hr2d_account account;
  hr2d_status status = hr2d_solve_to(solution->hierarchy->scene, target, &reference, &account);
  *enough = status == HR2D_EACCURACY;
  if (!reference) return status;
  if (average) {
    average->estimate = average_distance(solution, reference, target);
    average->bound = average->estimate + account.average.bound;
  }
  if (sup) {
    sup->estimate = sup_distance(solution, reference);
    sup->bound = sup->estimate + account.sup.bound;
  }
  *enough = *enough || (is_enough(average, &account.average) && is_enough(sup, &account.sup));
  hr2d_solution_destroy(reference);
  return HR2D_OK;
}

/* The caller's progress callback, and the last status that it returned. */
typedef struct listener {
  hr2d_progress_fn progress;
  void *ctx;
  hr2d_status progress_status;
} listener;

static hr2d_status listen(void *ctx, const hr2d_progress *progress) {
  listener *l = ctx;
  if (l->progress) l->progress_status = l->progress(l->ctx, progress);
  return l->progress_status;
}

/* If the budgets do not suffice for a better comparison, the last one stands. */
hr2d_status hr2d_solution_error(const hr2d_solution *solution, const hr2d_target *how,
                                hr2d_error *average, hr2d_error *sup) {
  const hr2d_scene *scene = solution->hierarchy->scene;
  hr2d_target target;
  hr2d_status status = hr2di_target_init(&target, scene, how, FINEST);
  if (status) return status;
  listener l = {.progress = target.progress, .ctx = target.progress_ctx};
  target.progress = listen;
  target.progress_ctx = &l;
  const double finest = fmax(target.error, FINEST);
  int enough = 0, compared = 0;
  for (double error = FIRST; !status && !enough; error *= 1e-3) {
    target.error = fmax(error, finest);
    status = compare(solution, &target, average, sup, &enough);
    if (status == HR2D_EACCURACY && compared && !l.progress_status) status = HR2D_OK;
    compared = 1;
    enough = enough || target.error <= finest;
  }
  hr2di_target_clear(&target, scene);
  return status;
}
