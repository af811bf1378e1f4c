/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each check of the extrapolation, see scene/symmetry.h, tells an amount δ of H on leaves. That
   is reflected as light is: of B it makes b = ρ(δ + Kb), and of H δ + Kb.  The larger of what
   both checks make is the estimate, average by average and point by point.  HR2DI_TAIL_BOUND
   times that is the bound.  With few images it is no more than what is extrapolated and what
   may be past the ends, which is from nothing to what is brightest: δ is that much, then, too.

   A gather at a point extrapolates the view of that point, which has checks of its own.  They
   are made at the ends and the middle of each leaf.  What is past the ends is known exactly
   there: H has nothing of it at least, and at most what is brightest from all of it. */
#include "estimate/period-residuals.h"

#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/row-tails.h"

enum { CHECKS = HR2DI_TAIL_CHECKS, PAST = HR2DI_GATHER_PAST, PLACES = 3 };

/* The relative accuracy of the solves for b, also where patches are dark. */
#define ENOUGH 1e-4

/* A leaf sees the background where it sees no patch: what extrapolation leaves of patches is
   missing from the background.  If it sees backs, their rest has that, and the background is
   off by what the series of the sky past the ends leaves, whose sign does not matter. */
static void take_sky(hr2di_estimator *e, int check, const double *off) {
  hr2di_equation *eq = &e->eq;
  hr2di_transport *t = &eq->transport;
  const hr2d_hierarchy *h = t->hierarchy;
  const unsigned char *sees = t->links->sees_backs;
  for (size_t k = 0; k < eq->field; k++) e->error[k] = hr2di_estimator_sky(e, k % t->width);
  hr2di_transport_check(t, check, e->error, eq->irradiance);
  for (size_t k = 0; k < eq->field; k++) {
    const size_t leaf = k / t->width;
    const uint32_t element = hr2di_image_map_of(&t->image_map, t->leaf[leaf]);
    if (sees && sees[h->element[element].patch])
      e->tail[k] += copysign(off[element] * hr2di_estimator_sky(e, k % t->width), e->tail[k]);
    else if (t->sky[leaf * t->order] != 0)
      e->tail[k] -= eq->irradiance[k];
  }
}

/* Sets e->tail to δ. */
static hr2d_status set_tail(hr2di_estimator *e, int check) {
  hr2di_transport *t = &e->eq.transport;
  const hr2d_hierarchy *h = t->hierarchy;
  hr2di_transport_check(t, check, e->kept, e->tail);
  if (!t->sky) return HR2D_OK;
  double *off = hr2di_alloc(&t->alloc, h->elements, sizeof *off);
  const hr2d_status status = off ? hr2di_row_tails_check(h, check, off, t->watch) : HR2D_ENOMEM;
  if (!status) take_sky(e, check, off);
  hr2di_alloc_free(&t->alloc, off);
  return status;
}

/* Sets e->tail to the most that may be missing of H: `room` has two numbers for each element.
 */
static hr2d_status set_max(hr2di_estimator *e, double *room) {
  hr2di_equation *eq = &e->eq;
  hr2di_transport *t = &eq->transport;
  const hr2d_hierarchy *h = t->hierarchy;
  double *const ends = room, *const sky = room + h->elements, *const unit = e->error;
  const hr2d_status status = hr2di_row_tails_seen(h, ends, sky, t->watch);
  if (status) return status;
  for (size_t k = 0; k < eq->field; k++) unit[k] = hr2di_estimator_sky(e, k % t->width);
  hr2di_transport_check(t, HR2DI_CHECK_ALL, unit, eq->irradiance);
  hr2di_transport_check(t, HR2DI_CHECK_ALL, e->kept, e->tail);
  for (size_t leaf = 0; leaf < t->leaves && !hr2di_estimator_stopped(e); leaf++)
    for (size_t b = 0; b < t->bands; b++) {
      const uint32_t element = hr2di_image_map_of(&t->image_map, t->leaf[leaf]);
      const double light = hr2di_estimator_sky(e, b),
                   shown = light * fabs(sky[element]) +
                           hr2di_estimator_max(e, eq->irradiance, leaf, b),
                   all = ends[element] * (fmax(e->largest[0][b], light) + light);
      const double max = hr2di_estimator_max(e, e->tail, leaf, b) + shown + all;
      for (size_t m = b; m < t->width; m += t->bands) e->tail[leaf * t->width + m] = 0;
      e->tail[leaf * t->width + b] = max;
    }
  return hr2di_transport_status(t);
}

/* What checks make of averages, and at points. */
typedef struct results {
  double *average;  /* per check, of B and of H, patches × bands; and at most */
  double *point;    /* per leaf and band, of the views of its points, */
  double *max;      /* and that at most; */
  double *indirect; /* per check, leaf and band: Kb; and at most */
  double *seen;     /* two per element */
  double *room;     /* for the points of a leaf */
} results;

/* Sets eq->irradiance to Kb, and adds it to δ; averages are those of b. */
static hr2d_status reflect(hr2di_estimator *e, double *average) {
  hr2di_equation *eq = &e->eq;
  for (size_t k = 0; k < eq->field; k++) eq->source[k] = e->tail[k];
  hr2di_equation_scatter(eq, eq->source);
  const hr2d_status status = hr2di_estimator_solve_part(e, ENOUGH, HR2DI_AIM_ERRORS);
  if (status) return status;
  for (size_t k = 0; k < eq->field; k++) e->error[k] = eq->radiosity[k];
  hr2di_equation_gather(eq, e->error);
  hr2di_estimator_averages(e, e->error, average);
  for (size_t k = 0; k < eq->field; k++) e->tail[k] += eq->irradiance[k];
  return HR2D_OK;
}

static void find_indirect(const hr2di_estimator *e, double *indirect) {
  const hr2di_transport *t = &e->eq.transport;
  for (size_t k = 0; k < t->leaves && !hr2di_estimator_stopped(e); k++)
    for (size_t b = 0; b < t->bands; b++)
      indirect[k * t->bands + b] = hr2di_estimator_max(e, e->eq.irradiance, k, b);
}

/* `check` may be HR2DI_CHECK_ALL. */
static hr2d_status run_check(hr2di_estimator *e, int check, const results *r) {
  const hr2di_transport *t = &e->eq.transport;
  const hr2d_scene *scene = t->hierarchy->scene;
  double *average = r->average + 2 * (size_t)check * e->values;
  hr2d_status status = check == HR2DI_CHECK_ALL ? set_max(e, r->seen) : set_tail(e, check);
  if (!status && scene->effect[HR2D_EFFECT_INTERREFLECTION].on) {
    status = reflect(e, average);
    if (!status && e->target->points)
      find_indirect(e, r->indirect + (size_t)check * t->leaves * t->bands);
  }
  if (!status) status = hr2di_transport_status(t);
  if (!status) hr2di_estimator_averages(e, e->tail, average + e->values);
  return status;
}

/* Nothing is known of the most. */
static void forget_max(const hr2di_estimator *e, const results *r) {
  const size_t rows = e->eq.transport.leaves * e->eq.transport.bands;
  for (size_t k = 0; k < 2 * e->values; k++)
    r->average[2 * HR2DI_CHECK_ALL * e->values + k] = HUGE_VAL;
  for (size_t k = 0; k < rows; k++) r->indirect[HR2DI_CHECK_ALL * rows + k] = HUGE_VAL;
}

/* The larger of what two checks make, which are `step` apart. */
static double larger(const double *check, size_t step) {
  return fmax(fabs(check[0]), fabs(check[step]));
}

static void note(hr2di_estimator *e, const results *r) {
  const hr2di_transport *t = &e->eq.transport;
  for (size_t k = 0; k < 2 * e->values; k++) {
    const double is = larger(r->average + k, 2 * e->values),
                 all = fabs(r->average[2 * HR2DI_CHECK_ALL * e->values + k]);
    e->past[k / e->values][k % e->values] = fmin(is, all);
    e->past_max[k / e->values][k % e->values] = fmin(HR2DI_TAIL_BOUND * is, all);
  }
  const size_t rows = t->leaves * t->bands;
  for (size_t k = 0; k < rows; k++) {
    const size_t b = k % t->bands;
    const double rho = hr2di_estimator_rho(e, k / t->bands, b),
                 indirect = larger(r->indirect + k, rows),
                 all = r->indirect[HR2DI_CHECK_ALL * rows + k],
                 is = r->point[k] + fmin(indirect, all),
                 max = r->max[k] + fmin(HR2DI_TAIL_BOUND * indirect, all);
    e->far[1][b] = fmax(e->far[1][b], is);
    e->far[0][b] = fmax(e->far[0][b], rho * is);
    e->far_max[1][b] = fmax(e->far_max[1][b], max);
    e->far_max[0][b] = fmax(e->far_max[0][b], rho * max);
  }
}

/* The least and the most that may be past the ends, as seen from a point. */
static void note_point(const hr2di_estimator *e, const results *r, size_t leaf,
                       const double *past, double ends) {
  const hr2di_equation *eq = &e->eq;
  const size_t bands = eq->transport.bands;
  for (size_t b = 0; b < bands; b++) {
    const double brightest = fmax(e->largest[0][b], hr2di_estimator_sky(e, b)) * ends,
                 is = ldexp(past[CHECKS * bands + b], -eq->exponent[b]),
                 off = ldexp(larger(past + b, bands), -eq->exponent[b]),
                 all = fmax(is, brightest - fmin(is, 0));
    double *const point = r->point + leaf * bands + b, *const max = r->max + leaf * bands + b;
    *point = fmax(*point, fmin(off, all));
    *max = fmax(*max, fmin(HR2DI_TAIL_BOUND * off, all));
  }
}

static hr2d_status view_from(const hr2di_estimator *e, const results *r, size_t leaf) {
  const hr2di_transport *t = &e->eq.transport;
  const hr2d_hierarchy *h = t->hierarchy;
  const hr2d_element *on = &h->element[t->leaf[leaf]];
  const double from = hr2di_element_start(h, t->leaf[leaf]),
               size = on->length / h->element[on->patch].length;
  const double at[PLACES] = {from, fmin(from + 0.5 * size, 1), fmin(from + size, 1)};
  double ends[PLACES];
  const hr2d_status status =
      hr2di_solution_gather_past(e->coarse, on->patch, at, PLACES, r->room, ends, t->watch);
  for (size_t k = 0; k < PLACES && !status; k++)
    note_point(e, r, leaf, r->room + k * PAST * t->bands, ends[k]);
  return status;
}

static hr2d_status view_from_leaves(const hr2di_estimator *e, const results *r) {
  const hr2di_transport *t = &e->eq.transport;
  const hr2d_scene *scene = t->hierarchy->scene;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < t->leaves && !status; k++) {
    const size_t patch = t->hierarchy->element[t->leaf[k]].patch;
    if (patch < hr2di_scene_cell(scene) && hr2di_scene_lit(scene, patch))
      status = view_from(e, r, k);
  }
  return status;
}

static hr2d_status reserve(const hr2di_estimator *e, results *r) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t rows = t->leaves * t->bands, averages = 2 * (CHECKS + 1) * e->values,
               points = PLACES * PAST * t->bands;
  r->average = hr2di_alloc_zero(
      &t->alloc, averages + (3 + CHECKS) * rows + points + 2 * t->elements, sizeof *r->average);
  if (!r->average) return HR2D_ENOMEM;
  r->point = r->average + averages;
  r->max = r->point + rows;
  r->indirect = r->max + rows;
  r->room = r->indirect + (CHECKS + 1) * rows;
  r->seen = r->room + points;
  return HR2D_OK;
}

hr2d_status hr2di_period_residuals(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  results r;
  if (!e->tail) return HR2D_OK;
  hr2d_status status = reserve(e, &r);
  if (!status && e->target->points) status = view_from_leaves(e, &r);
  const int few = t->hierarchy->scene->symmetry.copies <= HR2DI_FEW_COPIES;
  for (int check = 0; check < CHECKS + few && !status; check++)
    status = run_check(e, check, &r);
  if (!status && !few) forget_max(e, &r);
  if (!status) note(e, &r);
  for (size_t k = 0; k < eq->field; k++) e->error[k] = eq->irradiance[k] = 0;
  hr2di_alloc_free(&t->alloc, r.average);
  return status ? status : hr2di_watch_status(t->watch);
}
