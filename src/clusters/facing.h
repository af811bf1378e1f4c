/* SPDX-License-Identifier: GPL-3.0-or-later */
/* On which side of the patches of one cluster another one lies. */
#ifndef HR2D_SRC_CLUSTERS_FACING_H
#define HR2D_SRC_CLUSTERS_FACING_H

#include "clusters/tree.h"

/* What lies no farther behind a patch than this counts as being in front, too, and so does
   what lies in a direction less than hr2di_cluster_tree::slack behind: walls that are one
   line but for rounding do. */
#define HR2DI_CLUSTER_TOUCH 0x1p-47

/* Both where all lie on one line. */
typedef enum hr2di_side_of {
  HR2DI_SIDE_FRONT = 1, /* in front of every patch, or touching its line */
  HR2DI_SIDE_BEHIND = 2 /* behind every patch, or touching its line */
} hr2di_side_of;

/* The sides of all patches of `c` on which all of `other` surely lies, at a glance. */
unsigned hr2di_cluster_glance(const hr2di_cluster_tree *tree, const hr2di_cluster *c,
                              const hr2di_cluster *other);

/* Whether it lies on one of them, by looking into both; no also where that takes long. */
int hr2di_cluster_on(const hr2di_cluster_tree *tree, uint32_t c, uint32_t other,
                     hr2di_side_of side);

/* How the patches of two clusters face each other: none does for sure, all do fully for
   sure and but for rounding, or neither is known. */
typedef enum hr2di_clusters_facing {
  HR2DI_CLUSTERS_MIXED,
  HR2DI_CLUSTERS_APART,
  HR2DI_CLUSTERS_FACING
} hr2di_clusters_facing;

/* At a glance. */
hr2di_clusters_facing hr2di_clusters_face(const hr2di_cluster_tree *tree, uint32_t i,
                                          uint32_t j);

/* Sets hr2di_cluster::orderly.

   A patch w hides a point of p from a point y that is in front of both only if the line
   from p to y meets w: not if p is in front of w, so that the line stays there, nor if w is
   behind p. */
void hr2di_clusters_order(hr2di_cluster_tree *tree, hr2di_watch *watch);

#endif
