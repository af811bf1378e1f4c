/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves to a target: guesses a resolution, solves, estimates the error, and raises the
   resolution while the error is above the target. */
#include "accuracy/solve-to.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "accuracy/search.h"
#include "accuracy/target.h"
#include "base/alloc.h"
#include "base/choices.h"
#include "base/clock.h"
#include "estimate/importance.h"
#include "links/linkset-impl.h"
#include "mesh/row-partition.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"

static void give_reason(hr2di_search *s, const char *reason) {
  hr2di_message_copy(s->account.reason, sizeof s->account.reason, reason);
}

static hr2di_resolution guess_resolution(hr2di_search *s, double error) {
  hr2di_resolution guess = hr2di_strategy_for(s->scene, &s->survey, error, &s->given,
                                              s->lights.radiosity ? &s->lights : NULL);
  guess.beam_cache = hr2di_search_beam_cache(s);
  guess.skip_bound = !(s->given.seconds > 0); /* there is time for a bound at the end */
  /* Under a background of their own temperature scenes are isothermal to all digits. */
  if (!guess.lights && !s->given.no_error && !s->scene->effect[HR2D_EFFECT_BACKGROUND].on) {
    guess.tolerance = hr2di_strategy_tolerance(s->scene, s->given.floor, error);
    guess.relative = hr2di_strategy_tolerance(s->scene, 1, error);
    guess.floor = s->given.floor;
  }
  return guess;
}

/* The resolution to begin with: no coarser than the best one so far, which was not enough. */
static hr2di_resolution first_resolution(hr2di_search *s, double error) {
  const hr2di_resolution guess = guess_resolution(s, error);
  hr2di_resolution finer = s->fineness;
  const int known = s->best.solution && isfinite(hr2di_search_error(s));
  const int is_finer =
      known &&
      !hr2di_strategy_raise(&finer, &s->best.survey, hr2di_search_error(s) / (0.5 * error)) &&
      finer.order > guess.order;
  if (!is_finer) return guess;
  finer.aim = error;
  if (finer.generations < guess.generations) finer.generations = guess.generations;
  return finer;
}

/* Finer elements do not help where the error is what links of clusters lack. */
static int raise_clusters(const hr2di_search *s, hr2di_resolution *fineness, double error) {
  return s->best.clustered > 0.5 * hr2di_search_error(s) &&
         !hr2di_strategy_raise_clusters(fineness, s->best.clustered, error);
}

/* More cells are what helps: so the images reach as many times as far.  The name of the patch
   is last, where it may be cut. */
static void give_cut_off(hr2di_search *s) {
  const hr2di_symmetry *by = &s->scene->symmetry;
  char text[sizeof s->account.reason + sizeof(hr2di_label)];
  snprintf(text, sizeof text,
           "draw 4 or more cells as one period: beyond %u images up to %.1e of a view, %.1e of "
           "the largest value, may be missing at %s",
           by->copies, by->rest, s->cut_off_part,
           hr2di_patch_label(s->scene, s->cut_off_patch).text);
  give_reason(s, text);
}

/* Lights after the first solve.  The survey that they bring is not needed: corners are left to
   indicators. */
static hr2d_status find_lights(hr2di_search *s) {
  hr2di_survey survey = s->survey;
  return hr2di_search_agree(s,
                            hr2di_importance(s->scene, &s->target, hr2di_search_beam_cache(s),
                                             &s->lights, &survey, &s->message));
}

/* Whether selected events are to show what whole patches hide; an operator is for any light. */
static int wants_lights(const hr2di_search *s, const hr2di_resolution *fineness) {
  return !s->lights.radiosity && !s->keeps_operator && !s->given.no_error && s->best.solution &&
         hr2di_strategy_wants_lights_of(s->best.solution, &s->given, fineness);
}

/* Goes finer until the error is below `error`; HR2D_EACCURACY if it does not come down. */
static hr2d_status reach(hr2di_search *s, double error) {
  if (s->best.solution && hr2di_search_reached(s, error)) return HR2D_OK;
  hr2di_resolution fineness = first_resolution(s, error);
  double before = HUGE_VAL;
  int stuck = 0, raised = 1, dividing = 0;
  for (int k = 0;
       k < HR2DI_CHOICE_ATTEMPTS && (stuck < 2 || !hr2di_search_is_rounding(s)) && raised;
       k++) {
    const hr2d_status status = hr2di_search_attempt(s, &fineness, dividing);
    /* At a low order rows of K may exceed 1 in narrow corners, even with closure. */
    if (status == HR2D_ENOT_CONVERGED && !s->progress_status && k + 1 < HR2DI_CHOICE_ATTEMPTS &&
        fineness.order < HR2DI_CHOICE_SAFE_ORDER) {
      fineness.order++;
      continue;
    }
    if (k == 0 && !status && wants_lights(s, &fineness)) {
      const hr2d_status found = find_lights(s);
      if (found) return found;
      if (s->lights.radiosity) {
        fineness = guess_resolution(s, error);
        continue;
      }
    }
    if (status || s->given.no_error || hr2di_search_reached(s, error)) return status;
    if (hr2di_search_is_cut_off(s, error)) break;
    stuck = hr2di_search_error(s) > 0.5 * before ? stuck + 1 : 0;
    before = hr2di_search_error(s);
    const hr2d_status bounded = stuck > 0 ? hr2di_search_bound(s) : HR2D_OK;
    if (bounded) return bounded;
    dividing = s->best.depth != NULL; /* at a higher order, if that was no use before */
    raised = raise_clusters(s, &fineness, error) || (dividing && !stuck) ||
             !hr2di_strategy_raise(&fineness, &s->best.survey, before / (0.5 * error));
  }
  const hr2d_status bounded = hr2di_search_bound(s);
  if (bounded || hr2di_search_reached(s, error)) return bounded;
  if (hr2di_search_is_cut_off(s, error))
    give_cut_off(s);
  else
    give_reason(s,
                stuck > 0 && hr2di_search_is_rounding(s)
                    ? "finer elements bring the error down no further"
                : hr2di_search_error(s) <= error
                    ? "the error is estimated below the target, but not below half of it, and "
                      "comes down too slowly"
                    : "the error comes down too slowly: the finest elements that are tried do "
                      "not suffice");
  return HR2D_EACCURACY;
}

static int is_budget(hr2d_status status) {
  return status == HR2D_EMAX_ELEMENTS || status == HR2D_EMAX_LINKS || status == HR2D_EMAX_BYTES;
}

/* Reaches falling targets one by one, while the time seems to suffice for the next and no
   budget is spent. */
static hr2d_status reach_step_by_step(hr2di_search *s) {
  hr2d_status status = HR2D_OK;
  for (double error = 1e-1; !status; error *= 1e-2) {
    const double aim = fmax(error, s->given.error), start = hr2di_clock_now();
    status = reach(s, aim);
    if (status || hr2di_search_reached(s, s->given.error) || aim <= s->given.error) break;
    s->out_of_time = 1.2 * (hr2di_clock_now() - start) >
                     hr2di_search_left(s); /* a finer one takes longer still */
    status = hr2di_search_agree(s, HR2D_OK);
    if (s->out_of_time) break;
  }
  return !status && s->out_of_time ? HR2D_STOPPED : status;
}

/* The status of the whole search, with a reason if the target was not reached.  A spent budget
   is HR2D_EACCURACY, with a solution or without one; HR2D_OK if there is a solution of known
   error, or of one that nobody asked for, and the target error is 0. */
static hr2d_status settle(hr2di_search *s, hr2d_status status) {
  const int is_known = s->given.no_error ? s->best.solution && s->best.hierarchy->order > 1
                                         : isfinite(hr2di_search_error(s));
  if (s->progress_status) {
    give_reason(s, "stopped by the callback");
    return s->progress_status;
  }
  const int is_spent = is_budget(status) || (status == HR2D_STOPPED && s->out_of_time);
  if (status == HR2D_STOPPED && s->out_of_time)
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

/* What is known of the scene before the first attempt.  The elements for the lights of patches
   are a survey, too; without these lights elements end at all events.  For an operator the
   lights tell what matters to whom, but not what is bright. */
static hr2d_status survey(hr2di_search *s) {
  hr2di_watch watch;
  hr2d_status status = HR2D_OK;
  if (hr2di_strategy_wants_lights(s->scene, &s->given))
    status = hr2di_importance(s->scene, &s->target, hr2di_search_beam_cache(s), &s->lights,
                              &s->survey, &s->message);
  s->lights.any_light = s->keeps_operator;
  if (status || s->survey.ellipse > 0) return status;
  hr2di_scene_watch(s->scene, &watch, s->target.progress, s->target.progress_ctx, "refine");
  return hr2di_strategy_survey(s->scene, hr2di_search_beam_cache(s), s->given.threads, &watch,
                               &s->survey);
}

/* Hands the best solution over; it owns its hierarchy and its links from then on. */
static void hand_over(hr2di_search *s, hr2d_solution **solution) {
  *solution = s->best.solution;
  if (!*solution) return;
  hr2d_linkset *links = s->best.links;
  if (s->best.depth) hr2di_linkset_trim_blocks(links);
  (*solution)->own_hierarchy = s->best.hierarchy;
  (*solution)->own_links = s->best.links;
  hr2di_alloc_free(&s->scene->alloc, s->best.unresolved_jump);
  hr2di_alloc_free(&s->scene->alloc, s->best.depth);
  hr2di_row_pieces_clear(&s->best.pieces, &s->scene->alloc);
  s->best = (hr2di_graded){0};
}

/* The search itself: with a time step by step, else at once, or as far as a budget goes. */
static hr2d_status find(hr2di_search *s) {
  hr2d_status status = HR2D_OK;
  if (s->deadline > 0) status = hr2di_search_fallback(s);
  if (!status) status = hr2di_search_agree(s, survey(s));
  if (status) return status;
  if (s->deadline > 0) return reach_step_by_step(s);
  status = reach(s, s->given.error > 0 ? s->given.error : 1e-15);
  if (is_budget(status) && !s->progress_status) status = reach_step_by_step(s);
  if (!is_budget(status) || s->best.solution) return status;
  const hr2d_status fallen_back = hr2di_search_fallback(s);
  return fallen_back ? fallen_back : status;
}

/* From the first attempt to the status of the whole search, with the account of the best. */
static hr2d_status run(hr2di_search *s) {
  hr2d_status status = find(s);
  if (!s->progress_status && status != HR2D_ENOMEM) {
    const hr2d_status bounded = hr2di_search_bound(s);
    if (bounded) status = bounded;
  }
  status = settle(s, status);
  s->account.seconds = hr2di_clock_now() - s->start;
  return status;
}

/* Whether the best one is handed over. */
static int is_answer(const hr2di_search *s, hr2d_status status) {
  return !s->progress_status && (!status || status == HR2D_EACCURACY);
}

hr2d_status hr2di_solve_to(const hr2d_scene *scene, const hr2d_target *target,
                           hr2d_solution **solution, hr2d_account *account) {
  hr2di_search s;
  hr2d_status status = hr2di_search_init(&s, scene, target);
  if (!status) {
    status = run(&s);
    if (is_answer(&s, status)) hand_over(&s, solution);
    if (account) *account = s.account;
  }
  hr2di_search_clear(&s);
  return status;
}

hr2d_status hr2di_solve_for_operator(const hr2d_scene *scene, const hr2d_target *target,
                                     hr2di_graded *best, hr2di_resolution *fineness,
                                     hr2d_account *account) {
  hr2di_search s;
  hr2d_status status = hr2di_search_init(&s, scene, target);
  s.keeps_operator = 1;
  if (!status) {
    status = run(&s);
    *account = s.account;
  }
  if (is_answer(&s, status) && s.best.solution &&
      s.best.hierarchy->order == s.fineness.order) { /* not a fallback */
    *best = s.best;
    *fineness = s.fineness;
    fineness->lights = NULL; /* of the search, as the cache is */
    fineness->beam_cache = NULL;
    s.best = (hr2di_graded){0};
  }
  hr2di_search_clear(&s);
  return status;
}
