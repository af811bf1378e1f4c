/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With ellipses of at least m about the elements and ρ* = m + √(m²−1), averages converge like
   ρ*^−2p, but no faster than e^−2.8p, which links between elements with children drop.
   Radiosity after a gather converges at a rate between ρ*^−2p and ρ*^−p.  Measured errors are
   below EASY times that, except in narrow corners (see below). */
#include "accuracy/strategy.h"

#include <math.h>

#include "base/choices.h"
#include "estimate/importance.h"
#include "geometry/bernstein-ellipse.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/external-irradiance.h"

#define EASY 0.06

static double digits_per_order(const hr2di_survey *survey, hr2d_norm norm) {
  const double m = survey->ellipse, rate = log(m + sqrt(m * m - 1));
  return norm == HR2D_NORM_SUP ? 1.4 * rate : fmin(2 * rate, 2.8);
}

/* What backs hide of a background is seen at points of rules, which kinks inside elements
   disturb: elements end at all events there. */
hr2d_status hr2di_strategy_survey(const hr2d_scene *scene, hr2di_beam_cache *beam_cache,
                                  unsigned threads, hr2di_watch *watch, hr2di_survey *survey) {
  const hr2di_grading grading = {
      .target = 0.1, .order = 2, .beam_cache = beam_cache, .watch = watch, .threads = threads};
  hr2d_hierarchy *h = NULL;
  if (scene->patches > HR2DI_CHOICE_WEIGHED_EVENTS && scene->effect[HR2D_EFFECT_OCCLUSION].on)
    return hr2di_grading_survey(scene, &grading, survey);
  hr2d_status status = hr2d_hierarchy_create(scene, &h);
  if (!status) status = hr2di_grading_apply(h, &grading, survey);
  hr2d_hierarchy_destroy(h);
  return status;
}

static int is_hidden(const hr2d_scene *scene) {
  return scene->effect[HR2D_EFFECT_OCCLUSION].called_for ||
         scene->effect[HR2D_EFFECT_FACING].called_for ||
         scene->effect[HR2D_EFFECT_BACKGROUND].called_for;
}

static int is_crowded(const hr2d_scene *scene, int hidden) {
  return hidden && scene->patches > HR2DI_CHOICE_MANY_EVENTS;
}

/* Indicators of a known error find the elements that matter sooner than lights and events do,
   and from fewer elements on, down to some target.  Few patches have few events, and a budget
   of seconds goes on to smaller targets. */
static int by_shares(const hr2d_scene *scene, const hr2d_target *target, double aim) {
  const int hidden = is_hidden(scene);
  if (!hidden || target->norm != HR2D_NORM_AVERAGE || target->no_error) return 0;
  if (is_crowded(scene, hidden)) return aim >= HR2DI_CHOICE_INDICATORS_ERROR;
  return aim >= HR2DI_CHOICE_INDICATORS_ERROR_SMALL && !(target->seconds > 0);
}

/* A kink of radiosity inside an element changes values at points more than averages. */
static unsigned generations_for(double aim, hr2d_norm norm) {
  if (norm == HR2D_NORM_AVERAGE) return hr2di_grading_generations(aim);
  return aim >= 0.05 ? 1 : aim >= 1e-4 ? 2 : aim >= 1e-7 ? 3 : 4;
}

int hr2di_strategy_wants_lights(const hr2d_scene *scene, const hr2d_target *target) {
  const size_t max = target->error < HR2DI_CHOICE_MANY_EVENTS_ERROR
                         ? HR2DI_CHOICE_WEIGHED_EVENTS_FINE
                         : HR2DI_CHOICE_WEIGHED_EVENTS;
  return target->norm == HR2D_NORM_AVERAGE && is_hidden(scene) && scene->patches <= max &&
         !scene->effect[HR2D_EFFECT_BACKGROUND].on && !(target->seconds > 0) &&
         !by_shares(scene, target, target->error);
}

/* Of a patch that gets little light past the ends of others, kinks on the patches that send it
   make much, and whole patches show nothing of that: few patches have few events to choose
   from. The first solve tells how dark patches are. */
int hr2di_strategy_wants_lights_of(const hr2d_solution *solution, const hr2d_target *target,
                                   const hr2di_resolution *fineness) {
  return fineness->a_posteriori && !fineness->many_patches &&
         !solution->hierarchy->scene->effect[HR2D_EFFECT_BACKGROUND].on &&
         hr2di_least_irradiance(solution, target) < HR2DI_CHOICE_DIM;
}

/* What shares of leaves may add up to.  They are without signs and of all n patches together.
   Of the error of one patch they are a part of about 1/n where light goes everywhere, and signs
   of as many leaves at least take about √n of that.  Few patches may be rooms in a row, where
   the light of the last comes by one door after the other. */
static double shares_for(const hr2d_scene *scene, double aim) {
  const double n = (double)scene->patches;
  return aim * (n > HR2DI_CHOICE_ROOMS ? 0.03 * n * sqrt(n) : 2);
}

/* The least 1 − ρ, or 1 − ρ − τ. */
static double min_lost(const hr2d_scene *scene) {
  double lost = 1;
  for (size_t k = 0; k < scene->patches; k++)
    for (size_t b = 0; b < scene->bands; b++)
      lost = fmin(lost, hr2di_scene_absorptance(scene, k, b));
  return lost;
}

/* What is left of the residual is off by so much of the target at most, as 1/(1 − ρ) of it is
   left of B, and B of the darkest patch counts as much as that of the brightest. */
double hr2di_strategy_tolerance(const hr2d_scene *scene, double contrast, double aim) {
  const double left = HR2DI_CHOICE_UNSOLVED * aim * contrast * min_lost(scene);
  return fmin(fmax(left, HR2D_DEFAULT_TOLERANCE), HR2DI_CHOICE_UNSOLVED);
}

/* What the background sends is a difference of row sums from 1: where little of it shows, that
   is all rounding. */
static int is_single(const hr2d_scene *scene, double target) {
  return !hr2di_external_wants_sky(scene) && !hr2di_scene_has_gas(scene) &&
         HR2DI_SINGLE_ROUNDING <= HR2DI_CHOICE_SINGLE * target * min_lost(scene);
}

/* A piece of the sky may show in a gap between two vertices, from a stretch of a patch that
   points of a rule miss: elements end where the gap opens, at any target. */
static unsigned generations_of_sky(const hr2d_scene *scene) {
  return hr2di_external_has_pieces(scene);
}

/* Most corners and near ends are those of patches that few others see: shares of a known error
   tell which ones matter.  For few digits they are few. */
static void leave_to_shares(hr2di_resolution *f) {
  f->no_corner_grading = 1;
  f->distance = hr2di_ellipse_for(f->aim, f->order);
}

/* In narrow corners with much reflection light is reflected to and fro often, and errors with
   it.  So the error must be smaller there by γ², from measurements at 10° to 150° and ρ up to
   0.999. */
hr2di_resolution hr2di_strategy_for(const hr2d_scene *scene, const hr2di_survey *survey,
                                    double aim, const hr2d_target *target,
                                    const hr2di_primal_dual *lights) {
  const hr2d_norm norm = target->norm;
  const int shared = by_shares(scene, target, aim);
  if (shared && is_crowded(scene, is_hidden(scene))) lights = NULL;
  const double many =
      is_crowded(scene, is_hidden(scene)) && lights ? HR2DI_CHOICE_MANY_PARTS : 1;
  const double error = aim * fmax(survey->exponent * survey->exponent, 1e-3);
  const double order = ceil(log(EASY / (many * error)) / digits_per_order(survey, norm));
  const int hidden = is_hidden(scene);
  const double min = aim < HR2DI_CHOICE_ORDER_3_ERROR || lights ? 3 : 2;
  hr2di_resolution f = {
      .aim = aim,
      .order = (unsigned)fmin(fmax(order, min), HR2D_MAX_ORDER - 2),
      .target = fmin(0.25 * error, 1),
      .cluster_accuracy = fmax(HR2DI_CHOICE_CLUSTERS * error, HR2DI_FINEST_CLUSTERS),
      .tolerance = lights ? hr2di_strategy_tolerance(scene, lights->contrast, aim) : 0,
      .norm = norm,
      .single = is_single(scene, target->error),
      .has_events = hidden,
      .distance = HR2DI_ELLIPSE_DISTANT,
      .kinks = lights ? shares_for(scene, aim) : 0,
      .lights = lights,
      .generations = hidden ? generations_for(aim, norm) : 0};
  if (shared || (is_crowded(scene, hidden) && aim >= HR2DI_CHOICE_MANY_EVENTS_ERROR)) {
    f.order = (unsigned)fmax(f.order, aim >= HR2DI_CHOICE_ORDER_3_ERROR ? 3
                                      : shared ? HR2DI_CHOICE_INDICATORS_ORDER
                                               : 4);
    f.generations = f.kinks > 0;
  }
  if (lights && aim <= HR2DI_CHOICE_ORDER_3_ERROR && f.generations == 0) f.generations = 1;
  f.many_patches = is_crowded(scene, hidden);
  if (!f.many_patches && f.generations == 0) f.generations = generations_of_sky(scene);
  f.a_posteriori = shared || (f.many_patches && norm == HR2D_NORM_AVERAGE);
  if (shared) leave_to_shares(&f);
  return f;
}

/* Doubles have no more digits than that; after an overflow the factor may be larger. */
#define MOST_FACTOR 1e16

/* Events inside elements make less.  If that has not been enough before, all of them count, of
   very many only after another time; returns 0 then, and 1 otherwise. */
static int raise_kinks(hr2di_resolution *f, double factor) {
  if (!(f->kinks > 0)) return 0;
  const unsigned max = f->many_patches ? 2 : 1;
  f->kinks = f->raises > max ? 0 : f->kinks / (ldexp(2, (int)f->raises) * factor);
  return f->kinks > 0;
}

int hr2di_strategy_raise(hr2di_resolution *f, const hr2di_survey *survey, double factor) {
  const double gamma = survey->exponent;
  const double slope = f->norm == HR2D_NORM_SUP ? fmax(gamma, 0.05) : 1 + 2 * gamma;
  if (f->order + 2 >= HR2D_MAX_ORDER) return -1;
  factor = fmin(factor, MOST_FACTOR);
  f->raises++;
  f->tolerance = fmax(f->tolerance / factor, HR2D_DEFAULT_TOLERANCE);
  f->relative /= factor;
  f->distance = HR2DI_ELLIPSE_DISTANT;
  f->no_corner_grading = 0;
  const double more = fmax(ceil(log(factor) / digits_per_order(survey, f->norm)), 1);
  f->cluster_accuracy = fmax(f->cluster_accuracy / factor, HR2DI_FINEST_CLUSTERS);
  f->order = (unsigned)fmin(f->order + more, HR2D_MAX_ORDER - 2);
  if (raise_kinks(f, factor)) {
    f->corner_levels += (unsigned)fmax(ceil(log2(factor) / slope), 1);
    return 0;
  }
  f->corner_levels += (unsigned)fmax(ceil(log2(factor) / slope), 1);
  if (f->has_events && f->generations < (f->norm == HR2D_NORM_SUP ? 4U : 2U)) f->generations++;
  return 0;
}

int hr2di_strategy_raise_clusters(hr2di_resolution *f, double part, double aim) {
  if (!(f->cluster_accuracy > HR2DI_FINEST_CLUSTERS)) return -1;
  const double factor = fmin(HR2DI_CHOICE_CLUSTERS_LEAVE * aim / part, 1);
  f->cluster_accuracy = fmax(f->cluster_accuracy * factor, HR2DI_FINEST_CLUSTERS);
  return 0;
}
