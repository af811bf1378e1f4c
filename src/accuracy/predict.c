/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Predicts the cost of a target: makes the elements and links, integrates a few blocks, times a
   few products, and computes the rest from counts. */
#include <hr2d/accuracy.h>
#include <math.h>
#include <stdint.h>

#include "accuracy/strategy.h"
#include "accuracy/target.h"
#include "base/alloc.h"
#include "base/choices.h"
#include "base/clock.h"
#include "base/team.h"
#include "blocks/block.h"
#include "estimate/corner-residuals.h"
#include "estimate/error-estimate.h"
#include "estimate/estimator.h"
#include "estimate/importance.h"
#include "scene/frozen-temperatures.h"
#include "solution/solution-impl.h"
#include "solve/gather-blocks.h"
#include "solve/heat-scene.h"

enum { SAMPLES = 8, RUN = 64, PRODUCTS = 64, RUNS = 5, POINTS = 4 };

enum { MORE = 2, MOST_BANDS = 4 };

#define SHORT 0.02

/* Seconds to make links and blocks, and of one gather: of the solve, of the finer operator, and
   of its part. */
typedef struct cost {
  double make, gather, finer, part;
} cost;

/* A coarse solve: its iterations, which hardly depend on the order, its time, for calls that
   have little to do, and the time of one gather at a point. */
typedef struct trial {
  double iterations, seconds, point;
  uint64_t leaves;
} trial;

/* The time for all blocks, from those of some runs of links, which share the looks of patches.
 */
static hr2d_status time_blocks(const hr2di_graded *a, size_t order, hr2di_watch *watch,
                               double *seconds) {
  const hr2d_allocator *alloc = &a->hierarchy->alloc;
  const uint64_t links = hr2d_linkset_size(a->links);
  const uint64_t runs = links < SAMPLES * RUN ? 1 : SAMPLES;
  const uint64_t length = links < SAMPLES * RUN ? links : RUN;
  double block[HR2D_MAX_ORDER * HR2D_MAX_ORDER];
  hr2di_integrator work;
  int distant;
  hr2d_status status = hr2di_integrator_init(&work, a->hierarchy, alloc, order, NULL, watch);
  const double start = hr2di_clock_now();
  for (uint64_t k = 0; k < runs * length && !status; k++) {
    const uint64_t first = (links - length) * (2 * (k / length) + 1) / (2 * runs);
    const hr2d_link *link = hr2di_store_at(&a->links->store, first + k % length);
    status = hr2di_block(&work, link->pair, link->exchange_area, block, &distant);
  }
  *seconds =
      links ? (hr2di_clock_now() - start) * ((double)links / (double)(runs * length)) : 0;
  hr2di_integrator_clear(&work);
  return status;
}

/* The time for one block's product, both ways, of MOST_BANDS at most. */
static double time_product(size_t order, size_t bands) {
  double block[HR2D_MAX_ORDER * HR2D_MAX_ORDER] = {0};
  double field[4][MOST_BANDS * HR2D_MAX_ORDER] = {{0}};
  double min = HUGE_VAL;
  for (int run = 0; run < 5; run++) {
    const double start = hr2di_clock_now();
    for (int k = 0; k < PRODUCTS; k++)
      hr2di_gather_both(block, order, bands, field[0], field[1], field[2], field[3]);
    min = fmin(min, hr2di_clock_now() - start);
  }
  return min / PRODUCTS;
}

/* A gather multiplies each block.  What push and pull, closure and the Krylov method do per
   element was measured to take four products, and closure to make about as much as distant
   blocks; such shares hardly depend on the machine. */
static double time_gather(const hr2di_graded *a, size_t order) {
  const size_t bands = a->hierarchy->scene->bands;
  const size_t timed = bands < MOST_BANDS ? bands : MOST_BANDS;
  const double products = (double)hr2d_linkset_size(a->links) +
                          1.5 * (double)hr2d_hierarchy_count(a->hierarchy).elements;
  return time_product(order, timed) * products * ((double)bands / (double)timed);
}

/* Blocks are made once, for the finer operator if there is an account. */
static hr2d_status measure(const hr2di_resolution *fineness, const hr2d_target *target,
                           hr2di_graded *a, cost *c, hr2d_prediction *p) {
  const hr2d_scene *scene = a->hierarchy->scene;
  const unsigned finer = hr2di_resolution_finer(fineness).order;
  const unsigned made = target->no_error ? fineness->order : finer;
  const hr2d_hierarchy_counts counts = hr2d_hierarchy_count(a->hierarchy);
  p->order = fineness->order;
  p->elements = counts.elements;
  p->leaves = counts.leaves;
  p->links = hr2d_linkset_size(a->links);
  p->bytes =
      hr2di_graded_bytes(a) + p->links * hr2di_graded_block_bytes(fineness, target->no_error);
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, target->progress, target->progress_ctx, "coefficients");
  const hr2d_status status = time_blocks(a, made, &watch, &c->make);
  c->make = c->make / (double)hr2di_team_threads(target->threads) + a->refine_seconds;
  c->gather = time_gather(a, fineness->order);
  if (target->no_error) return status;
  c->finer = time_gather(a, finer);
  c->part = time_gather(a, hr2di_estimator_part_order(finer));
  return status;
}

static hr2d_status time_points(const hr2d_solution *solution, size_t patches,
                               hr2di_watch *watch, trial *t) {
  double *value = hr2di_alloc(&solution->alloc, solution->bands, sizeof *value);
  const double end = 0, start = hr2di_clock_now();
  hr2d_status status = value ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = 0; k < POINTS && !status; k++)
    status = hr2di_solution_gather(solution, k * patches / POINTS, &end, 1, value, watch);
  t->point = (hr2di_clock_now() - start) / POINTS;
  hr2di_alloc_free(&solution->alloc, value);
  return status;
}

static hr2d_status try_coarse(const hr2d_scene *scene, const hr2d_target *target,
                              const hr2di_resolution *fineness, trial *t) {
  const double start = hr2di_clock_now();
  hr2di_graded a;
  hr2di_message message;
  const hr2di_resolution coarse = {
      .order = 2,
      .target = 0.1,
      .norm = target->norm,
      .no_corner_grading = fineness->no_corner_grading,
      .distance = fineness->no_corner_grading ? fineness->distance : 0,
      .tolerance = hr2di_strategy_tolerance(scene, target->floor, target->error)};
  hr2d_status status = hr2di_graded_refine(&a, scene, &coarse, target, &message);
  if (!status) status = hr2di_graded_solve(&a, &coarse, target, &message);
  t->seconds = hr2di_clock_now() - start;
  if (!status) {
    t->iterations = 2 + (double)hr2d_solution_work(a.solution).iterations;
    t->leaves = hr2d_hierarchy_count(a.hierarchy).leaves;
    hr2di_watch watch;
    hr2di_scene_watch(scene, &watch, target->progress, target->progress_ctx, "gather");
    status = time_points(a.solution, scene->patches, &watch, t);
  }
  hr2di_graded_clear(&a);
  return status;
}

/* The first solve reaches the target in nine of ten cases.  Otherwise up to
   HR2DI_CHOICE_ATTEMPTS solves follow, each of MORE coefficients more.  From one to the next
   measured times grow less than p. */
static void set_range(hr2d_prediction *p) {
  double solves = 0;
  for (unsigned k = 0; k < HR2DI_CHOICE_ATTEMPTS; k++)
    solves += fmin(p->order + MORE * k, HR2D_MAX_ORDER) / p->order;
  p->least_seconds = p->seconds / HR2DI_CHOICE_PREDICT_SURE;
  p->most_seconds = p->seconds * HR2DI_CHOICE_PREDICT_SURE * solves;
}

static hr2d_status predict(const hr2d_scene *scene, const hr2d_target *target,
                           hr2d_prediction *p) {
  const double aim = target->error > 0 ? target->error : 1e-13;
  hr2di_survey survey = {0};
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, target->progress, target->progress_ctx, "refine");
  hr2d_status status = HR2D_OK;
  hr2di_message message;
  hr2di_primal_dual lights = {0};
  if (hr2di_strategy_wants_lights(scene, target))
    status = hr2di_importance(scene, target, NULL, &lights, &survey, &message);
  if (!status && !(survey.ellipse > 0))
    status = hr2di_strategy_survey(scene, NULL, target->threads, &watch, &survey);
  const hr2di_resolution fineness =
      hr2di_strategy_for(scene, &survey, aim, target, lights.radiosity ? &lights : NULL);
  hr2di_graded a = {0};
  cost c = {0};
  trial coarse = {0};
  if (!status) status = try_coarse(scene, target, &fineness, &coarse);
  if (!status) status = hr2di_graded_refine(&a, scene, &fineness, target, &message);
  if (!status) status = measure(&fineness, target, &a, &c, p);
  if (!status) {
    const int reflects = scene->effect[HR2D_EFFECT_INTERREFLECTION].on;
    const double points = (double)hr2di_contacts_points(a.links) * coarse.point *
                          sqrt((double)p->leaves / (double)coarse.leaves);
    const double gathers = coarse.iterations * c.gather +
                           HR2DI_CHOICE_PREDICT_GATHERS * c.finer +
                           HR2DI_CHOICE_PREDICT_ITERATIONS * coarse.iterations * c.part;
    const double calls = !reflects                    ? HR2DI_CHOICE_PREDICT_DARK
                         : fineness.no_corner_grading ? HR2DI_CHOICE_PREDICT_FLAT
                         : lights.radiosity           ? HR2DI_CHOICE_PREDICT_LIT
                                                      : HR2DI_CHOICE_PREDICT_CALLS;
    p->seconds = calls * coarse.seconds + c.make +
                 (reflects ? HR2DI_CHOICE_PREDICT_REST * gathers : 0) +
                 (reflects && target->points && !target->no_error ? points : 0);
    set_range(p);
  }
  hr2di_graded_clear(&a);
  hr2di_primal_dual_clear(&lights, scene);
  return status;
}

/* Of a scene whose temperatures are not known: a solve with a guess of them, and one more. */
static hr2d_status predict_heat(const hr2d_scene *scene, const hr2d_target *target,
                                hr2d_prediction *prediction) {
  hr2d_scene *frozen;
  hr2d_target used;
  hr2d_status status = hr2di_target_init(&used, scene, target, HR2D_DEFAULT_ERROR);
  if (status) return status;
  status = hr2di_heat_scene_create(scene, NULL, used.progress, used.progress_ctx, &frozen);
  hr2di_target_clear(&used, &scene->alloc);
  if (status) return status;
  status = hr2d_predict(frozen, target, prediction);
  hr2di_relit_destroy(frozen);
  prediction->seconds *= HR2DI_CHOICE_PREDICT_HEAT;
  prediction->least_seconds *= HR2DI_CHOICE_PREDICT_HEAT;
  prediction->most_seconds *= HR2DI_CHOICE_PREDICT_HEAT;
  return status;
}

hr2d_status hr2d_predict(const hr2d_scene *scene, const hr2d_target *target,
                         hr2d_prediction *prediction) {
  if (!scene || !prediction) return HR2D_EINVAL;
  hr2d_target used;
  *prediction = (hr2d_prediction){0};
  if (!scene->committed) return HR2D_ESTATE;
  if (hr2di_scene_has_gas(scene)) return HR2D_EUNSUPPORTED;
  if (hr2di_scene_is_unsettled(scene)) return predict_heat(scene, target, prediction);
  hr2d_status status = hr2di_target_init(&used, scene, target, HR2D_DEFAULT_ERROR);
  used.share = NULL; /* each predicts for itself */
  if (status) return status;
  const double start = hr2di_clock_now();
  status = predict(scene, &used, prediction);
  /* Other work of the machine disturbs short times: take the least of several. */
  for (int run = 1; run < RUNS && !status && hr2di_clock_now() - start < SHORT; run++) {
    const hr2d_prediction former = *prediction;
    status = predict(scene, &used, prediction);
    if (!status && former.seconds < prediction->seconds) *prediction = former;
  }
  hr2di_target_clear(&used, &scene->alloc);
  return status;
}
