/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of any solution, by comparison with one that is known to be much better. */
#include <hr2d/accuracy.h>
#include <math.h>

#include "accuracy/importance.h"
#include "accuracy/target.h"
#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/settled.h"
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

/* The points where two solutions differ most, the worst one first. */
enum { MOST = 64 };
typedef struct far_apart {
  size_t patch;
  double at, distance;
} far_apart;

static void insert(far_apart *worst, size_t *count, far_apart point) {
  size_t k = *count < MOST ? (*count)++ : MOST;
  if (k == MOST && worst[--k].distance >= point.distance) return;
  for (; k > 0 && worst[k - 1].distance < point.distance; k--) worst[k] = worst[k - 1];
  worst[k] = point;
}

/* Where the polynomials of the solutions differ most, in one band; the largest value of it. */
static double find_points(const hr2d_solution *solution, const hr2d_solution *reference,
                          size_t band, far_apart *worst, size_t *count, hr2di_watch *watch) {
  const hr2d_hierarchy *h = solution->hierarchy;
  double max = 0;
  *count = 0;
  for (uint32_t e = 0; e < solution->elements && !hr2di_watch_work(watch, 4 * PLACES); e++) {
    const uint32_t patch = h->element[e].patch;
    if (h->element[e].child && h->element[e].child < solution->elements) continue;
    const double from = hr2di_element_start(h, e);
    const double size = h->element[e].length / h->element[patch].length;
    for (int k = 0; k < PLACES; k++) {
      const double t = fmin(from + place[k] * size, 1);
      const double right = hr2d_solution_at(reference, patch, t, band);
      const double is = hr2d_solution_at(solution, patch, t, band);
      max = fmax(max, right);
      insert(worst, count, (far_apart){patch, t, fabs(is - right)});
    }
  }
  return max;
}

/* The polynomials of the reference converge slowly beside corners, and nothing states their
   error.  So at the worst points the reference is gathered; elsewhere the polynomials differ by
   no more than at the last of these, which is the bound. */
static hr2d_status sup_distance(const hr2d_solution *solution, const hr2d_solution *reference,
                                const hr2d_target *target, hr2d_error *sup) {
  hr2di_watch watch;
  hr2di_scene_watch(solution->hierarchy->scene, &watch, target->progress, target->progress_ctx,
                    "gather");
  double *value = hr2di_alloc(&solution->alloc, solution->bands, sizeof *value);
  hr2d_status status = value ? HR2D_OK : HR2D_ENOMEM;
  *sup = (hr2d_error){0, 0};
  for (size_t b = 0; b < solution->bands && !status; b++) {
    far_apart worst[MOST];
    size_t count;
    double error = 0, max = find_points(solution, reference, b, worst, &count, &watch);
    for (size_t k = 0; k < count && !status; k++) {
      const far_apart *w = &worst[k];
      status = hr2di_solution_gather(reference, w->patch, &w->at, 1, value, &watch);
      if (status) break;
      max = fmax(max, value[b]);
      error = fmax(error, fabs(hr2d_solution_at(solution, w->patch, w->at, b) - value[b]));
    }
    const double others = count == MOST ? fmax(error, worst[MOST - 1].distance) : error;
    if (error > 0) sup->estimate = fmax(sup->estimate, error / max);
    if (others > 0) sup->bound = fmax(sup->bound, others / max);
  }
  hr2di_alloc_free(&solution->alloc, value);
  return status;
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
  hr2d_status status = hr2d_solve_to(hr2di_scene_origin(solution->hierarchy->scene), target,
                                     &reference, &account);
  *enough = status == HR2D_EACCURACY;
  if (reference && !isfinite(account.average.bound)) {
    hr2d_solution_destroy(reference);
    return HR2D_EACCURACY;
  }
  if (!reference) return status;
  status = HR2D_OK;
  if (average) {
    average->estimate = average_distance(solution, reference, target);
    average->bound = average->estimate * (1 + account.average.bound) + account.average.bound;
  }
  if (sup) {
    status = sup_distance(solution, reference, target, sup);
    sup->bound += account.sup.bound;
  }
  *enough = *enough || (is_enough(average, &account.average) && is_enough(sup, &account.sup));
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
hr2d_status hr2d_solution_error(const hr2d_solution *solution, const hr2d_target *how,
                                hr2d_error *average, hr2d_error *sup) {
  if (!solution) return HR2D_EINVAL;
  const hr2d_scene *scene = solution->hierarchy->scene;
  hr2d_target target;
  hr2d_status status = hr2di_target_init(&target, scene, how, FINEST);
  if (status) return status;
  listener l = {.progress = target.progress, .ctx = target.progress_ctx};
  target.no_error = 0;
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
