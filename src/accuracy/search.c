/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "accuracy/search.h"

#include <math.h>

#include "accuracy/fallback-solve.h"
#include "accuracy/target.h"
#include "base/alloc.h"
#include "base/choices.h"
#include "base/clock.h"
#include "estimate/importance.h"
#include "links/linkset-impl.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"

/* Of several shares only the first one looks at its clock. */
double hr2di_search_left(const hr2di_search *s) {
  const hr2d_share *share = s->target.share;
  const int reads_clock = s->deadline > 0 && (!share || share->number == 0);
  return reads_clock ? s->deadline - hr2di_clock_now() : HUGE_VAL;
}

/* Ends a call when the time is up. */
static hr2d_status watch(void *ctx, const hr2d_progress *progress) {
  hr2di_search *s = ctx;
  s->out_of_time = hr2di_search_left(s) <= 0;
  if (s->out_of_time) return HR2D_STOPPED;
  if (s->given.progress)
    s->progress_status = s->given.progress(s->given.progress_ctx, progress);
  return s->progress_status;
}

/* Makes a beam cache unless bytes are limited, or shares have memory for their own rows alone.
 */
static hr2d_status make_beam_cache(hr2di_search *s) {
  if (!s->scene->effect[HR2D_EFFECT_OCCLUSION].on || s->given.max_bytes || s->given.share)
    return HR2D_OK;
  return hr2di_beam_cache_init(&s->beam_cache, s->scene, HR2DI_CHOICE_SEEN_BYTES);
}

hr2di_beam_cache *hr2di_search_beam_cache(hr2di_search *s) {
  return s->beam_cache.of ? &s->beam_cache : NULL;
}

hr2d_status hr2di_search_init(hr2di_search *s, const hr2d_scene *scene,
                              const hr2d_target *target) {
  *s =
      (hr2di_search){.scene = scene, .start = hr2di_clock_now(), .error = {HUGE_VAL, HUGE_VAL}};
  hr2d_status status = hr2di_target_init(&s->given, scene, target, HR2D_DEFAULT_ERROR);
  if (!status) status = make_beam_cache(s);
  s->target = s->given;
  s->target.progress = watch;
  s->target.progress_ctx = s;
  if (s->given.seconds > 0) s->deadline = s->start + s->given.seconds;
  hr2di_share_begin(s->given.share);
  return hr2di_share_agree(s->given.share, status);
}

void hr2di_search_clear(hr2di_search *s) {
  hr2di_graded_clear(&s->best);
  hr2di_beam_cache_clear(&s->beam_cache);
  hr2di_primal_dual_clear(&s->lights, s->scene);
  hr2di_target_clear(&s->given, &s->scene->alloc);
}

hr2d_status hr2di_search_agree(hr2di_search *s, hr2d_status status) {
  hr2d_share *share = s->target.share;
  if (!share) return status;
  status = hr2di_share_agree(share, status);
  double said[] = {s->out_of_time, s->progress_status, -s->progress_status};
  hr2di_share_begin(share);
  const hr2d_status failed = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_MOST, said, 3);
  s->out_of_time = said[0] > 0;
  s->progress_status = (hr2d_status)(said[1] > 0 ? said[1] : -said[2]);
  return failed ? failed : status;
}

/* The larger error of B and H, in the norm of the target. */
static hr2d_error worst_of(const hr2di_error_pair *e, hr2d_norm norm) {
  const hr2d_error b = norm == HR2D_NORM_SUP ? e->sup : e->average;
  const hr2d_error h = norm == HR2D_NORM_SUP ? e->irradiance_sup : e->irradiance;
  return (hr2d_error){fmax(b.estimate, h.estimate), fmax(b.bound, h.bound)};
}

double hr2di_search_error(const hr2di_search *s) {
  return s->error.estimate;
}

int hr2di_search_reached(const hr2di_search *s, double error) {
  return hr2di_search_error(s) <= HR2DI_ERROR_MARGIN * error || s->error.bound <= error;
}

static void add_times(hr2d_account *sum, const hr2di_graded *answer) {
  sum->refine_seconds += answer->refine_seconds;
  sum->coefficients_seconds += answer->coefficients_seconds;
  sum->solve_seconds += answer->solve_seconds;
  sum->kernels += answer->kernels;
  sum->solves += answer->solution != NULL;
}

/* Notes the errors of the best one, and of those at points that they are not measured. */
static void note_errors(hr2di_search *s, const hr2di_error_pair *errors) {
  hr2d_account *a = &s->account;
  s->error = worst_of(errors, s->target.norm);
  s->cut_off = errors->cut_off[s->target.norm == HR2D_NORM_SUP];
  s->cut_off_patch = errors->cut_off_patch;
  s->cut_off_part = errors->cut_off_part;
  s->rounding = errors->rounding[s->target.norm == HR2D_NORM_SUP];
  const hr2d_error none = {NAN, NAN};
  a->average = errors->average;
  a->sup = s->given.points ? errors->sup : none;
  a->irradiance = errors->irradiance;
  a->irradiance_sup = s->given.points ? errors->irradiance_sup : none;
}

/* Keeps a graded solve, with its errors, as the best one.  Blocks of the finer operator are for
   what is divided next, and for an operator that is kept. */
static void keep(hr2di_search *s, hr2di_graded *answer, const hr2di_error_pair *errors) {
  hr2di_graded_clear(&s->best);
  s->best = *answer;
  if (!s->keeps_operator && !s->best.depth) hr2di_linkset_trim_blocks(s->best.links);
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

hr2d_status hr2di_search_fallback(hr2di_search *s) {
  hr2di_graded answer;
  int out_of_time;
  const double all = s->deadline > 0 ? s->given.seconds : HUGE_VAL;
  const size_t patches = s->scene->patches;
  if (hr2di_scene_has_gas(s->scene)) return HR2D_OK; /* it has exchange areas without gas */
  if (s->given.max_elements && s->given.max_elements < patches) return HR2D_OK;
  /* An element has B, H, the light from outside and that of a sweep. */
  const double min =
      (double)patches * (HR2DI_ELEMENT_BYTES + 4.0 * (double)s->scene->bands * sizeof(double));
  if (s->given.max_bytes && (double)s->given.max_bytes < min) return HR2D_OK;
  hr2d_status status = hr2di_fallback_solve(
      &answer, s->scene, &s->given,
      (hr2di_fallback_solve_times){s->start + HR2DI_CHOICE_FALLBACK_FACTORS * all,
                                   s->start + HR2DI_CHOICE_FALLBACK * all},
      &out_of_time);
  add_times(&s->account, &answer);
  if (!status) keep(s, &answer, &unknown);
  if (status && status != HR2D_ENOMEM) s->progress_status = status;
  hr2di_graded_clear(&answer);
  s->out_of_time = !status && out_of_time;
  return hr2di_search_agree(s, s->out_of_time ? HR2D_STOPPED : status);
}

/* The target with `max_bytes` less the bytes that the best solve so far holds. */
static hr2d_target rest_of_budget(const hr2di_search *s) {
  hr2d_target target = s->target;
  const hr2di_graded *best = &s->best;
  const uint64_t held = best->hierarchy && best->links
                            ? hr2di_graded_bytes(best) + hr2di_graded_solution_bytes(best)
                            : 0;
  if (target.max_bytes)
    target.max_bytes = held < target.max_bytes ? target.max_bytes - held : 1;
  return target;
}

hr2d_status hr2di_search_bound(hr2di_search *s) {
  hr2di_resolution fineness = s->fineness;
  hr2di_error_pair errors;
  if (!s->best.unbounded) return HR2D_OK;
  const double start = hr2di_clock_now();
  fineness.skip_bound = fineness.a_posteriori = 0;
  const hr2d_status status = hr2di_search_agree(
      s, hr2di_group_estimates(&s->best, &fineness, &s->target, &errors, &s->message));
  s->account.error_seconds += hr2di_clock_now() - start;
  if (!status) note_errors(s, &errors);
  return status;
}

/* Whether an attempt with this error replaces the best one.  A divided mesh may do so with a
   somewhat larger error, but not with a deadline: there may be no time for another attempt.
   Selected events show more of the error than whole patches, so that the estimate may rise. */
static int is_better(const hr2di_search *s, const hr2di_resolution *fineness, double error,
                     int divided) {
  const int shows_more =
      fineness->kinks > 0 && fineness->a_posteriori && !(s->fineness.kinks > 0);
  const double before = hr2di_search_error(s);
  const double max = divided && !(s->deadline > 0) ? HR2DI_CHOICE_VARIES * before : before;
  return !s->best.solution || !isfinite(before) || shows_more || error < max;
}

hr2d_status hr2di_search_attempt(hr2di_search *s, const hr2di_resolution *fineness,
                                 int dividing) {
  hr2di_graded answer;
  hr2di_error_pair errors;
  const hr2d_target target = rest_of_budget(s);
  hr2d_status status =
      dividing ? hr2di_graded_divide(&answer, &s->best, fineness, &target, &s->message)
               : hr2di_graded_refine(&answer, s->scene, fineness, &target, &s->message);
  if (!status) status = hr2di_graded_solve(&answer, fineness, &s->target, &s->message);
  add_times(&s->account, &answer);
  const double start = hr2di_clock_now();
  if (!status && !s->given.no_error) {
    status = hr2di_group_estimates(&answer, fineness, &s->target, &errors, &s->message);
    s->account.error_seconds += hr2di_clock_now() - start;
  }
  status = hr2di_search_agree(s, status);
  if (!status && s->given.no_error) {
    keep(s, &answer, &unknown);
    s->fineness = *fineness;
  } else if (!status) {
    const double error = worst_of(&errors, s->target.norm).estimate;
    if (is_better(s, fineness, error, dividing)) {
      keep(s, &answer, &errors);
      s->fineness = *fineness;
    }
  } else if (s->out_of_time && answer.solution && !isfinite(hr2di_search_error(s))) {
    keep(s, &answer, &unknown);
  }
  hr2di_graded_clear(&answer);
  return status;
}

int hr2di_search_is_rounding(const hr2di_search *s) {
  return hr2di_search_error(s) <= s->rounding;
}

int hr2di_search_is_cut_off(const hr2di_search *s, double error) {
  return s->cut_off > HR2DI_ERROR_MARGIN * error && hr2di_search_error(s) <= 4 * s->cut_off;
}
