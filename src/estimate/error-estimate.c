/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The estimate is the largest error that the series of residuals gives.  The bound is MARGIN
   times the estimate, a part of the errors without signs, and what roundings may be. */
#include "estimate/error-estimate.h"

#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "estimate/cluster-residuals.h"
#include "estimate/error-indicators.h"
#include "estimate/estimator.h"
#include "estimate/gap-residuals.h"
#include "estimate/importance.h"
#include "estimate/period-residuals.h"
#include "estimate/residual-series.h"
#include "estimate/resolution.h"
#include "estimate/rounding-bound.h"
#include "estimate/shadow-residuals.h"
#include "estimate/unsigned-error.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"

/* Estimates were 0.5 to 4.3 times the errors, over rooms, corners, gaps and short patches. */
#define MARGIN 2.5
/* Where views change, coefficients p and p + 1 of a kink inside an element show 1 − (p/(p+2))³
   of its effect, and visibility events leave kinks of later generations: in one of 7,000 random
   runs, 6.1 times as much was hidden. */
#define MARGIN_OF_VIEWS 7
/* Points are sampled, and coefficients show less of B than of averages. */
#define POINTS 3
/* The part of the errors without signs that may be left where signs cancel: what K⁺ does not
   see of them, which was 0.107 at order 2 and falls with the order. */
#define SIGNS     0.1
#define SIGNS_LOW 0.4

/* What errors count: those that coefficients show, those of a period that is cut off, and at
   most, those of points beside gaps, and roundings. */
typedef struct factors {
  double error, past, past_max, narrow, rounding;
} factors;

/* The largest error of an average of B or H, relative to the average as corrected by it, or to
   the floor; with roundings relative to the least that the average may be. */
static double find_worst(const hr2di_estimator *e, int irradiance, factors f, size_t *patch) {
  const size_t bands = e->eq.transport.bands, patches = e->values / bands;
  double worst = 0;
  for (size_t b = 0; b < bands; b++) {
    const double floor = e->floor[(size_t)irradiance * bands + b];
    for (size_t k = 0; k < patches; k++) {
      if (!hr2di_is_important(e->target, k)) continue;
      const size_t at = k * bands + b;
      const double error = e->average[irradiance][at],
                   is = hr2di_estimator_value(e, irradiance, k, b);
      const double past = e->tail ? f.past * e->past[irradiance][at] : 0;
      const double upper = e->tail ? f.past_max * e->past_max[irradiance][at] : 0;
      const double more = f.rounding > 0 ? f.rounding * fabs(e->rounding[irradiance][at]) : 0;
      const double sum = fmax(f.error * fabs(error), past) + more + upper;
      const double lower = f.rounding > 0 ? is - sum : is + error;
      if (!(sum > 0) || !(sum / fmax(lower, floor) > worst)) continue;
      worst = sum / fmax(lower, floor);
      *patch = k;
    }
  }
  return worst;
}

static double worst_average(const hr2di_estimator *e, int irradiance, factors f) {
  size_t patch;
  return find_worst(e, irradiance, f, &patch);
}

/* The largest error at a point, relative to the largest value of the band: what coefficients
   show or what gaps make, and the rest. */
static double worst_point(const hr2di_estimator *e, int irradiance, factors f) {
  double worst = 0;
  for (size_t b = 0; b < e->eq.transport.bands; b++) {
    const double error =
        fmax(f.error * e->point[irradiance][b], f.narrow * e->narrow[irradiance][b]);
    const double past = e->tail ? f.past * e->far[irradiance][b] : 0;
    const double upper = e->tail ? f.past_max * e->far_max[irradiance][b] : 0;
    const double sum = fmax(error, past) + f.rounding * e->stray[irradiance][b] + upper;
    if (sum > 0) worst = fmax(worst, sum / e->largest[irradiance][b]);
  }
  return worst;
}

/* What images that are cut off may make of averages: where most, and how much. */
static void note_cut_off(const hr2di_estimator *e, int irradiance, hr2di_error_pair *errors) {
  const factors past = {.past = 1};
  const size_t bands = e->eq.transport.bands;
  size_t patch = 0;
  const double worst = find_worst(e, irradiance, past, &patch);
  errors->cut_off[1] = fmax(errors->cut_off[1], worst_point(e, irradiance, past));
  if (!(worst > errors->cut_off[0])) return;
  errors->cut_off[0] = worst;
  errors->cut_off_patch = patch;
  errors->cut_off_part = 0;
  for (size_t b = 0; b < bands; b++)
    errors->cut_off_part = fmax(errors->cut_off_part, e->past[irradiance][patch * bands + b] /
                                                          e->largest[irradiance][b]);
}

static double largest_of(const hr2di_estimator *e, const double *of, int irradiance) {
  const size_t bands = e->eq.transport.bands;
  double max = 0;
  for (size_t b = 0; b < bands; b++) max = fmax(max, of[(size_t)irradiance * bands + b]);
  return max;
}

static double signless(const hr2di_estimator *e, int irradiance) {
  return fmax(SIGNS, SIGNS_LOW / (double)e->coarse->order) * largest_of(e, e->safe, irradiance);
}

/* What chance may have taken from errors of averages that are `seen`: with other signs they are
   of the size of the scatter. */
static double by_chance(const hr2di_estimator *e, double seen, double part, int irradiance) {
  return hypot(seen, part * largest_of(e, e->scatter, irradiance)) - seen;
}

/* The part of the scatter that an estimate has at least. */
#define SCATTER 0.1

/* Elements are made for an aim.  What events that are left inside them make of it, coefficients
   of p and p + 1 may not show, by chance: hill climbing over panels and slits reached 0.9 of
   the aim.  An estimate may be ten times too low. */
#define BLIND        1.
#define BLIND_LIKELY 0.1

static hr2d_error bounded(double estimate, double bound) {
  return (hr2d_error){estimate, fmax(estimate, bound)};
}

static int reflects_light(const hr2di_estimator *e) {
  return e->eq.transport.hierarchy->scene->effect[HR2D_EFFECT_INTERREFLECTION].on;
}

/* Estimates of averages, which are off by no less than `doubt`. */
static void estimate_averages(const hr2di_estimator *e, hr2di_error_pair *errors) {
  const double unknown = HUGE_VAL, of_h = reflects_light(e) ? e->level_uncertainty : 0;
  const factors all = {.error = 1, .past = 1};
  for (int h = 0; h < 2 && e->tail; h++) note_cut_off(e, h, errors);
  errors->average = (hr2d_error){fmax(worst_average(e, 0, all), e->level_uncertainty), unknown};
  errors->irradiance = (hr2d_error){fmax(worst_average(e, 1, all), of_h), unknown};
  errors->sup = errors->irradiance_sup = (hr2d_error){unknown, unknown};
}

static hr2d_status measure_averages(hr2di_estimator *e, hr2di_error_pair *errors) {
  hr2di_residual_set(e);
  hr2d_status status = hr2di_period_residuals(e);
  if (!status && reflects_light(e)) status = hr2di_residual_solve(e);
  if (!status) status = hr2di_residual_measure(e);
  if (!status) status = hr2di_transport_status(&e->eq.transport);
  if (!status) estimate_averages(e, errors);
  return status;
}

/* Bounds, and errors at points. */
static hr2d_status measure_rest(hr2di_estimator *e, hr2di_error_pair *errors) {
  hr2di_equation *eq = &e->eq;
  const int reflects = reflects_light(e);
  hr2d_status status = HR2D_OK;
  if (e->target->points) status = hr2di_shadow_residuals(e);
  if (!status && e->target->points) status = hr2di_gap_residuals(e);
  if (!status && reflects) status = hr2di_unsigned_error(e);
  if (status) return status;
  status = hr2di_rounding_bound(e, reflects);
  if (status) return status;
  const double level = eq->balance.count > 0 ? hr2di_estimator_rounding(e) : 0;
  for (int h = 0; h < 2; h++) {
    const factors off = {.rounding = 1};
    const double average_off = worst_average(e, h, off) + level;
    errors->rounding[0] = fmax(errors->rounding[0], fmax(average_off, e->level_uncertainty));
    errors->rounding[1] =
        fmax(errors->rounding[1], fmax(worst_point(e, h, off) + level, e->level_uncertainty));
  }
  hr2d_error *const average[] = {&errors->average, &errors->irradiance};
  hr2d_error *const sup[] = {&errors->sup, &errors->irradiance_sup};
  for (int h = 0; h < 2; h++) {
    const double blind = h == 1 || reflects ? e->blind : 0; /* without light B is E */
    const double doubt = h == 0 || reflects ? e->level_uncertainty : 0;
    const factors all = {.error = 1, .past = 1, .narrow = 1},
                  average_max = {.error = e->margin, .past_max = 1, .rounding = 1},
                  upper = {.error = fmax(e->margin, POINTS),
                           .past_max = 1,
                           .narrow = POINTS,
                           .rounding = 1};
    const double seen = average[h]->estimate, likely = seen + by_chance(e, seen, SCATTER, h);
    *average[h] =
        bounded(hypot(likely, BLIND_LIKELY * blind),
                worst_average(e, h, average_max) + e->margin * by_chance(e, seen, 1, h) +
                    signless(e, h) + level + BLIND * blind);
    if (!e->target->points) continue;
    *sup[h] = bounded(hypot(fmax(worst_point(e, h, all), doubt), BLIND_LIKELY * blind),
                      worst_point(e, h, upper) + level + BLIND * blind);
  }
  return hr2di_transport_status(&eq->transport);
}

static double margin_of(const hr2di_resolution *f) {
  const double ratio = (double)f->order / (f->order + HR2DI_FINER_ORDERS);
  if (!f->has_events) return MARGIN;
  return MARGIN_OF_VIEWS / (1 - ratio * ratio * ratio);
}

static double worst_of(const hr2di_error_pair *errors) {
  return fmax(errors->average.estimate, errors->irradiance.estimate);
}

/* Whether the error is more than half of what it should be. */
static int is_too_large(const hr2di_error_pair *errors, const hr2di_resolution *fineness) {
  const double worst = worst_of(errors);
  return worst > HR2DI_ERROR_MARGIN * fineness->aim && isfinite(worst);
}

/* Tells what to divide if the error, the worst of which is seen, is not half of what it should
   be. */
static hr2d_status find_shares(hr2di_estimator *e, hr2di_graded *answer,
                               const hr2di_resolution *fineness, double worst) {
  const hr2d_allocator *alloc = &answer->hierarchy->alloc;
  answer->depth = hr2di_alloc_zero(alloc, answer->hierarchy->elements, sizeof *answer->depth);
  if (!answer->depth) return HR2D_ENOMEM;
  hr2d_share *share = answer->links->share;
  const hr2d_status status =
      hr2di_share_agree(share, hr2di_error_indicators(e, fineness->aim, worst, answer->depth));
  if (!status) return HR2D_OK;
  if (status != HR2D_ENOMEM) hr2di_share_begin(share);
  hr2di_alloc_free(alloc, answer->depth);
  answer->depth = NULL;
  return status == HR2D_ENOMEM ? status : HR2D_OK; /* the errors are known */
}

hr2d_status hr2di_finer_init(hr2di_finer *f, const hr2di_graded *answer,
                             const hr2di_resolution *fineness, const hr2d_target *target) {
  const hr2di_resolution finer = hr2di_resolution_finer(fineness);
  *f = (hr2di_finer){.roots = answer->links->roots};
  const hr2di_equation_how how = {.order = finer.order,
                                  .single = finer.single,
                                  .roots = &f->roots,
                                  .beam_cache = finer.beam_cache};
  hr2d_status status = HR2D_OK;
  f->roots.clusters = NULL;
  if (answer->links->roots.clusters) {
    f->roots.accuracy = finer.cluster_accuracy;
    status = hr2di_clusters_finer(answer->links->roots.clusters, f->roots.accuracy,
                                  &f->roots.clusters);
  }
  if (status) return status;
  f->is_made = 1;
  status = hr2di_estimator_init(&f->estimator, answer, &how, target);
  f->estimator.margin = margin_of(fineness);
  f->estimator.blind = fineness->has_events ? fineness->aim : 0;
  return status;
}

void hr2di_finer_clear(hr2di_finer *f) {
  if (f->is_made) hr2di_estimator_clear(&f->estimator);
  hr2di_clusters_destroy(f->roots.clusters);
}

hr2d_status hr2di_finer_measure(hr2di_finer *f, const hr2d_solution *solution,
                                hr2di_error_pair *errors) {
  *errors = (hr2di_error_pair){0};
  hr2d_status status = hr2di_estimator_take(&f->estimator, solution);
  if (!status) status = measure_averages(&f->estimator, errors);
  return status ? status : measure_rest(&f->estimator, errors);
}

/* What is too large gets no bound, or is told what to divide. */
static hr2d_status run(hr2di_finer *f, hr2di_graded *answer, const hr2di_resolution *fineness,
                       hr2di_error_pair *errors) {
  hr2di_estimator *e = &f->estimator;
  hr2di_clusters *coarser = answer->links->roots.clusters;
  hr2d_status status = hr2di_estimator_take(e, answer->solution);
  if (!status) status = measure_averages(e, errors);
  const int shares =
      fineness->a_posteriori && !(fineness->many_patches && answer->unresolved_jump);
  const double seen = status ? 0 : worst_of(errors);
  answer->unbounded =
      !status && shares && fineness->skip_bound && is_too_large(errors, fineness);
  if (!status && !answer->unbounded) status = measure_rest(e, errors);
  const int too_large = !status && is_too_large(errors, fineness), shared = too_large && shares;
  if (!status && coarser && too_large)
    status = hr2di_cluster_residuals(e, coarser, &answer->clustered);
  if (!status && shared) status = find_shares(e, answer, fineness, seen);
  return status;
}

hr2d_status hr2di_error_estimate(hr2di_graded *answer, const hr2di_resolution *fineness,
                                 const hr2d_target *target, hr2di_error_pair *errors,
                                 hr2di_message *message) {
  hr2di_finer finer;
  *errors = (hr2di_error_pair){0};
  hr2d_status status = hr2di_finer_init(&finer, answer, fineness, target);
  if (!status) status = run(&finer, answer, fineness, errors);
  hr2di_finer_clear(&finer);
  if (!status) return status;
  const char *own = hr2d_linkset_message(answer->links);
  return hr2di_message_fail(message, status, "%s", own[0] ? own : hr2d_strerror(status));
}
