/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A binary tree of clusters over the patches of a scene.

   Patches that are near to each other are kept together and, once their normals fall into
   two narrow groups, those that look the same way. */
#ifndef HR2D_SRC_CLUSTERS_TREE_H
#define HR2D_SRC_CLUSTERS_TREE_H

#include <hr2d/memory.h>
#include <hr2d/scene.h>
#include <stdint.h>

#include "base/watch.h"

#define HR2DI_NO_RUN UINT32_MAX

/* Lengths along a cluster's direction u, and along v, which is u turned to the left: of its
   patches if they look about the same way, else of the plane. */
typedef struct hr2di_extent {
  double u0, u1, v0, v1;
} hr2di_extent;

typedef struct hr2di_cluster {
  double x0, x1, y0, y1;
  hr2d_point u;         /* of length 1 */
  hr2di_extent tight;   /* of the patches */
  hr2di_extent nested;  /* of the children's `nested`, corners and all */
  double cosine, sine;  /* normals are within this angle of v; cosine ≤ 0: no matter where */
  hr2d_segment span;    /* from end to end of its patches, if they are of one run */
  uint32_t run;         /* the wall of all its patches and their side of it, or HR2DI_NO_RUN */
  uint32_t first, last; /* of hr2di_cluster_tree::patch */
  uint32_t child;       /* its children, this and the one behind it; 0 for a patch */
  int orderly;          /* none of its patches hides another from what is in front of all;
                           set by hr2di_clusters_order() */
} hr2di_cluster;

typedef struct hr2di_cluster_tree {
  hr2d_allocator alloc;
  hr2di_cluster *cluster; /* parents come before children; 2·patches − 1 of them */
  size_t clusters;
  uint32_t *patch;
  double slack; /* a sine that does not matter; 0 unless set */
} hr2di_cluster_tree;

/* For a committed scene; HR2D_OK, HR2D_ENOMEM or the status of the watch.  To be ended by
   hr2di_cluster_tree_clear() in any case. */
hr2d_status hr2di_cluster_tree_init(hr2di_cluster_tree *tree, const hr2d_scene *scene,
                                    const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_cluster_tree_clear(hr2di_cluster_tree *tree);

/* The corners of a cluster's extent, in the plane. */
void hr2di_cluster_corners(const hr2di_cluster *c, const hr2di_extent *extent,
                           hr2d_point corner[4]);

/* The extent along the directions of `c` of what lies within that of another. */
hr2di_extent hr2di_cluster_extent_of(const hr2di_cluster *c, const hr2di_cluster *other,
                                     const hr2di_extent *extent);

static inline uint32_t hr2di_cluster_size(const hr2di_cluster *c) {
  return c->last - c->first;
}

#endif
