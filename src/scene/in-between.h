/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a scene has a line on which something stands between two fronts. */
#ifndef HR2D_SRC_SCENE_IN_BETWEEN_H
#define HR2D_SRC_SCENE_IN_BETWEEN_H

#include <hr2d/scene.h>
#include <stddef.h>

#include "base/watch.h"
#include "geometry/hull.h"

typedef struct hr2di_occlusion {
  int exists;
  size_t i, j, occluder; /* patches: what can stand between patches i < j */
} hr2di_occlusion;

/* Of a scene with a plane and its side parts.  The three patches are true, but need not be the
   first that are.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch.  The cost is that
   of the beams from the backs of walls, until something is found. */
hr2d_status hr2di_in_between(const hr2d_scene *scene, const hr2di_hull *hull,
                             hr2di_occlusion *found, hr2di_watch *watch);

#endif
