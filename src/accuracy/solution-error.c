/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The errors of any solution, by comparison with one that is known to be much better. */
#include <hr2d/accuracy.h>
#include <math.h>

#include "accuracy/solution-distance.h"
#include "accuracy/target.h"
#include "base/clock.h"
#include "links/linkset-impl.h"
#include "scene/frozen-temperatures.h"
#include "solution/solution-impl.h"

/* A reference is good enough if its bound is at most this part of the distance. */
#define ENOUGH 0.05
#define FIRST  1e-4
#define FINEST 1e-14

/* Receives errors of B or of H; NULL: not wanted. */
typedef struct wanted {
  hr2d_error *average, *sup;
} wanted;

static int is_enough(const hr2d_error *error, const hr2d_error *reference) {
  return !error || reference->bound <= ENOUGH * error->estimate;
}

/* Compares with a reference that has these errors, and says whether it is good enough. */
static hr2d_status compare_one(const hr2di_reading *reading, const hr2d_solution *solution,
                               const hr2d_solution *reference, const hr2d_target *target,
                               wanted to, wanted of, int *enough) {
  hr2d_status status = HR2D_OK;
  hr2di_watch watch;
  if (to.average) {
    to.average->estimate = hr2di_distance_of_averages(reading, solution, reference, target);
    to.average->bound = to.average->estimate * (1 + of.average->bound) + of.average->bound;
  }
  hr2di_scene_watch(solution->hierarchy->scene, &watch, target->progress, target->progress_ctx,
                    "gather");
  if (to.sup) {
    status = hr2di_distance_at_points(reading, solution, reference, &watch, to.sup);
    to.sup->bound += of.sup->bound;
  }
  *enough = *enough && is_enough(to.average, of.average) && is_enough(to.sup, of.sup);
  return status;
}

/* Compares with a reference.  `enough` receives 1 if the reference is good enough, or the best
   that can be made.  Returns HR2D_OK, HR2D_EACCURACY if no reference could be made, or another
   status of hr2d_solve_to(). */
static hr2d_status compare(const hr2d_solution *solution, const hr2d_target *target, wanted b,
                           wanted h, int *enough) {
  hr2d_solution *reference = NULL;
  hr2d_account a;
  hr2d_status status =
      hr2d_solve_to(hr2di_scene_origin(hr2di_solution_scene(solution)), target, &reference, &a);
  const int best = status == HR2D_EACCURACY;
  *enough = best;
  if (reference && !isfinite(a.average.bound)) {
    hr2d_solution_destroy(reference);
    return HR2D_EACCURACY;
  }
  if (!reference) return status;
  *enough = 1;
  status = compare_one(&hr2di_reading_b, solution, reference, target, b,
                       (wanted){&a.average, &a.sup}, enough);
  if (!status)
    status = compare_one(&hr2di_reading_h, solution, reference, target, h,
                         (wanted){&a.irradiance, &a.irradiance_sup}, enough);
  *enough = *enough || best;
  hr2d_solution_destroy(reference);
  return status;
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
static hr2d_status measure(const hr2d_solution *solution, const hr2d_target *how, wanted b,
                           wanted h) {
  hr2d_target target = *how;
  listener l = {.progress = target.progress, .ctx = target.progress_ctx};
  target.no_error = 0;
  target.progress = listen;
  target.progress_ctx = &l;
  const double finest = fmax(target.error, FINEST);
  hr2d_status status = HR2D_OK;
  int enough = 0, compared = 0;
  for (double error = FIRST; !status && !enough; error *= 1e-3) {
    target.error = fmax(error, finest);
    status = compare(solution, &target, b, h, &enough);
    if (status == HR2D_EACCURACY && compared && !l.progress_status) status = HR2D_OK;
    compared = 1;
    enough = enough || target.error <= finest;
  }
  return status;
}

hr2d_status hr2d_solution_error(const hr2d_solution *solution, const hr2d_target *how,
                                hr2d_error *average, hr2d_error *sup) {
  hr2d_target target;
  if (!solution) return HR2D_EINVAL;
  const hr2d_scene *scene = solution->hierarchy->scene;
  hr2d_status status = hr2di_target_init(&target, scene, how, FINEST);
  target.points = sup != NULL;
  if (!status)
    status = measure(solution, &target, (wanted){average, sup}, (wanted){NULL, NULL});
  hr2di_target_clear(&target, &scene->alloc);
  return status;
}

hr2d_status hr2d_solution_account(const hr2d_solution *solution, const hr2d_target *how,
                                  hr2d_account *account) {
  hr2d_target target;
  if (!solution || !account) return HR2D_EINVAL;
  const hr2d_scene *scene = solution->hierarchy->scene;
  const double start = hr2di_clock_now();
  const hr2d_refine_counts counts = hr2d_linkset_counts(solution->links);
  hr2d_account a = {.order = (unsigned)solution->order,
                    .solves = 1,
                    .elements = counts.elements,
                    .leaves = counts.leaves,
                    .links = counts.links,
                    .sup = {NAN, NAN},
                    .irradiance_sup = {NAN, NAN}};
  hr2d_status status = hr2di_target_init(&target, scene, how, FINEST);
  const wanted b = {&a.average, target.points ? &a.sup : NULL},
               h = {&a.irradiance, target.points ? &a.irradiance_sup : NULL};
  if (!status) status = measure(solution, &target, b, h);
  hr2di_target_clear(&target, &scene->alloc);
  a.error_seconds = a.seconds = hr2di_clock_now() - start;
  if (!status) *account = a;
  return status;
}
