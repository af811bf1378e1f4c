/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes operators, and solves with them. */
#include <math.h>
#include <string.h>

#include "accuracy/solve-to.h"
#include "accuracy/target.h"
#include "base/alloc.h"
#include "base/clock.h"
#include "base/sized-struct.h"
#include "operator/operator-impl.h"
#include "scene/frozen-temperatures.h"
#include "solution/solution-impl.h"
#include "solve/solve-how.h"

static void release(void *kept) {
  hr2di_kept_trees *k = kept;
  if (!k || atomic_fetch_sub(&k->users, 1) > 1) return;
  hr2d_linkset_destroy(k->links);
  hr2d_hierarchy_destroy(k->hierarchy);
  hr2di_relit_destroy(k->relit);
  const hr2d_allocator alloc = k->alloc;
  hr2di_alloc_free(&alloc, k);
}

void hr2d_operator_destroy(hr2d_operator *op) {
  if (!op) return;
  const hr2d_allocator alloc = op->alloc;
  hr2di_operator_clear_equations(op);
  hr2di_alloc_free(&alloc, op->graded.unresolved_jump);
  hr2di_alloc_free(&alloc, op->graded.depth);
  hr2di_target_clear(&op->target, &alloc); /* the scene may be gone */
  release(op->kept);
  hr2di_alloc_free(&alloc, op);
}

const char *hr2d_operator_message(const hr2d_operator *op) {
  return op ? op->message.text : "";
}

hr2d_status hr2di_operator_enter(hr2d_operator *op) {
  if (op->busy) return HR2D_ESTATE;
  op->busy = 1;
  op->message.text[0] = op->kept->links->message.text[0] = '\0';
  return HR2D_OK;
}

hr2d_status hr2di_operator_end(hr2d_operator *op, hr2d_status status) {
  op->busy = 0;
  if (!status || op->message.text[0]) return status;
  const char *own = hr2d_linkset_message(op->kept->links);
  return hr2di_message_fail(&op->message, status, "%s", *own ? own : hr2d_strerror(status));
}

/* Trees and links of an answer, which are the operator's from now on. */
static hr2d_status keep(hr2d_operator *op, hr2di_graded *best, const hr2d_account *account) {
  op->kept->hierarchy = best->hierarchy;
  op->kept->links = best->links;
  hr2d_solution_destroy(best->solution);
  best->solution = NULL;
  op->graded = *best;
  op->base = (hr2d_account){.order = account->order,
                            .elements = account->elements,
                            .leaves = account->leaves,
                            .links = account->links,
                            .events = account->events,
                            .bytes = account->bytes,
                            .solves = 1};
  hr2di_message_copy(op->base.reason, sizeof op->base.reason, account->reason);
  op->enough =
      (hr2di_stopping_test){.part = op->fineness.relative, .floor = op->fineness.floor};
  op->count = 1;
  return hr2di_operator_make_equation(op);
}

static hr2d_status refuse(const hr2d_scene *scene, const hr2d_target *target) {
  if (!scene->committed) return HR2D_ESTATE;
  if (hr2di_scene_is_unsettled(scene) || hr2di_scene_has_gas(scene)) return HR2D_EUNSUPPORTED;
  if (target->share && target->share->count > 1) return HR2D_EUNSUPPORTED;
  return HR2D_OK;
}

static hr2d_status prepare(hr2d_operator *op, const hr2d_scene *scene,
                           const hr2d_target *target) {
  hr2d_status status = hr2di_target_init(&op->target, scene, target, HR2D_DEFAULT_ERROR);
  if (!status) status = refuse(scene, &op->target);
  if (op->target.progress == scene->progress && op->target.progress_ctx == scene->progress_ctx)
    op->target.progress = NULL; /* the scene may change its mind */
  op->kept = hr2di_alloc_zero(&scene->alloc, 1, sizeof *op->kept);
  if (!op->kept) return HR2D_ENOMEM;
  op->kept->alloc = scene->alloc;
  atomic_init(&op->kept->users, 1);
  return status ? status : hr2di_relit_create(scene, 1, &op->kept->relit);
}

hr2d_status hr2d_operator_create(const hr2d_scene *scene, const hr2d_target *target,
                                 hr2d_operator **op, hr2d_account *account) {
  if (op) *op = NULL;
  if (!scene || !op) return HR2D_EINVAL;
  hr2d_account found = {0};
  hr2d_operator *made = hr2di_alloc_zero(&scene->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  made->scene = scene;
  made->alloc = scene->alloc;
  hr2di_graded best = {0};
  hr2d_target alone = HR2D_TARGET_INIT;
  hr2d_status status = prepare(made, scene, target);
  if (!status) status = hr2di_sized_copy(&alone, sizeof alone, target);
  alone.share = NULL;
  if (!status)
    status =
        hr2di_solve_for_operator(made->kept->relit, &alone, &best, &made->fineness, &found);
  const hr2d_status reached = status;
  if (best.solution) status = keep(made, &best, &found);
  if (!made->kept || !made->kept->links)
    found.average = found.sup = found.irradiance = found.irradiance_sup =
        (hr2d_error){HUGE_VAL, HUGE_VAL};
  if (reached == HR2D_EUNSUPPORTED)
    hr2di_message_copy(
        found.reason, sizeof found.reason,
        "an operator finds no temperatures of given fluxes in several bands, does not go "
        "through gas, and is not shared");
  if (account) *account = found;
  if (status || !made->kept->links)
    hr2d_operator_destroy(made);
  else
    *op = made;
  return status ? status : reached;
}

/* Whether the larger error of B and H, in the norm of the target, is as small as that says. */
static int is_reached(const hr2d_target *target, const hr2di_error_pair *e) {
  const int sup = target->norm == HR2D_NORM_SUP;
  const hr2d_error *b = sup ? &e->sup : &e->average;
  const hr2d_error *h = sup ? &e->irradiance_sup : &e->irradiance;
  return !(target->error > 0) ||
         fmax(b->estimate, h->estimate) <= HR2DI_ERROR_MARGIN * target->error ||
         fmax(b->bound, h->bound) <= target->error;
}

static const hr2d_error unknown = {HUGE_VAL, HUGE_VAL};

/* The finer operator, which the first account makes. */
static hr2d_status need_finer(hr2d_operator *op) {
  if (op->has_finer) {
    hr2di_operator_watch(op, &op->finer.estimator.eq);
    op->finer.estimator.part.transport.failed = HR2D_OK;
    return HR2D_OK;
  }
  const hr2d_status status =
      hr2di_finer_init(&op->finer, &op->graded, &op->fineness, &op->target);
  op->has_finer = !status;
  if (status) hr2di_finer_clear(&op->finer);
  return status;
}

/* The errors of a solution for the light that the relit scene has.  The exponent of corners is
   known for the reflectances of the scene; for other ones that counts which shows least. */
static hr2d_status measure(hr2d_operator *op, const hr2d_solution *solution, int reflects,
                           hr2d_account *account) {
  const double start = hr2di_clock_now();
  hr2di_error_pair e;
  hr2d_status status = need_finer(op);
  op->finer.estimator.exponent = reflects ? 0 : op->graded.survey.exponent;
  if (!status) status = hr2di_finer_measure(&op->finer, solution, &e);
  account->error_seconds = hr2di_clock_now() - start;
  if (status) return status;
  account->average = e.average;
  account->irradiance = e.irradiance;
  if (op->target.points) {
    account->sup = e.sup;
    account->irradiance_sup = e.irradiance_sup;
  }
  if (is_reached(&op->target, &e)) return HR2D_OK;
  hr2di_message_copy(account->reason, sizeof account->reason,
                     op->base.reason[0]
                         ? op->base.reason
                         : "the elements were made for other light and do not suffice for this "
                           "one: make an operator of a scene with such light");
  return HR2D_EACCURACY;
}

/* The solution gets the light for its own, and a use of the trees. */
static hr2d_status own(hr2d_operator *op, hr2d_solution *solution) {
  const hr2d_status status =
      hr2di_relit_create(op->kept->relit, op->count, &solution->own_scene);
  if (status) return status;
  atomic_fetch_add(&op->kept->users, 1);
  solution->kept = op->kept;
  solution->release = release;
  return HR2D_OK;
}

static hr2d_status check_start(hr2d_operator *op, const hr2d_solution *start,
                               const hr2d_light *light) {
  if (!start) return HR2D_OK;
  if (start->kept != op->kept)
    return hr2di_message_fail(&op->message, HR2D_EINVAL,
                              "the start is no solution of this operator");
  if (start->bands != op->scene->bands * light->count)
    return hr2di_message_fail(&op->message, HR2D_EINVAL,
                              "the start has another number of lights");
  return HR2D_OK;
}

static hr2d_status solve(hr2d_operator *op, const hr2d_light *light, const hr2d_solution *start,
                         hr2d_solution **solution, hr2d_account *account) {
  const double begin = hr2di_clock_now();
  hr2d_status status = check_start(op, start, light);
  if (!status) status = hr2di_operator_relight(op, light);
  if (!status) status = hr2di_operator_begin(op);
  op->eq.enough = op->enough;
  if (!status) status = hr2di_solve_again(&op->eq, start, solution);
  if (!status) status = own(op, *solution);
  account->solve_seconds = hr2di_clock_now() - begin;
  if (!status && !light->no_error && !op->target.no_error)
    status = measure(op, *solution, light->reflectance.value != NULL, account);
  account->seconds = hr2di_clock_now() - begin;
  return status;
}

hr2d_status hr2d_operator_solve(hr2d_operator *op, const hr2d_light *given,
                                const hr2d_solution *start, hr2d_solution **solution,
                                hr2d_account *account) {
  if (solution) *solution = NULL;
  if (!op || !solution) return HR2D_EINVAL;
  hr2d_light light;
  hr2d_solution *made = NULL;
  hr2d_status status = hr2di_operator_enter(op);
  if (status) return status;
  hr2d_account found = op->base;
  found.reason[0] = '\0';
  found.average = found.irradiance = unknown;
  found.sup = found.irradiance_sup = op->target.points ? unknown : (hr2d_error){NAN, NAN};
  status = hr2di_operator_light_of(op, given, &light);
  if (!status) status = solve(op, &light, start, &made, &found);
  if (!status || status == HR2D_EACCURACY) {
    *solution = made;
    if (account) *account = found;
    op->busy = 0;
    return status;
  }
  hr2d_solution_destroy(made);
  return hr2di_operator_end(op, status);
}
