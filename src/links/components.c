/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Links join patches; where clusters replace most links, the links of clusters do. */
#include "links/components.h"

#include "base/alloc.h"
#include "base/union-find.h"
#include "clusters/clusters-impl.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

size_t hr2di_component(hr2di_components *c, size_t k) {
  return hr2di_union_find(c->parent, (uint32_t)k);
}

static void join(hr2di_components *c, size_t i, size_t j) {
  hr2di_union_join(c->parent, (uint32_t)i, (uint32_t)j);
}

static int passes(const hr2d_scene *scene, size_t patch, size_t band) {
  return hr2di_scene_other_side(scene, patch) != patch &&
         (band == SIZE_MAX || hr2d_scene_transmittance(scene, patch, band) > 0);
}

void hr2di_components_join_panes(hr2di_components *c, const hr2d_scene *scene, size_t band) {
  for (size_t k = 0; scene->other_side && k < scene->patches; k++)
    if (passes(scene, k, band)) join(c, k, hr2di_scene_other_side(scene, k));
}

/* A link of two clusters means that all patches of one see all patches of the other.  Without
   such links no patch has a home. */
static void join_clusters(hr2di_components *c, const hr2di_clusters *clusters, size_t patches) {
  if (clusters->links == 0) return;
  for (size_t k = 0; k < patches; k++)
    if (clusters->home[k] != HR2DI_NO_CLUSTER) join(c, k, patches + clusters->home[k]);
  for (size_t k = 0; k < clusters->linked_count; k++)
    if (clusters->linked[k].parent != HR2DI_NO_CLUSTER)
      join(c, patches + k, patches + clusters->linked[k].parent);
  for (size_t k = 0; k < clusters->links; k++)
    join(c, patches + clusters->link[k].first, patches + clusters->link[k].second);
}

/* Joins what links of other shares join: each number learns the least one that any share knows
   of its component, until no share learns anything. */
static hr2d_status join_shares(hr2di_components *c, const hr2d_linkset *links, double *min,
                               size_t count, hr2d_status status) {
  double joined = 1;
  if (!status && !min) status = HR2D_ENOMEM;
  while (joined > 0 && !status) {
    for (size_t k = 0; k < count; k++) min[k] = -(double)hr2di_component(c, k);
    status = hr2di_share_combine(links->share, HR2D_OK, HR2D_COMBINE_MOST, min, count);
    joined = 0;
    for (size_t k = 0; k < count && !status; k++) {
      const size_t other = (size_t)-min[k];
      if (hr2di_component(c, k) == hr2di_component(c, other)) continue;
      join(c, k, other);
      joined = 1;
    }
    if (!status)
      status = hr2di_share_combine(links->share, HR2D_OK, HR2D_COMBINE_MOST, &joined, 1);
  }
  return hr2di_share_agree(links->share, status);
}

hr2d_status hr2di_components_init(hr2di_components *c, const hr2d_linkset *links,
                                  hr2di_watch *watch) {
  const hr2d_element *element = links->hierarchy->element;
  const hr2d_scene *scene = links->hierarchy->scene;
  const size_t patches = scene->patches;
  const hr2di_clusters *clusters = links->roots.clusters;
  const size_t count = patches + (clusters ? clusters->linked_count : 0);
  c->alloc = links->alloc;
  c->count = count;
  c->parent = count <= UINT32_MAX ? hr2di_alloc(&links->alloc, count, sizeof *c->parent) : NULL;
  if (!c->parent) return HR2D_ENOMEM;
  for (size_t k = 0; k < count; k++) c->parent[k] = (uint32_t)k;
  hr2d_status status = hr2di_watch_work(watch, count / 4);
  if (clusters) join_clusters(c, clusters, patches);
  for (size_t k = hr2di_scene_cell(scene); k < patches; k++)
    join(c, k, hr2di_scene_original(scene, k));
  for (size_t block = 0; block < hr2di_store_chunks(&links->store) && !status; block++) {
    status = hr2di_watch_work(watch, HR2DI_CHUNK_LINKS / 8);
    const uint64_t first = (uint64_t)block * HR2DI_CHUNK_LINKS;
    for (size_t k = 0; k < hr2di_store_chunk_size(&links->store, block); k++) {
      const hr2d_pair pair = hr2di_store_link(&links->store, first + k).pair;
      join(c, element[pair.first].patch, element[pair.second].patch);
    }
  }
  if (!links->share) return status;
  double *min = hr2di_alloc(&links->alloc, count, sizeof *min);
  status = join_shares(c, links, min, count, status);
  hr2di_alloc_free(&links->alloc, min);
  return status;
}

void hr2di_components_clear(hr2di_components *c) {
  hr2di_alloc_free(&c->alloc, c->parent);
  c->parent = NULL;
}
