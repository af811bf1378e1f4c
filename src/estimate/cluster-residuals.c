/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With C and C⁺ over the links of clusters and averages B̄ of patches, the residual that is
   theirs is ρ((C⁺ − C)B̄ − d B̄), where closure makes d = (C⁺ − C)1 of patches that see patches
   in every direction.  Elements hardly matter to it, as clusters are far away from them. */
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

/* What H of a patch is off by on average. */
static double off_at(const hr2di_estimator *e, const double *coarse, const double *fine,
                     size_t patch, size_t b) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t bands = t->bands, at = patch * (bands + 1);
  const int closed = t->closed && t->closed[patch];
  const double share = closed ? fine[at + bands] - coarse[at + bands] : 0;
  const double power =
      fine[at + b] - coarse[at + b] - share * hr2di_estimator_value(e, 0, patch, b);
  return fabs(power) / t->hierarchy->scene->patch[patch].length;
}

static double worst(const hr2di_estimator *e, const double *coarse, const double *fine) {
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

/* All shares call it, and get the same part. */
hr2d_status hr2di_cluster_residuals(hr2di_estimator *e, hr2di_clusters *coarser, double *part) {
  const hr2di_transport *t = &e->eq.transport;
  hr2d_share *share = t->links->share;
  const size_t planes = t->bands + 1, size = e->values / t->bands * planes;
  const hr2di_cluster_gather how = {
      .order = 1, .bands = planes, .share = share, .threads = t->threads, .watch = t->watch};
  double *field = hr2di_alloc_zero(&t->alloc, size, 3 * sizeof *field);
  hr2d_status status = hr2di_share_agree(share, field ? HR2D_OK : HR2D_ENOMEM);
  if (!status) {
    set_fields(e, field);
    status = hr2di_clusters_gather(coarser, &how, field, field + size);
  }
  if (!status)
    status = hr2di_clusters_gather(t->roots->clusters, &how, field, field + 2 * size);
  if (!status) *part = worst(e, field + size, field + 2 * size);
  hr2di_alloc_free(&t->alloc, field);
  return status;
}
