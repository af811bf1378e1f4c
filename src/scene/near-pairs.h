/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches that are next to each other with little between them. */
#ifndef HR2D_SRC_SCENE_NEAR_PAIRS_H
#define HR2D_SRC_SCENE_NEAR_PAIRS_H

#include <hr2d/scene.h>
#include <stdint.h>

#include "base/watch.h"

typedef struct hr2di_near_pairs {
  uint32_t *first; /* patches + 1: the pairs of patch k are items [first[k], first[k + 1]) */
  uint32_t *other; /* each pair is there from both sides */
} hr2di_near_pairs;

/* Finds a few pairs per patch, most of which see each other; none if the patches cannot be
   triangulated.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch; in any case the
   caller frees both arrays.  Cost O(n log n). */
hr2d_status hr2di_near_pairs_init(hr2di_near_pairs *near, const hr2d_scene *scene,
                                  hr2di_watch *watch);

#endif
