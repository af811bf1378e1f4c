/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With C and C⁺ over the links of clusters and averages B̄ of patches, the residual that is
   theirs is ρ((C⁺ − C)B̄ − d B̄), where closure makes d = (C⁺ − C)1 of patches that see patches
   in every direction.  Elements hardly matter to it, as clusters are far away from them.

   In gas of emission E they send a part m of that, too, and d = (C⁺ + m⁺ − C − m)1; where
   patches are open m is 1 − C1. */
#include "estimate/cluster-residuals.h"

#include <math.h>

#include "base/alloc.h"
#include "base/share.h"
#include "estimate/importance.h"
#include "scene/panes.h"

/* Averages of B, and 1 as a band behind them. */
static void set_fields(const hr2di_estimator *e, double *field) {
  const size_t bands = e->eq.transport.bands, patches = e->values / bands;
  for (size_t k = 0; k < patches; k++) {
    for (size_t b = 0; b < bands; b++)
      field[k * (bands + 1) + b] = hr2di_estimator_value(e, 0, k, b);
    field[k * (bands + 1) + bands] = 1;
  }
}

/* What all patches get over the links of clusters, and what gas takes of it. */
typedef struct exchanged {
  double *power;    /* patches × (bands + 1) */
  double *absorbed; /* patches, of B = 1; NULL: no gas */
} exchanged;

static double gas_at(const hr2di_estimator *e, size_t b) {
  return e->coarse->gas ? ldexp(e->coarse->gas[2 * b], -e->exponent_of[b]) : 0;
}

/* How much more gas takes by the finer links if a patch gets so much more. */
static double absorbed_more(const exchanged *coarse, const exchanged *fine, size_t patch,
                            int closed, double arrives) {
  if (!fine->absorbed) return 0;
  return closed ? fine->absorbed[patch] - coarse->absorbed[patch] : -arrives;
}

/* What H of a patch is off by on average. */
static double off_at(const hr2di_estimator *e, const exchanged *coarse, const exchanged *fine,
                     size_t patch, size_t b) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t bands = t->bands, at = patch * (bands + 1);
  const int closed = t->closed && t->closed[patch];
  const double arrives = fine->power[at + bands] - coarse->power[at + bands];
  const double absorbed = absorbed_more(coarse, fine, patch, closed, arrives);
  const double share = closed ? arrives + absorbed : 0;
  const double power = fine->power[at + b] - coarse->power[at + b] + absorbed * gas_at(e, b) -
                       share * hr2di_estimator_value(e, 0, patch, b);
  return fabs(power) / t->hierarchy->scene->patch[patch].length;
}

static double worst(const hr2di_estimator *e, const exchanged *coarse, const exchanged *fine) {
  const hr2d_scene *scene = e->eq.transport.hierarchy->scene;
  const size_t bands = e->eq.transport.bands;
  double max = 0;
  for (size_t k = 0; k < e->values; k++) {
    const size_t patch = k / bands, b = k % bands;
    if (!hr2di_is_important(e->target, patch)) continue;
    const double h = off_at(e, coarse, fine, patch, b);
    const double passed = off_at(e, coarse, fine, hr2di_scene_other_side(scene, patch), b);
    const double off = hr2di_pane_sum(scene, patch, b, h, passed);
    if (off > 0) max = fmax(max, off / hr2di_estimator_min(e, 0, patch, b));
  }
  return max;
}

/* unit: 1 of each patch. */
static hr2d_status exchange(const hr2di_transport *t, hr2di_clusters *clusters,
                            const double *field, const double *unit, exchanged *to) {
  hr2di_cluster_gather how = {.order = 1,
                              .bands = t->bands + 1,
                              .gas = hr2di_cluster_gas_of(t->hierarchy->scene, 0),
                              .share = t->links->share,
                              .threads = t->threads,
                              .watch = t->watch};
  hr2d_status status = hr2di_clusters_gather(clusters, &how, field, to->power);
  if (status || !to->absorbed) return status;
  how.bands = 1;
  how.gas.absorbed = 1;
  return hr2di_clusters_gather(clusters, &how, unit, to->absorbed);
}

/* All shares call it, and get the same part. */
hr2d_status hr2di_cluster_residuals(hr2di_estimator *e, hr2di_clusters *coarser, double *part) {
  const hr2di_transport *t = &e->eq.transport;
  hr2d_share *share = t->links->share;
  const size_t patches = e->values / t->bands, size = patches * (t->bands + 1);
  double *field = hr2di_alloc_zero(&t->alloc, size, 3 * sizeof *field);
  double *unit = t->gas ? hr2di_alloc_zero(&t->alloc, patches, 3 * sizeof *unit) : NULL;
  hr2d_status status =
      hr2di_share_agree(share, field && (unit || !t->gas) ? HR2D_OK : HR2D_ENOMEM);
  if (!status) {
    exchanged coarse = {.power = field + size}, fine = {.power = field + 2 * size};
    if (unit) coarse.absorbed = unit + patches;
    if (unit) fine.absorbed = unit + 2 * patches;
    set_fields(e, field);
    for (size_t k = 0; k < patches && unit; k++) unit[k] = 1;
    status = exchange(t, coarser, field, unit, &coarse);
    if (!status) status = exchange(t, t->roots->clusters, field, unit, &fine);
    if (!status) *part = worst(e, &coarse, &fine);
  }
  hr2di_alloc_free(&t->alloc, unit);
  hr2di_alloc_free(&t->alloc, field);
  return status;
}
