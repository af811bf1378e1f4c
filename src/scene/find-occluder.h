/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether anything can stand between two patches of a scene. */
#ifndef HR2D_SRC_SCENE_FIND_OCCLUDER_H
#define HR2D_SRC_SCENE_FIND_OCCLUDER_H

#include "scene/in-between.h"

/* Searches for a patch that stands between two others.  Returns HR2D_OK, HR2D_ENOMEM or the
   status of the watch.  Cost O(n log n) if all patches lie on the hull of the scene, and else
   that of hr2di_in_between().  Where the scene has no plane, *found exists without patches. */
hr2d_status hr2di_occluder_find(hr2d_scene *scene, const hr2di_hull *hull,
                                hr2di_occlusion *found, hr2di_watch *watch);

#endif
