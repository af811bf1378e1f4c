/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves to a target: guesses a resolution, solves, estimates the error, and raises the
   resolution while the error is above the target. */
#include "accuracy/solve-to.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "accuracy/error-estimate.h"
#include "accuracy/importance.h"
#include "accuracy/resolution.h"
#include "accuracy/sketch.h"
#include "accuracy/target.h"
#include "base/alloc.h"
#include "base/clock.h"
#include "links/linkset-impl.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"

enum { ATTEMPTS = 8, LEAST_SAFE = 6 };

/* The best graded solve so far, and the time and work of all. */
typedef struct search {
  const hr2d_scene *scene;
  hr2d_target target;          /* the caller's, with watch() as progress callback */
  hr2d_target given;           /* the caller's; its error is 0 for the smallest */
  double start, deadline;      /* deadline 0: none */
  int late;                    /* a call was ended because the time was up */
  hr2d_status progress_status; /* of the caller's progress callback */
  hr2di_survey survey;
  hr2di_graded best;
  hr2di_resolution fineness; /* of the best */
  double *weight;            /* per patch, where importance is asked for */
  hr2di_lights lights;       /* of patches, where there are events */
  hr2d_account account;      /* of the best, with all times */
  hr2d_error error;          /* of the best, the larger one of B and H */
  double cut_off;            /* what of it images may make that are cut off */
  double rounding;           /* the part of its bound that is rounding */
  hr2di_message message;
} search;

/* Of several shares only the first one looks at its clock. */
static double left(const search *s) {
  const hr2d_share *share = s->target.share;
  const int looks = s->deadline > 0 && (!share || share->number == 0);
  return looks ? s->deadline - hr2di_clock_now() : HUGE_VAL;
}

/* Ends a call when the time is up. */
static hr2d_status watch(void *ctx, const hr2d_progress *progress) {
  search *s = ctx;
  s->late = left(s) <= 0;
  if (s->late) return HR2D_STOPPED;
  if (s->given.progress)
    s->progress_status = s->given.progress(s->given.progress_ctx, progress);
  return s->progress_status;
}

/* All shares have the same status from here on, and know whether it was the clock or a callback
   that ended a call. */
static hr2d_status agree(search *s, hr2d_status status) {
  hr2d_share *share = s->target.share;
  if (!share) return status;
  status = hr2di_share_agree(share, status);
  double said[] = {s->late, s->progress_status, -s->progress_status};
  hr2di_share_begin(share);
  const hr2d_status failed = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_MOST, said, 3);
  s->late = said[0] > 0;
  s->progress_status = (hr2d_status)(said[1] > 0 ? said[1] : -said[2]);
  return failed ? failed : status;
}

/* The larger error of B and H, in the norm of the target. */
static hr2d_error worst_of(const hr2di_error_pair *e, hr2d_norm norm) {
  const hr2d_error b = norm == HR2D_NORM_SUP ? e->sup : e->average;
  const hr2d_error h = norm == HR2D_NORM_SUP ? e->irradiance_sup : e->irradiance;
  return (hr2d_error){fmax(b.estimate, h.estimate), fmax(b.bound, h.bound)};
}

static double error_of(const search *s) {
  return s->error.estimate;
}

static int is_reached(const search *s, double error) {
  return error_of(s) <= HR2DI_ERROR_MARGIN * error || s->error.bound <= error;
}

static void add_times(hr2d_account *sum, const hr2di_graded *answer) {
  sum->refine_seconds += answer->refine_seconds;
  sum->coefficients_seconds += answer->coefficients_seconds;
  sum->solve_seconds += answer->solve_seconds;
  sum->kernels += answer->kernels;
  sum->solves += answer->solution != NULL;
}

/* Notes the errors of the best one. */
static void note_errors(search *s, const hr2di_error_pair *errors) {
  hr2d_account *a = &s->account;
  s->error = worst_of(errors, s->target.norm);
  s->cut_off = errors->cut_off[s->target.norm == HR2D_NORM_SUP];
  s->rounding = errors->rounding[s->target.norm == HR2D_NORM_SUP];
  a->average = errors->average;
  a->sup = errors->sup;
  a->irradiance = errors->irradiance;
  a->irradiance_sup = errors->irradiance_sup;
}

/* Keeps a graded solve, with its errors, as the best one. */
static void keep(search *s, hr2di_graded *answer, const hr2di_error_pair *errors) {
  hr2di_graded_clear(&s->best);
  s->best = *answer;
  *answer = (hr2di_graded){0};
  const hr2d_hierarchy_counts counts = hr2d_hierarchy_count(s->best.hierarchy);
  hr2d_account *a = &s->account;
  note_errors(s, errors);
  a->order = s->best.hierarchy->order;
  a->elements = counts.elements;
  a->leaves = counts.leaves;
  a->links = hr2d_linkset_counts(s->best.links).links;
  if (s->best.links->roots.clusters)
    a->links += hr2di_clusters_links(s->best.links->roots.clusters);
  a->events = s->best.events;
  a->bytes = hr2di_graded_bytes(&s->best);
}

static const hr2di_error_pair unknown = {.average = {HUGE_VAL, HUGE_VAL},
                                         .sup = {HUGE_VAL, HUGE_VAL},
                                         .irradiance = {HUGE_VAL, HUGE_VAL},
                                         .irradiance_sup = {HUGE_VAL, HUGE_VAL}};

/* Parts of the time for the factors of a sketch, and for the whole sketch. */
#define FACTORS 0.8
#define SKETCH  0.95

/* One constant per patch, of unknown error, to have an answer whatever happens.  If the time
   does not suffice for all factors of whole patches, nothing better is tried. */
static hr2d_status sketch(search *s) {
  hr2di_graded answer;
  int late;
  const double all = s->deadline > 0 ? s->given.seconds : HUGE_VAL;
  const size_t patches = s->scene->patches;
  if (s->given.max_elements && s->given.max_elements < patches) return HR2D_OK;
  if (s->given.max_bytes && s->given.max_bytes / HR2DI_ELEMENT_BYTES < patches) return HR2D_OK;
  hr2d_status status = hr2di_sketch(
      &answer, s->scene, &s->given,
      (hr2di_sketch_times){s->start + FACTORS * all, s->start + SKETCH * all}, &late);
  add_times(&s->account, &answer);
  if (!status) keep(s, &answer, &unknown);
  if (status && status != HR2D_ENOMEM) s->progress_status = status;
  hr2di_graded_clear(&answer);
  s->late = !status && late;
  return agree(s, s->late ? HR2D_STOPPED : status);
}

/* What the best solve so far holds is not there for another. */
static hr2d_target rest_of_budget(const search *s) {
  hr2d_target target = s->target;
  const uint64_t held = s->best.hierarchy && s->best.links ? hr2di_graded_bytes(&s->best) : 0;
  if (target.max_bytes)
    target.max_bytes = held < target.max_bytes ? target.max_bytes - held : 1;
  return target;
}

/* Bounds the error of the best one, if that was too large for anybody to ask. */
static hr2d_status bound_best(search *s) {
  hr2di_resolution fineness = s->fineness;
  hr2di_error_pair errors;
  if (!s->best.unbounded) return HR2D_OK;
  const double start = hr2di_clock_now();
  fineness.hasty = fineness.shares = 0;
  hr2di_error_prepare(&s->best, &fineness);
  const hr2d_status status =
      agree(s, hr2di_error_estimate(&s->best, &fineness, &s->target, &errors, &s->message));
  s->account.error_seconds += hr2di_clock_now() - start;
  if (!status) note_errors(s, &errors);
  return status;
}

/* Solves once, estimates the error, and keeps the graded solve if it is the best so far.  With
   `dividing` the elements are those of the best, divided. */
static hr2d_status attempt(search *s, const hr2di_resolution *fineness, int dividing) {
  hr2di_graded answer;
  hr2di_error_pair errors;
  const hr2d_target target = rest_of_budget(s);
  hr2d_status status =
      dividing ? hr2di_graded_divide(&answer, &s->best, fineness, &target, &s->message)
               : hr2di_graded_refine(&answer, s->scene, fineness, &target, &s->message);
  if (!status && !s->given.no_error) hr2di_error_prepare(&answer, fineness);
  if (!status) status = hr2di_graded_solve(&answer, fineness, &s->target, &s->message);
  add_times(&s->account, &answer);
  const double start = hr2di_clock_now();
  if (!status && !s->given.no_error) {
    status = hr2di_error_estimate(&answer, fineness, &s->target, &errors, &s->message);
    s->account.error_seconds += hr2di_clock_now() - start;
  }
  status = agree(s, status);
  if (!status && s->given.no_error) {
    keep(s, &answer, &unknown);
  } else if (!status) {
    const double error = worst_of(&errors, s->target.norm).estimate;
    if (!s->best.solution || error < error_of(s) || !isfinite(error_of(s))) {
      keep(s, &answer, &errors);
      s->fineness = *fineness;
    }
  } else if (s->late && answer.solution && !isfinite(error_of(s))) {
    keep(s, &answer, &unknown);
  }
  hr2di_graded_clear(&answer);
  return status;
}

static void give_reason(search *s, const char *reason) {
  snprintf(s->account.reason, sizeof s->account.reason, "%.150s", reason);
}

/* Whether what is left of the error is rounding. */
static int is_rounding(const search *s) {
  return error_of(s) <= s->rounding;
}

/* Whether what is left is mostly that of images that are cut off: then elements do not matter.
 */
static int is_cut_off(const search *s, double error) {
  return s->cut_off > HR2DI_ERROR_MARGIN * error && error_of(s) <= 4 * s->cut_off;
}

/* The resolution to begin with: no coarser than the best one so far, which was not enough. */
static hr2di_resolution first_resolution(const search *s, double error) {
  hr2di_resolution guess = hr2di_resolution_for(s->scene, &s->survey, error, s->target.norm,
                                                s->lights.radiosity ? &s->lights : NULL);
  hr2di_resolution finer = s->fineness;
  guess.weight = s->weight;
  guess.hasty = !(s->given.seconds > 0); /* there is time for a bound at the end */
  /* Under a background of their own temperature scenes are isothermal to all digits. */
  if (!guess.lights && !s->given.no_error && !s->scene->effect[HR2D_EFFECT_BACKGROUND].on) {
    guess.tolerance = hr2di_resolution_tolerance(s->scene, s->given.floor, error);
    guess.relative = hr2di_resolution_tolerance(s->scene, 1, error);
    guess.floor = s->given.floor;
  }
  const int known = s->best.solution && isfinite(error_of(s));
  const int is_finer =
      known && !hr2di_resolution_raise(&finer, &s->best.survey, error_of(s) / (0.5 * error)) &&
      finer.order > guess.order;
  return is_finer ? finer : guess;
}

/* Finer elements do not help where the error is what links of clusters lack. */
static int raise_clusters(const search *s, hr2di_resolution *fineness, double error) {
  return s->best.clustered > 0.5 * error_of(s) &&
         !hr2di_resolution_raise_clusters(fineness, s->best.clustered, error);
}

/* Goes finer until the error is below `error`; HR2D_EACCURACY if it does not come down. */
static hr2d_status reach(search *s, double error) {
  if (s->best.solution && is_reached(s, error)) return HR2D_OK;
  hr2di_resolution fineness = first_resolution(s, error);
  double before = HUGE_VAL;
  int stuck = 0, raised = 1, dividing = 0;
  for (int k = 0; k < ATTEMPTS && (stuck < 2 || !is_rounding(s)) && raised; k++) {
    const hr2d_status status = attempt(s, &fineness, dividing);
    /* At a low order rows of K may exceed 1 in narrow corners, even with closure. */
    if (status == HR2D_ENOT_CONVERGED && !s->progress_status && k + 1 < ATTEMPTS &&
        fineness.order < LEAST_SAFE) {
      fineness.order++;
      continue;
    }
    if (status || s->given.no_error || is_reached(s, error)) return status;
    if (is_cut_off(s, error)) break;
    stuck = error_of(s) > 0.5 * before ? stuck + 1 : 0;
    before = error_of(s);
    const hr2d_status bounded = stuck > 0 ? bound_best(s) : HR2D_OK;
    if (bounded) return bounded;
    dividing = s->best.depth && !stuck;
    raised = raise_clusters(s, &fineness, error) || dividing ||
             !hr2di_resolution_raise(&fineness, &s->best.survey, before / (0.5 * error));
  }
  if (error_of(s) <= error) return HR2D_OK;
  give_reason(s, is_cut_off(s, error)
                     ? "images of the period that are cut off may make that much"
                 : stuck > 0 && is_rounding(s)
                     ? "finer elements bring the error down no further"
                     : "the error comes down too slowly: the finest elements that are tried do "
                       "not suffice");
  return HR2D_EACCURACY;
}

static int is_budget(hr2d_status status) {
  return status == HR2D_EMAX_ELEMENTS || status == HR2D_EMAX_LINKS || status == HR2D_EMAX_BYTES;
}

/* Reaches falling targets one by one, while the time seems to suffice for the next and no
   budget is spent. */
static hr2d_status reach_step_by_step(search *s) {
  hr2d_status status = HR2D_OK;
  for (double error = 1e-1; !status; error *= 1e-2) {
    const double aim = fmax(error, s->given.error), start = hr2di_clock_now();
    status = reach(s, aim);
    if (status || error_of(s) <= s->given.error || aim <= s->given.error) break;
    s->late = 1.2 * (hr2di_clock_now() - start) > left(s); /* a finer one takes longer still */
    status = agree(s, HR2D_OK);
    if (s->late) break;
  }
  return !status && s->late ? HR2D_STOPPED : status;
}

/* The status of the whole search, with a reason if the target was not reached.  A spent budget
   is HR2D_EACCURACY, with a solution or without one; HR2D_OK if there is a solution of known
   error, or of one that nobody asked for, and the target error is 0. */
static hr2d_status settle(search *s, hr2d_status status) {
  const int is_known = s->given.no_error ? s->best.solution && s->best.hierarchy->order > 1
                                         : isfinite(error_of(s));
  if (s->progress_status) {
    give_reason(s, "stopped by the callback");
    return s->progress_status;
  }
  const int is_spent = is_budget(status) || (status == HR2D_STOPPED && s->late);
  if (status == HR2D_STOPPED && s->late)
    give_reason(s, is_known ? "the time is used up"
                            : "the time does not suffice for a solution of known error");
  else if (status && status != HR2D_EACCURACY)
    give_reason(s, s->message.text);
  if (is_spent || (status == HR2D_ENOT_CONVERGED && is_known)) status = HR2D_EACCURACY;
  if (!status && s->best.solution && !isfinite(s->error.bound) && !s->given.no_error) {
    give_reason(s, "the error has no finite bound");
    status = HR2D_EACCURACY;
  }
  const int all_there_is =
      !(s->given.error > 0) && (s->given.no_error ? is_known : isfinite(s->error.bound));
  return status == HR2D_EACCURACY && all_there_is ? HR2D_OK : status;
}

/* Without lights of patches elements end at all events.  The elements for weights are also a
   survey, but of averages only. */
static hr2d_status weigh_patches(search *s) {
  hr2di_lights *lights = hr2di_resolution_wants_lights(s->scene, &s->given) ? &s->lights : NULL;
  if (!s->given.important && !lights) return HR2D_OK;
  if (s->given.important) {
    s->weight = hr2di_alloc(&s->scene->alloc, s->scene->patches, sizeof *s->weight);
    if (!s->weight) return HR2D_ENOMEM;
  }
  return hr2di_importance(s->scene, &s->target, s->weight, lights,
                          s->target.norm == HR2D_NORM_AVERAGE ? &s->survey : NULL, &s->message);
}

/* Hands the best solution over; it owns its hierarchy and its links from then on. */
static void hand_over(search *s, hr2d_solution **solution) {
  *solution = s->best.solution;
  if (!*solution) return;
  hr2d_linkset *links = s->best.links;
  if (s->best.depth &&
      hr2di_link_blocks_trim(&links->blocks, s->best.hierarchy->order, &links->alloc))
    hr2di_link_blocks_clear(&links->blocks, &links->alloc); /* a solve makes them again */
  (*solution)->own_hierarchy = s->best.hierarchy;
  (*solution)->own_links = s->best.links;
  hr2di_alloc_free(&s->scene->alloc, s->best.bent);
  hr2di_alloc_free(&s->scene->alloc, s->best.depth);
  hr2di_alloc_free(&s->scene->alloc, s->best.rows);
  s->best = (hr2di_graded){0};
}

hr2d_status hr2di_solve_to(const hr2d_scene *scene, const hr2d_target *target,
                           hr2d_solution **solution, hr2d_account *account) {
  search s = {.scene = scene, .start = hr2di_clock_now(), .error = {HUGE_VAL, HUGE_VAL}};
  hr2d_status status = hr2di_target_init(&s.given, scene, target, HR2D_DEFAULT_ERROR);
  hr2di_share_begin(s.given.share);
  status = hr2di_share_agree(s.given.share, status);
  if (status) {
    hr2di_target_clear(&s.given, scene);
    return status;
  }
  s.target = s.given;
  s.target.progress = watch;
  s.target.progress_ctx = &s;
  if (s.given.seconds > 0) s.deadline = s.start + s.given.seconds;
  hr2di_watch watch_of;
  hr2di_scene_watch(scene, &watch_of, watch, &s, "refine");
  if (s.deadline > 0) status = sketch(&s);
  if (!status) status = agree(&s, weigh_patches(&s));
  if (!status && !(s.survey.ellipse > 0))
    status = agree(&s, hr2di_resolution_survey(scene, s.given.threads, &watch_of, &s.survey));
  if (!status && !(s.given.seconds > 0)) {
    status = reach(&s, s.given.error > 0 ? s.given.error : 1e-15);
    if (is_budget(status) && !s.progress_status) status = reach_step_by_step(&s);
    if (is_budget(status) && !s.best.solution) {
      const hr2d_status sketched = sketch(&s);
      status = sketched ? sketched : status;
    }
  } else if (!status) {
    status = reach_step_by_step(&s);
  }
  if (!s.progress_status && status != HR2D_ENOMEM) {
    const hr2d_status bounded = bound_best(&s);
    if (bounded) status = bounded;
  }
  status = settle(&s, status);
  if (!s.progress_status && (!status || status == HR2D_EACCURACY)) hand_over(&s, solution);
  s.account.seconds = hr2di_clock_now() - s.start;
  if (account) *account = s.account;
  hr2di_graded_clear(&s.best);
  hr2di_lights_clear(&s.lights, scene);
  hr2di_alloc_free(&scene->alloc, s.weight);
  hr2di_target_clear(&s.given, scene);
  return status;
}
