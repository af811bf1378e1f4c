/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What clusters leave behind once their pairs are sorted: those that have links. */
#ifndef HR2D_SRC_CLUSTERS_CLUSTERS_IMPL_H
#define HR2D_SRC_CLUSTERS_CLUSTERS_IMPL_H

#include "clusters/clusters.h"
#include "clusters/expansion.h"

#define HR2DI_NO_CLUSTER UINT32_MAX

/* Of a cluster, at most. */
enum { HR2DI_CLUSTER_POINTS = HR2DI_EXPANSION_POINTS * HR2DI_EXPANSION_POINTS };

typedef struct hr2di_linked {
  hr2di_expansion far;
  uint32_t parent; /* the least that holds it, before it; or HR2DI_NO_CLUSTER */
  size_t first;    /* of hr2di_clusters::point */
} hr2di_linked;

typedef struct hr2di_cluster_link {
  uint32_t first, second;
} hr2di_cluster_link;

/* Clusters level by level: those of one level may be done in any order. */
typedef struct hr2di_levels {
  uint32_t *cluster; /* those above first */
  uint32_t *begin;   /* where each level begins, and the end */
  size_t count;
  uint32_t *child, *next; /* per cluster: its last child, and the child of its parent before it;
                             or HR2DI_NO_CLUSTER */
} hr2di_levels;

struct hr2di_clusters {
  hr2d_allocator alloc;
  const hr2d_scene *scene;
  double accuracy;
  hr2di_linked *linked; /* those that hold others before them */
  size_t linked_count;
  uint32_t *home; /* of each patch: the least that holds it, or HR2DI_NO_CLUSTER */
  hr2di_cluster_link *link;
  size_t links, link_capacity;
  hr2d_point *point;
  size_t points;
  hr2di_levels levels;
  uint64_t exchanges; /* of points, over all links */
  double
      *cosine; /* T_n at the points, for each number of points; see hr2di_clusters_cosines() */
};

/* Keeps of all clusters those between which made->link are, and renumbers these; HR2D_OK or
   HR2D_ENOMEM. */
hr2d_status hr2di_clusters_keep(hr2di_clusters *made, const hr2di_cluster_tree *tree,
                                const hr2di_expansion *far);

/* Keeps what another one keeps, with the points that the accuracy asks for. */
hr2d_status hr2di_clusters_keep_finer(hr2di_clusters *made, const hr2di_clusters *of);

/* Sets the levels and the number of exchanges of clusters that are kept; HR2D_OK or
 * HR2D_ENOMEM.
 */
hr2d_status hr2di_clusters_find_levels(hr2di_clusters *made);

/* T_n at point k of `count`, by n·count + k. */
static inline const double *hr2di_clusters_cosines(const hr2di_clusters *c, unsigned count) {
  return c->cosine + (size_t)(count - 1) * count * (2 * count - 1) / 6;
}

#endif
