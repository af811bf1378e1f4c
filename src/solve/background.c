/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The form factor of the background: 1 less the row sum, less the form factor of backs. */
#include "solve/background.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/legendre.h"
#include "base/team.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "visibility/back-visibility.h"
#include "visibility/periodic-tail.h"
#include "visibility/point-view.h"

/* A form factor up to this cannot be told from rounding. */
#define NONE 1e-14

hr2d_status hr2di_background_set(hr2di_transport *t, const hr2di_row_sums *rows) {
  t->sky = hr2di_alloc(&t->alloc, t->leaves, sizeof *t->sky);
  if (!t->sky) return HR2D_ENOMEM;
  for (size_t k = 0; k < t->leaves; k++) {
    const uint32_t leaf = t->leaf[k];
    t->sky[k] = fmax(0, 1 - rows->front[leaf] - rows->back[leaf]);
  }
  return HR2D_OK;
}

enum { BATCH = 16 /* the leaves of a task */ };

/* The work space of a thread. */
typedef struct observer {
  hr2di_point_viewer *viewer;
  hr2di_watch own; /* but the calling thread has that of the transport */
  hr2d_status status;
} observer;

typedef struct observers {
  hr2di_transport *t;
  const unsigned char *sees; /* per patch: whether it may see a back */
  hr2di_basis basis;
  hr2di_rule rule;
  observer *observer;
  size_t threads;
  atomic_int failed;
} observers;

/* Subtracts the backs that a leaf sees.  The leaf begins at fraction `from` of its patch and
   has `size` of its length. */
static hr2d_status take_backs(const observers *all, hr2di_point_viewer *viewer, size_t leaf,
                              double from, double size) {
  hr2di_transport *t = all->t;
  const hr2d_scene *scene = t->hierarchy->scene;
  const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
  double *sky = t->sky + leaf * t->order, phi[HR2D_MAX_ORDER];
  for (size_t q = 0; q < all->rule.points; q++) {
    hr2di_view_from seen;
    const double at = from + size * (0.5 + 0.5 * all->rule.at[q]);
    const hr2d_status status = hr2di_view_at(viewer, patch, at, &seen);
    if (status) return status;
    hr2di_periodic_tail tail;
    hr2di_periodic_tail_of(scene, patch, at, &seen, &tail);
    const double back = seen.back + tail.back;
    hr2di_basis_at(&all->basis, all->rule.at[q], phi);
    for (size_t k = 0; k < t->order; k++) sky[k] -= all->rule.weight[q] * back * phi[k];
  }
  return HR2D_OK;
}

/* Each leaf has its own coefficients, so that no bit depends on threads. */
static void take_some_backs(void *ctx, size_t worker, size_t task) {
  observers *all = ctx;
  observer *l = &all->observer[worker];
  const hr2di_transport *t = all->t;
  const hr2d_hierarchy *h = t->hierarchy;
  for (size_t k = task * BATCH; k < t->leaves && k < (task + 1) * BATCH; k++) {
    const hr2d_element *e = &h->element[t->leaf[k]];
    if (l->status || atomic_load(&all->failed)) return;
    if (e->patch < hr2di_scene_cell(h->scene) && all->sees[e->patch] &&
        hr2di_scene_lit(h->scene, e->patch) &&
        hr2di_share_has_row(t->links->share, e->patch, hr2di_scene_cell(h->scene)))
      l->status = take_backs(all, l->viewer, k, hr2di_element_start(h, t->leaf[k]),
                             e->length / h->element[e->patch].length);
    if (l->status) atomic_store(&all->failed, 1);
  }
}

static hr2d_status take_all_backs(hr2di_transport *t, const unsigned char *sees) {
  const size_t upper = 1 + t->leaves / HR2DI_CHOICE_TEAM_LEAVES,
               threads = hr2di_team_threads(t->threads);
  observers all = {.t = t, .sees = sees, .threads = threads < upper ? threads : upper};
  hr2di_basis_init(&all.basis, t->order);
  hr2di_rule_init(&all.rule, t->order + 6);
  all.observer = hr2di_alloc_zero(&t->alloc, all.threads, sizeof *all.observer);
  if (!all.observer) return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < all.threads && !status; k++) {
    observer *l = &all.observer[k];
    hr2di_watch_follow(&l->own, t->watch);
    status = hr2di_point_viewer_create(t->hierarchy->scene, &t->alloc,
                                       k == 0 ? t->watch : &l->own, &l->viewer);
  }
  if (!status)
    hr2di_team_run(all.threads, (t->leaves + BATCH - 1) / BATCH, take_some_backs, &all,
                   t->watch);
  for (size_t k = 0; k < all.threads; k++) {
    if (!status) status = all.observer[k].status;
    hr2di_point_viewer_destroy(all.observer[k].viewer);
  }
  hr2di_alloc_free(&t->alloc, all.observer);
  return status ? status : hr2di_watch_status(t->watch);
}

/* What arrives if everything radiates 1: by K, or by what its extrapolation leaves.  NULL: out
   of memory. */
static double *irradiance_of_one(hr2di_transport *t,
                                 void (*apply)(hr2di_transport *, const double *, double *)) {
  const size_t field = t->leaves * t->order;
  double *unit = hr2di_alloc_zero(&t->alloc, field, sizeof *unit);
  double *arrives = unit ? hr2di_alloc(&t->alloc, field, sizeof *arrives) : NULL;
  if (arrives) {
    for (size_t k = 0; k < t->leaves; k++) unit[k * t->order] = 1;
    apply(t, unit, arrives);
  }
  hr2di_alloc_free(&t->alloc, unit);
  return arrives;
}

/* Sets t->sky to 1 − K1 on patches that light reaches. */
static hr2d_status take_rows(hr2di_transport *t) {
  double *row = irradiance_of_one(t, hr2di_transport_apply);
  if (!row) return HR2D_ENOMEM;
  for (size_t k = 0; k < t->leaves && !t->failed; k++) {
    const int lit =
        hr2di_scene_lit(t->hierarchy->scene, t->hierarchy->element[t->leaf[k]].patch);
    for (size_t l = 0; l < t->order && lit; l++)
      t->sky[k * t->order + l] = (l == 0) - row[k * t->order + l];
  }
  hr2di_alloc_free(&t->alloc, row);
  return t->failed ? t->failed : hr2di_watch_work(t->watch, t->leaves / 4);
}

/* Each share has looked from the leaves of its rows. */
static hr2d_status combine_rows(hr2di_transport *t, hr2d_status status) {
  const hr2d_hierarchy *h = t->hierarchy;
  for (size_t k = 0; k < t->leaves && !status; k++)
    if (!hr2di_share_has_row(t->links->share, h->element[t->leaf[k]].patch,
                             hr2di_scene_cell(h->scene)))
      memset(t->sky + k * t->order, 0, t->order * sizeof *t->sky);
  return hr2di_share_combine(t->links->share, status, HR2D_COMBINE_SUM, t->sky,
                             t->leaves * t->order);
}

/* The largest |coefficient| of the background's form factor on a leaf. */
static double largest(const hr2di_transport *t, size_t leaf) {
  double max = 0;
  for (size_t l = 0; l < t->order; l++) max = fmax(max, fabs(t->sky[leaf * t->order + l]));
  return max;
}

/* A patch that sees patches in every direction does not see the background, whatever the blocks
   of its leaves lack.  On other patches this stays, also where it is below 0: an isothermal
   scene is isothermal then. */
static void clear_closed(hr2di_transport *t) {
  for (size_t k = 0; k < t->leaves; k++)
    if (t->closed[t->hierarchy->element[t->leaf[k]].patch] || largest(t, k) <= NONE)
      memset(t->sky + k * t->order, 0, t->order * sizeof *t->sky);
}

static void last_check(hr2di_transport *t, const double *radiosity, double *irradiance) {
  hr2di_transport_check(t, HR2DI_CHECK_LAST, radiosity, irradiance);
}

static void part_check(hr2di_transport *t, const double *radiosity, double *irradiance) {
  hr2di_transport_check(t, HR2DI_CHECK_PART, radiosity, irradiance);
}

/* Whether the sky shows from a point of the rule on a leaf. */
static hr2d_status sees_sky(const hr2di_transport *t, hr2di_point_viewer *viewer, size_t leaf,
                            const hr2di_rule *rule, int *sees) {
  const hr2d_hierarchy *h = t->hierarchy;
  const hr2d_element *e = &h->element[t->leaf[leaf]];
  const double from = hr2di_element_start(h, t->leaf[leaf]),
               size = e->length / h->element[e->patch].length;
  hr2d_status status = HR2D_OK;
  *sees = 0;
  for (size_t q = 0; q < rule->points && !*sees && !status; q++) {
    hr2di_view_from seen;
    double sum = 0;
    status = hr2di_view_at(viewer, e->patch, from + size * (0.5 + 0.5 * rule->at[q]), &seen);
    for (size_t m = 0; m < seen.arcs && !status; m++) sum += seen.arc[m][1] - seen.arc[m][0];
    *sees = sum > NONE;
  }
  return status;
}

/* Clears leaves whose part of the background is no more than it may be off: `off[c]` has what
   check c leaves of rows. */
static hr2d_status clear_unseen(hr2di_transport *t, double *const off[HR2DI_TAIL_CHECKS],
                                hr2di_point_viewer *viewer) {
  hr2di_rule rule;
  hr2d_status status = HR2D_OK;
  hr2di_rule_init(&rule, t->order + 6);
  for (size_t k = 0; k < t->leaves && !status; k++) {
    const double last = fabs(off[HR2DI_CHECK_LAST][k * t->order]),
                 part = fabs(off[HR2DI_CHECK_PART][k * t->order]);
    double *sky = t->sky + k * t->order;
    int sees = sky[0] > last;
    if (sees && sky[0] <= HR2DI_TAIL_BOUND * fmax(last, part) &&
        t->hierarchy->element[t->leaf[k]].patch < hr2di_scene_cell(t->hierarchy->scene))
      status = sees_sky(t, viewer, k, &rule, &sees);
    if (!sees) memset(sky, 0, t->order * sizeof *sky);
  }
  hr2di_image_map_spread_leaves(&t->image_map, t->order, 1, t->sky);
  return status;
}

/* Where images of a period are cut off, rows are as exact as their extrapolation.  A leaf whose
   part of the background is no more than the last term of that sees none, or what is left of it
   could be negative.  Where it is no more than its bound the leaf looks whether it sees any. */
static hr2d_status clear_unknown(hr2di_transport *t) {
  double *off[HR2DI_TAIL_CHECKS] = {irradiance_of_one(t, last_check),
                                    irradiance_of_one(t, part_check)};
  hr2di_point_viewer *viewer = NULL;
  hr2d_status status = off[0] && off[1] ? t->failed : HR2D_ENOMEM;
  if (!status)
    status = hr2di_point_viewer_create(t->hierarchy->scene, &t->alloc, t->watch, &viewer);
  if (!status) status = clear_unseen(t, off, viewer);
  hr2di_point_viewer_destroy(viewer);
  for (int c = 0; c < HR2DI_TAIL_CHECKS; c++) hr2di_alloc_free(&t->alloc, off[c]);
  return status ? status : hr2di_watch_work(t->watch, t->leaves / 4);
}

hr2d_status hr2di_background_set_order_p(hr2di_transport *t, unsigned char **sees) {
  t->sky = hr2di_alloc_zero(&t->alloc, t->leaves * t->order, sizeof *t->sky);
  hr2d_status status = t->sky ? take_rows(t) : HR2D_ENOMEM;
  if (!status && !*sees)
    status = hr2di_back_visibility(t->hierarchy->scene, &t->alloc, t->threads, sees, t->watch);
  if (!status && *sees) status = take_all_backs(t, *sees);
  if (t->links->share) status = combine_rows(t, status);
  if (!status) hr2di_image_map_spread_leaves(&t->image_map, t->order, 1, t->sky);
  if (!status) clear_closed(t);
  if (!status && hr2di_symmetry_cuts(&t->hierarchy->scene->symmetry)) status = clear_unknown(t);
  return status;
}
