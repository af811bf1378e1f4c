/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches that see each other in part: one crosses the horizon of the other. */
#ifndef HR2D_SRC_SCENE_FACING_IN_PART_H
#define HR2D_SRC_SCENE_FACING_IN_PART_H

#include <hr2d/scene.h>
#include <stddef.h>

#include "base/watch.h"
#include "geometry/hull.h"

typedef struct hr2di_first_pair {
  int exists;
  size_t i, j; /* i < j */
} hr2di_first_pair;

/* Finds the first pair, in the order of i and then j, of which hr2di_facing_of() says
   HR2DI_FACING_PART; nothing else is looked at, least of all what is in the way.  The scene has
   walls and runs.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_facing_in_part_find(const hr2d_scene *scene, const hr2di_hull *hull,
                                      hr2di_first_pair *found, hr2di_watch *watch);

#endif
