/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a scene has a line on which something stands between two fronts. */
#ifndef HR2D_SRC_SCENE_IN_BETWEEN_H
#define HR2D_SRC_SCENE_IN_BETWEEN_H

#include <hr2d/scene.h>

#include "base/watch.h"
#include "geometry/hull.h"

/* Of a scene with a plane and its side parts.  *possible is 0 only if there is no such line. It
   may be 1 without one where patches leave gaps along a side of a wall, or within roundings.
   Returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_in_between(const hr2d_scene *scene, const hr2di_hull *hull, int *possible,
                             hr2di_watch *watch);

#endif
