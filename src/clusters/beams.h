/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams: what a patch may see of others, where walls are in the way.

   A beam is the shaft from a part of the patch to a part of a square around the scene.  A
   wall, or a body, that cuts it in two hides all that is beyond.  Beams are halved until few
   walls are left in each, so that what is found costs about as much as is seen, however
   much is hidden. */
#ifndef HR2D_SRC_CLUSTERS_BEAMS_H
#define HR2D_SRC_CLUSTERS_BEAMS_H

#include "clusters/tree.h"
#include "occlusion/walls.h"

typedef struct hr2di_beam hr2di_beam;

/* Work space of one thread. */
typedef struct hr2di_beams {
  const hr2d_scene *scene;
  const hr2di_cluster_tree *tree;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  uint32_t *target; /* clusters that beams may still meet, each with its own */
  size_t targets, target_capacity;
  uint32_t *wall; /* of beams of which all walls are known */
  size_t wall_capacity;
  hr2di_beam *beam;
  size_t count, capacity;
  uint32_t *mark; /* of each patch: the patch by which it was seen last, plus 1 */
  uint32_t *seen; /* patches */
  size_t seen_count, seen_capacity;
} hr2di_beams;

/* To be ended by hr2di_beams_clear() in either case. */
hr2d_status hr2di_beams_init(hr2di_beams *beams, const hr2d_scene *scene,
                             const hr2di_cluster_tree *tree, const hr2d_allocator *alloc,
                             hr2di_watch *watch);
void hr2di_beams_clear(hr2di_beams *beams);

/* Collects beams->seen: the patches of clusters, without those that face a patch not at all
   or are surely hidden from it, each once; HR2D_OK, HR2D_ENOMEM or the status of the
   watch. */
hr2d_status hr2di_beams_cast(hr2di_beams *beams, uint32_t patch, const uint32_t *cluster,
                             size_t count);

#endif
