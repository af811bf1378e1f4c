/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "estimate/estimator.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "estimate/importance.h"
#include "scene/panes.h"
#include "solution/solution-impl.h"

double hr2di_estimator_rounding(const hr2di_estimator *e) {
  return HR2DI_ESTIMATOR_ROUNDING + (e->eq.transport.blocks.single ? HR2DI_SINGLE_ROUNDING : 0);
}

int hr2di_estimator_stopped(const hr2di_estimator *e) {
  return e->eq.transport.failed || hr2di_watch_status(e->eq.transport.watch);
}

double hr2di_estimator_max(const hr2di_estimator *e, const double *field, size_t leaf,
                           size_t band) {
  const hr2di_transport *t = &e->eq.transport;
  const double *at = field + leaf * t->width + band;
  hr2di_watch_work(t->watch, 1 + e->rule.points * t->order / 32);
  double max = fmax(fabs(hr2di_basis_sum(&e->basis, -1, at, t->bands)),
                    fabs(hr2di_basis_sum(&e->basis, 1, at, t->bands)));
  for (size_t q = 0; q < e->rule.points; q++)
    max = fmax(max, fabs(hr2di_basis_sum(&e->basis, e->rule.at[q], at, t->bands)));
  return max;
}

double hr2di_estimator_rho(const hr2di_estimator *e, size_t leaf, size_t band) {
  const hr2di_transport *t = &e->eq.transport;
  return hr2di_pane_scattered(t->hierarchy->scene, t->hierarchy->element[t->leaf[leaf]].patch,
                              band);
}

void hr2di_estimator_off(hr2di_estimator *e, double *const point[2], size_t patch, size_t band,
                         double error) {
  const hr2d_scene *scene = e->eq.transport.hierarchy->scene;
  const size_t own = hr2di_scene_original(scene, patch),
               other = hr2di_scene_original(scene, hr2di_scene_other_side(scene, patch));
  const int important = hr2di_is_important(e->target, own);
  if (important) point[1][band] = fmax(point[1][band], error);
  if (important || hr2di_is_important(e->target, other))
    point[0][band] = fmax(point[0][band], hr2di_pane_scattered(scene, patch, band) * error);
}

double hr2di_estimator_sky(const hr2di_estimator *e, size_t m) {
  const hr2di_transport *t = &e->eq.transport;
  return m < t->bands ? ldexp(hr2di_sky_max(t->hierarchy->scene, m), -e->eq.exponent[m]) : 0;
}

void hr2di_estimator_averages(hr2di_estimator *e, const double *field, double *average) {
  hr2di_transport *t = &e->eq.transport;
  hr2di_transport_pull(t, field);
  for (size_t k = 0; k < t->hierarchy->scene->patches; k++)
    for (size_t b = 0; b < t->bands; b++) average[k * t->bands + b] = t->up[k * t->width + b];
}

void hr2di_estimator_lift(const hr2di_estimator *e, double *upper) {
  const hr2di_transport *t = &e->eq.transport;
  const hr2d_element *element = t->hierarchy->element;
  for (size_t k = t->elements; k-- > 0;)
    for (size_t b = 0; b < t->bands && element[k].child; b++) {
      const double *child = upper + element[k].child * t->bands + b;
      upper[k * t->bands + b] = fmax(child[0], child[t->bands]);
    }
}

void hr2di_estimator_set_max(hr2di_estimator *e, const double *field) {
  const hr2di_transport *t = &e->eq.transport;
  for (size_t k = 0; k < t->leaves && !hr2di_estimator_stopped(e); k++)
    for (size_t b = 0; b < t->bands; b++)
      e->max[t->leaf[k] * t->bands + b] = hr2di_estimator_max(e, field, k, b);
  hr2di_estimator_lift(e, e->max);
}

static void scale(const hr2di_estimator *e, const hr2di_equation *eq, double *field, int sign) {
  for (size_t k = 0; k < eq->field; k++)
    field[k] = ldexp(field[k], sign * e->exponent_of[k % eq->transport.bands]);
}

/* Solves with the source of each band scaled to about 1, by a power of two: squares of the
   unknowns would underflow where the error is tiny. */
static hr2d_status solve(hr2di_estimator *e, hr2di_equation *eq, double tolerance) {
  const size_t bands = eq->transport.bands;
  for (size_t k = 0; k < eq->field; k++) eq->y[k] = 0;
  for (size_t b = 0; b < bands; b++) {
    double max = 0;
    for (size_t k = b; k < eq->field; k += bands) max = fmax(max, fabs(eq->source[k]));
    e->exponent_of[b] = max > 0 ? ilogb(max) : 0;
  }
  scale(e, eq, eq->source, -1);
  eq->options.tolerance = tolerance;
  const hr2d_status status = hr2di_equation_solve(eq);
  scale(e, eq, eq->source, 1);
  scale(e, eq, eq->radiosity, 1);
  scale(e, eq, eq->irradiance, 1);
  return status;
}

hr2d_status hr2di_estimator_solve(hr2di_estimator *e, double tolerance) {
  hr2di_equation *eq = &e->eq, *part = &e->part;
  if (e->whole) return solve(e, eq, tolerance);
  hr2di_equation_part_take(part, eq, eq->source, part->source);
  const hr2d_status status = solve(e, part, tolerance);
  if (status == HR2D_ENOT_CONVERGED) {
    e->whole = 1;
    return solve(e, eq, tolerance);
  }
  for (size_t k = 0; k < eq->field; k++) {
    eq->radiosity[k] = eq->source[k];
    eq->irradiance[k] = 0;
  }
  hr2di_equation_part_give(part, eq, part->radiosity, eq->radiosity);
  hr2di_equation_part_give(part, eq, part->irradiance, eq->irradiance);
  return status;
}

/* An average of the solution, in the unit of the equation, where nothing is denormal. */
double hr2di_estimator_value(const hr2di_estimator *e, int irradiance, size_t patch,
                             size_t band) {
  const double value = irradiance ? hr2d_solution_irradiance(e->coarse, patch, band)
                                  : hr2d_solution_average(e->coarse, patch, band);
  return fabs(ldexp(value, -e->eq.exponent[band]));
}

double hr2di_estimator_min(const hr2di_estimator *e, int irradiance, size_t patch,
                           size_t band) {
  return fmax(hr2di_estimator_value(e, irradiance, patch, band),
              e->floor[(size_t)irradiance * e->eq.transport.bands + band]);
}

/* The least of min least/max least over the bands. */
static double contrast(const hr2di_estimator *e, int irradiance) {
  const size_t bands = e->eq.transport.bands, patches = e->values / bands;
  double ratio = 1;
  for (size_t b = 0; b < bands; b++) {
    double min = HUGE_VAL, max = 0;
    for (size_t k = 0; k < patches; k++) {
      const double lower = hr2di_estimator_min(e, irradiance, k, b);
      if (lower > 0 && hr2di_is_important(e->target, k)) min = fmin(min, lower);
      max = fmax(max, lower);
    }
    if (max > 0) ratio = fmin(ratio, min / max);
  }
  return ratio;
}

/* Light that goes to and fro makes the error of a solve some times its residual. */
#define TO_AND_FRO 0.25

hr2d_status hr2di_estimator_solve_part(hr2di_estimator *e, double part,
                                       hr2di_estimator_aim aim) {
  const double dark = fmin(contrast(e, 0), contrast(e, 1));
  e->eq.enough = e->part.enough =
      (hr2di_stopping_test){.part = TO_AND_FRO * part, .weight = e->weight, .summed = aim};
  const hr2d_status status = hr2di_estimator_solve(e, fmax(part * dark, 1e-14));
  e->eq.enough = e->part.enough = (hr2di_stopping_test){0};
  return status;
}

/* Of B and of H, whichever error is larger; ρ of the one of H is in B. */
static void set_weights(hr2di_estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  for (size_t leaf = 0; leaf < t->leaves; leaf++)
    for (size_t b = 0; b < t->bands; b++) {
      const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
      const double rho = hr2di_estimator_rho(e, leaf, b);
      const double lower =
          fmin(hr2di_estimator_min(e, 0, patch, b), rho * hr2di_estimator_min(e, 1, patch, b));
      e->weight[leaf * t->bands + b] = lower > 0 ? 1 / lower : 0;
    }
}

double hr2di_estimator_largest(const hr2di_estimator *e, int irradiance, size_t band) {
  double max = 0;
  for (size_t k = 0; k < e->values / e->eq.transport.bands; k++)
    max = fmax(max, hr2di_estimator_value(e, irradiance, k, band));
  return max;
}

static void set_floors(hr2di_estimator *e) {
  const size_t bands = e->eq.transport.bands;
  for (int h = 0; h < 2; h++)
    for (size_t b = 0; b < bands; b++)
      e->floor[(size_t)h * bands + b] = e->target->floor * hr2di_estimator_largest(e, h, b);
}

/* Work space for all fields. */
static hr2d_status reserve(hr2di_estimator *e, const hr2d_allocator *alloc) {
  const hr2di_transport *t = &e->eq.transport;
  const int cuts = hr2di_symmetry_cuts(&t->hierarchy->scene->symmetry);
  const size_t field = e->eq.field, rows = t->leaves * t->bands;
  e->values = t->hierarchy->scene->patches * t->bands;
  e->room = 4 * field + 4 * e->values + 2 * t->elements * t->bands + 4 * rows + 14 * t->bands +
            (cuts ? field + 4 * e->values + 4 * t->bands : 0);
  e->space = hr2di_alloc(alloc, e->room, sizeof *e->space);
  e->exponent_of = hr2di_alloc(alloc, t->bands, sizeof *e->exponent_of);
  if (!e->space || !e->exponent_of) return HR2D_ENOMEM;
  double *next = e->space;
  double **const fields[] = {&e->kept, &e->rest, &e->error, &e->residual};
  for (int k = 0; k < 4; k++, next += field) *fields[k] = next;
  for (int h = 0; h < 2; h++, next += 2 * e->values) {
    e->average[h] = next;
    e->rounding[h] = next + e->values;
  }
  e->max = next;
  e->own = next + t->elements * t->bands;
  e->off[0] = e->own + t->elements * t->bands;
  e->off[1] = e->off[0] + rows;
  e->level = e->off[1] + rows;
  next = e->level + rows;
  for (int h = 0; h < 2; h++, next += 4 * t->bands) {
    e->largest[h] = next;
    e->point[h] = next + t->bands;
    e->narrow[h] = e->point[h] + t->bands;
    e->stray[h] = e->narrow[h] + t->bands;
  }
  e->floor = next;
  e->safe = next + 2 * t->bands;
  e->scatter = next + 4 * t->bands;
  e->weight = next + 6 * t->bands;
  if (!cuts) return HR2D_OK;
  e->tail = e->weight + rows;
  next = e->tail + field;
  for (int h = 0; h < 2; h++, next += 2 * (e->values + t->bands)) {
    e->past[h] = next;
    e->past_max[h] = next + e->values;
    e->far[h] = e->past_max[h] + e->values;
    e->far_max[h] = e->far[h] + t->bands;
  }
  return HR2D_OK;
}

hr2d_status hr2di_estimator_init(hr2di_estimator *e, const hr2di_graded *answer,
                                 const hr2di_equation_how *how, const hr2d_target *target) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.threads = target->threads;
  options.progress = target->progress;
  options.progress_ctx = target->progress_ctx;
  *e = (hr2di_estimator){.target = target,
                         .unresolved_jump = answer->unresolved_jump,
                         .jump_bands = answer->jump_bands,
                         .exponent = answer->survey.exponent,
                         .contacts.alloc = answer->links->alloc};
  hr2d_status status = hr2di_equation_init(&e->eq, answer->links,
                                           answer->links->hierarchy->scene, how, &options);
  if (!status) status = reserve(e, &answer->links->alloc);
  if (!status)
    status = hr2di_equation_part(&e->part, &e->eq,
                                 hr2di_estimator_part_order(e->eq.transport.order));
  if (status) return status;
  hr2di_basis_init(&e->basis, e->eq.transport.order);
  hr2di_rule_init(&e->rule, e->eq.transport.order + 2);
  return HR2D_OK;
}

hr2d_status hr2di_estimator_take(hr2di_estimator *e, const hr2d_solution *solution) {
  const int again = e->coarse != NULL;
  hr2d_status status = again ? hr2di_equation_set_light(&e->eq) : HR2D_OK;
  if (!status && again) status = hr2di_equation_set_surfaces(&e->part);
  e->coarse = solution;
  e->whole = 0;
  memset(e->space, 0, e->room * sizeof *e->space);
  hr2di_contacts_clear(&e->contacts);
  set_floors(e);
  set_weights(e);
  return status;
}

void hr2di_estimator_clear(hr2di_estimator *e) {
  hr2di_contacts_clear(&e->contacts);
  hr2di_alloc_free(&e->contacts.alloc, e->space);
  hr2di_alloc_free(&e->contacts.alloc, e->exponent_of);
  hr2di_equation_part_clear(&e->part);
  hr2di_equation_clear(&e->eq);
}
