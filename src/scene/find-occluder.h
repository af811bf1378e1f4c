/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether anything can stand between two patches of a scene. */
#ifndef HR2D_SRC_SCENE_FIND_OCCLUDER_H
#define HR2D_SRC_SCENE_FIND_OCCLUDER_H

#include <hr2d/scene.h>
#include <stddef.h>

#include "base/watch.h"
#include "geometry/hull.h"

typedef struct hr2di_occlusion {
  int exists;
  size_t i, j, occluder; /* the first found */
} hr2di_occlusion;

/* Searches for a patch that reaches into the shaft of two others.  Returns HR2D_OK, HR2D_ENOMEM
   or the status of the watch.  Cost O(n log n) if all patches lie on the hull of the scene, and
   else that of the beams from the backs of walls.  If these find that something may be in the
   way, pairs are searched in their order until the first is found. */
hr2d_status hr2di_occluder_find(hr2d_scene *scene, const hr2di_hull *hull,
                                hr2di_occlusion *found, hr2di_watch *watch);

#endif
