/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pairs of patches a refinement begins with, where most patches do not see each other, or
   clusters spare most pairs. */
#ifndef HR2D_SRC_CLUSTERS_ROOT_PAIRS_H
#define HR2D_SRC_CLUSTERS_ROOT_PAIRS_H

#include "clusters/clusters.h"

typedef struct hr2di_roots {
  hr2di_clusters *clusters; /* NULL: there are none */
  double accuracy;          /* relative accuracy of cluster links; 0: there are none */
  hr2d_pair *pair;          /* of patches, first below second; sorted */
  size_t count, capacity;
  size_t *row; /* where the pairs of each patch begin; one more.  NULL: all pairs are roots */
} hr2di_roots;

/* Finds the pairs of a scene: those that beams find, if walls hide most others; else those that
   clusters leave.  HR2D_OK, HR2D_ENOMEM or the status of the watch.  To be cleared in any case.
 */
hr2d_status hr2di_roots_init(hr2di_roots *roots, const hr2d_scene *scene,
                             const hr2d_allocator *alloc, double accuracy, unsigned threads,
                             hr2di_watch *watch);

/* Copies the pairs of a scene of so many patches; there are no clusters.  Returns likewise. */
hr2d_status hr2di_roots_copy(hr2di_roots *roots, const hr2di_roots *from, size_t patches,
                             const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_roots_clear(hr2di_roots *roots, const hr2d_allocator *alloc);

#endif
