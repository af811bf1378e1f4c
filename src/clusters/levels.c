/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/alloc.h"
#include "clusters/clusters-impl.h"

/* What the points of the clusters of a link are to each other. */
static uint64_t exchanges_of(const hr2di_clusters *c, const hr2di_cluster_link *link) {
  return hr2di_expansion_points(&c->linked[link->first].far) *
         hr2di_expansion_points(&c->linked[link->second].far);
}

/* Sets the depth and the place among its siblings of each cluster; begin[d + 2] counts those of
   depth d.  Parents are before their children. */
static void link_children(hr2di_clusters *made, uint32_t *depth) {
  hr2di_levels *l = &made->levels;
  for (uint32_t k = 0; k < made->linked_count; k++) {
    const uint32_t parent = made->linked[k].parent;
    const int is_root = parent == HR2DI_NO_CLUSTER;
    l->child[k] = HR2DI_NO_CLUSTER;
    l->next[k] = is_root ? HR2DI_NO_CLUSTER : l->child[parent];
    if (!is_root) l->child[parent] = k;
    depth[k] = is_root ? 0 : depth[parent] + 1;
    if (depth[k] >= l->count) l->count = depth[k] + 1;
    l->begin[depth[k] + 2]++;
  }
}

hr2d_status hr2di_clusters_find_levels(hr2di_clusters *made) {
  const size_t n = made->linked_count;
  hr2di_levels *l = &made->levels;
  if (made->links == 0) return HR2D_OK;
  l->cluster = hr2di_alloc(&made->alloc, 3 * n, sizeof *l->cluster);
  l->begin = hr2di_alloc_zero(&made->alloc, n + 2, sizeof *l->begin);
  uint32_t *depth = hr2di_alloc(&made->alloc, n, sizeof *depth);
  const int room = l->cluster && l->begin && depth;
  if (room) {
    l->child = l->cluster + n;
    l->next = l->child + n;
    link_children(made, depth);
    for (size_t d = 1; d <= l->count; d++) l->begin[d + 1] += l->begin[d];
    for (uint32_t k = 0; k < n; k++) l->cluster[l->begin[depth[k] + 1]++] = k;
    for (size_t k = 0; k < made->links; k++)
      made->exchanges += exchanges_of(made, &made->link[k]);
  }
  hr2di_alloc_free(&made->alloc, depth);
  return room ? HR2D_OK : HR2D_ENOMEM;
}
