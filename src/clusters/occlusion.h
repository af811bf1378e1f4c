/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is in the way between two clusters: nothing for sure, or everything. */
#ifndef HR2D_SRC_CLUSTERS_OCCLUSION_H
#define HR2D_SRC_CLUSTERS_OCCLUSION_H

#include "clusters/shaft.h"
#include "clusters/tree.h"
#include "occlusion/walls.h"

/* Whether no patch is in the way of any line from a patch of i to one of j; never 1 if one
   is.  All patches of each are in front of all of the other.  *suspect is a cluster that may
   be in the way, looked at first, and set to one if the answer is no; 0 for none. */
int hr2di_clusters_clear(const hr2di_cluster_tree *tree, uint32_t i, uint32_t j,
                         uint32_t *suspect);

/* Whether one wall, or one body, blocks all lines between two clusters; never 1 if it does
   not. */
int hr2di_clusters_blocked(const hr2di_walls *walls, const hr2di_cluster *i,
                           const hr2di_cluster *j);

/* Whether the body whose walls are all those of a box cuts a shaft in two. */
int hr2di_clusters_body_across(const hr2di_walls *walls, const hr2di_shaft *shaft,
                               const hr2di_box *box);

#endif
