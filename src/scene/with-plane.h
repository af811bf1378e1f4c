/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A committed scene, and a plane also if it has none of its own.

   Commit keeps no plane where nothing is in the way.  Whoever walks there nevertheless has a
   copy of the struct, which shares all but the plane with the scene. */
#ifndef HR2D_SRC_SCENE_WITH_PLANE_H
#define HR2D_SRC_SCENE_WITH_PLANE_H

#include "scene/scene-impl.h"

typedef struct hr2di_with_plane {
  hr2d_scene scene; /* has no plane where walls cross within too many roundings */
  int own;          /* the plane is not that of the original */
} hr2di_with_plane;

/* Copies a scene, and makes a plane if that has none.  HR2D_OK, HR2D_ENOMEM or the status of
   the watch; to be ended by hr2di_with_plane_clear() in any case. */
hr2d_status hr2di_with_plane_init(hr2di_with_plane *copy, const hr2d_scene *scene,
                                  const hr2d_allocator *alloc, hr2di_watch *watch);
/* Also of zeros. */
void hr2di_with_plane_clear(hr2di_with_plane *copy);

#endif
