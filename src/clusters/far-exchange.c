/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clusters for solvers of others: lengths are those of the scene there. */
#include <hr2d/clusters.h>

#include "base/alloc.h"
#include "base/share.h"
#include "base/sized-struct.h"
#include "clusters/clusters.h"
#include "scene/scene-impl.h"

struct hr2d_clusters {
  const hr2d_scene *scene;
  hr2di_clusters *made;
};

static hr2d_status take_options(hr2d_clusters_options *o, const hr2d_clusters_options *given) {
  *o = (hr2d_clusters_options)HR2D_CLUSTERS_OPTIONS_INIT;
  const hr2d_status status = hr2di_sized_copy(o, sizeof *o, given);
  if (status) return status;
  if (!(o->accuracy >= 0 && o->accuracy <= 1)) return HR2D_EINVAL;
  if (o->accuracy == 0) o->accuracy = HR2D_DEFAULT_CLUSTER_ACCURACY;
  return HR2D_OK;
}

hr2d_status hr2d_clusters_create(const hr2d_scene *scene, const hr2d_clusters_options *options,
                                 hr2d_near_pairs_fn near, void *ctx, hr2d_clusters **clusters) {
  if (clusters) *clusters = NULL;
  if (!scene || !near || !clusters) return HR2D_EINVAL;
  hr2d_clusters_options o;
  hr2di_watch watch;
  *clusters = NULL;
  if (!scene->committed) return HR2D_ESTATE;
  hr2d_status status = take_options(&o, options);
  if (status) return status;
  if (scene->symmetry.motion || hr2di_scene_has_gas(scene)) return HR2D_EUNSUPPORTED;
  hr2d_clusters *c = hr2di_alloc_zero(&scene->alloc, 1, sizeof *c);
  if (!c) return HR2D_ENOMEM;
  c->scene = scene;
  hr2di_scene_watch(scene, &watch, o.progress, o.progress_ctx, "refine");
  status = hr2di_clusters_create(scene, &scene->alloc, o.accuracy, near, ctx, &watch, &c->made);
  if (!status) status = hr2di_watch_ask(&watch);
  if (!status)
    *clusters = c;
  else
    hr2d_clusters_destroy(c);
  return status;
}

void hr2d_clusters_destroy(hr2d_clusters *clusters) {
  if (!clusters) return;
  hr2di_clusters_destroy(clusters->made);
  hr2di_alloc_free(&clusters->scene->alloc, clusters);
}

uint64_t hr2d_clusters_links(const hr2d_clusters *clusters) {
  if (!clusters) return 0;
  return hr2di_clusters_links(clusters->made);
}

uint64_t hr2d_clusters_bytes(const hr2d_clusters *clusters) {
  if (!clusters) return 0;
  return sizeof *clusters + hr2di_clusters_bytes(clusters->made);
}

/* Numbers between two declarations of work. */
enum { BATCH = 4096 };

/* power *= factor, which is 0 at the beginning. */
static void scale(double *power, size_t count, double factor, hr2di_watch *watch) {
  for (size_t k = 0; k < count; k++) {
    if (k % BATCH == 0 && hr2di_watch_work(watch, BATCH / 64)) return;
    power[k] = factor == 0 ? 0 : factor * power[k];
  }
}

hr2d_status hr2d_clusters_gather(hr2d_clusters *clusters, const hr2d_clusters_options *options,
                                 size_t order, size_t bands, const double *radiosity,
                                 double *power) {
  if (!clusters || !radiosity || !power) return HR2D_EINVAL;
  const hr2d_scene *scene = clusters->scene;
  hr2d_clusters_options o;
  hr2di_watch watch;
  hr2d_status status = take_options(&o, options);
  if (status) return status;
  if (hr2di_share_check(o.share)) return HR2D_EINVAL;
  if (order < 1 || order > HR2D_MAX_ORDER || bands < 1) return HR2D_EINVAL;
  if (bands > PTRDIFF_MAX / sizeof *power / order / (scene->patches + 1)) return HR2D_EINVAL;
  const size_t count = scene->patches * order * bands;
  const hr2di_cluster_gather how = {
      .order = order, .bands = bands, .share = o.share, .threads = o.threads, .watch = &watch};
  hr2di_scene_watch(scene, &watch, o.progress, o.progress_ctx, "solve");
  hr2di_share_begin(o.share);
  scale(power, count, 0, &watch);
  status = hr2di_share_agree(o.share, hr2di_watch_status(&watch));
  if (!status) status = hr2di_clusters_gather(clusters->made, &how, radiosity, power);
  if (status) return status;
  scale(power, count, hr2d_scene_unit(scene), &watch);
  return hr2di_share_agree(o.share, hr2di_watch_ask(&watch));
}
