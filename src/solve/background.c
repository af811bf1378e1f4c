/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The form factor of the background: 1 less the row sum, less the form factor of backs. */
#include "solve/background.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/legendre.h"
#include "base/team.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "visibility/point-view.h"
#include "visibility/seen-backs.h"
#include "visibility/view-tail.h"

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

/* The leaves of a task, and those that are worth another thread. */
enum { SOME = 16, WORTH = 64 };

/* The work space of a thread. */
typedef struct looker {
  hr2di_viewer *viewer;
  hr2di_watch own; /* but the calling thread has that of the transport */
  hr2d_status status;
} looker;

typedef struct lookers {
  hr2di_transport *t;
  const unsigned char *sees; /* per patch: whether it may see a back */
  hr2di_basis basis;
  hr2di_rule rule;
  looker *looker;
  size_t threads;
  atomic_int failed;
} lookers;

/* Subtracts the backs that a leaf sees.  The leaf begins at fraction `from` of its patch and
   has `size` of its length. */
static hr2d_status take_backs(const lookers *all, hr2di_viewer *viewer, size_t leaf,
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
    hr2di_view_tail tail;
    hr2di_view_tail_of(scene, patch, at, &seen, &tail);
    const double back = seen.back + tail.back;
    hr2di_basis_at(&all->basis, all->rule.at[q], phi);
    for (size_t k = 0; k < t->order; k++) sky[k] -= all->rule.weight[q] * back * phi[k];
  }
  return HR2D_OK;
}

/* Each leaf has its own coefficients, so that no bit depends on threads. */
static void take_some_backs(void *ctx, size_t worker, size_t task) {
  lookers *all = ctx;
  looker *l = &all->looker[worker];
  const hr2di_transport *t = all->t;
  const hr2d_hierarchy *h = t->hierarchy;
  for (size_t k = task * SOME; k < t->leaves && k < (task + 1) * SOME; k++) {
    const hr2d_element *e = &h->element[t->leaf[k]];
    if (l->status || atomic_load(&all->failed)) return;
    if (e->patch < hr2di_scene_cell(h->scene) && all->sees[e->patch] &&
        hr2di_scene_lit(h->scene, e->patch) &&
        hr2di_share_has_row(t->links->share, e->patch, h->scene->patches))
      l->status = take_backs(all, l->viewer, k, hr2di_element_start(h, t->leaf[k]),
                             e->length / h->element[e->patch].length);
    if (l->status) atomic_store(&all->failed, 1);
  }
}

static hr2d_status take_all_backs(hr2di_transport *t, const unsigned char *sees) {
  const size_t most = 1 + t->leaves / WORTH, threads = hr2di_team_threads(t->threads);
  lookers all = {.t = t, .sees = sees, .threads = threads < most ? threads : most};
  hr2di_basis_init(&all.basis, t->order);
  hr2di_rule_init(&all.rule, t->order + 6);
  all.looker = hr2di_alloc_zero(&t->alloc, all.threads, sizeof *all.looker);
  if (!all.looker) return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < all.threads && !status; k++) {
    looker *l = &all.looker[k];
    hr2di_watch_follow(&l->own, t->watch);
    status = hr2di_viewer_create(t->hierarchy->scene, &t->alloc, k == 0 ? t->watch : &l->own,
                                 &l->viewer);
  }
  if (!status)
    hr2di_team_run(all.threads, (t->leaves + SOME - 1) / SOME, take_some_backs, &all, t->watch);
  for (size_t k = 0; k < all.threads; k++) {
    if (!status) status = all.looker[k].status;
    hr2di_viewer_destroy(all.looker[k].viewer);
  }
  hr2di_alloc_free(&t->alloc, all.looker);
  return status ? status : hr2di_watch_status(t->watch);
}

/* What arrives if everything radiates 1: by K, or by what its extrapolation leaves.  NULL: out
   of memory. */
static double *irradiance_of_one(hr2di_transport *t,
                                 void (*apply)(hr2di_transport *, const double *, double *)) {
  const size_t field = t->leaves * t->width;
  double *one = hr2di_alloc_zero(&t->alloc, field, sizeof *one);
  double *arrives = one ? hr2di_alloc(&t->alloc, field, sizeof *arrives) : NULL;
  if (arrives) {
    for (size_t k = 0; k < t->leaves; k++)
      for (size_t b = 0; b < t->bands; b++) one[k * t->width + b] = 1;
    apply(t, one, arrives);
  }
  hr2di_alloc_free(&t->alloc, one);
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
      t->sky[k * t->order + l] = (l == 0) - row[k * t->width + l * t->bands];
  }
  hr2di_alloc_free(&t->alloc, row);
  return t->failed ? t->failed : hr2di_watch_work(t->watch, t->leaves / 4);
}

/* Each share has looked from the leaves of its rows. */
static hr2d_status combine_rows(hr2di_transport *t, hr2d_status status) {
  const hr2d_hierarchy *h = t->hierarchy;
  for (size_t k = 0; k < t->leaves && !status; k++)
    if (!hr2di_share_has_row(t->links->share, h->element[t->leaf[k]].patch, h->scene->patches))
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

/* Where images of a period are cut off, rows are as exact as their extrapolation.  A leaf whose
   part of the background is no more than that may be off sees none, or what is left of it could
   be negative. */
static hr2d_status clear_unknown(hr2di_transport *t) {
  double *tail = irradiance_of_one(t, last_check);
  if (!tail) return HR2D_ENOMEM;
  for (size_t k = 0; k < t->leaves && !t->failed; k++)
    if (t->sky[k * t->order] <= fabs(tail[k * t->width]))
      memset(t->sky + k * t->order, 0, t->order * sizeof *t->sky);
  hr2di_alloc_free(&t->alloc, tail);
  return t->failed ? t->failed : hr2di_watch_work(t->watch, t->leaves / 4);
}

hr2d_status hr2di_background_set_order_p(hr2di_transport *t, unsigned char **sees) {
  t->sky = hr2di_alloc_zero(&t->alloc, t->leaves * t->order, sizeof *t->sky);
  hr2d_status status = t->sky ? take_rows(t) : HR2D_ENOMEM;
  if (!status && !*sees)
    status = hr2di_seen_backs(t->hierarchy->scene, &t->alloc, sees, t->watch);
  if (!status && *sees) status = take_all_backs(t, *sees);
  if (t->links->share) status = combine_rows(t, status);
  hr2di_ties_spread_leaves(&t->ties, t->order, 1, t->sky);
  if (!status) clear_closed(t);
  if (!status && hr2di_symmetry_cuts(&t->hierarchy->scene->symmetry)) status = clear_unknown(t);
  return status;
}
