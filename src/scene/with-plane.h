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
  int repeated;     /* neither are the patches */
} hr2di_with_plane;

/* Copies a scene, and makes a plane if that has none.  HR2D_OK, HR2D_ENOMEM or the status of
   the watch; to be ended by hr2di_with_plane_clear() in any case. */
hr2d_status hr2di_with_plane_init(hr2di_with_plane *copy, const hr2d_scene *scene,
                                  const hr2d_allocator *alloc, hr2di_watch *watch);
/* The same, of a period with as many images as are made where patches see for ever: points
   between the patches mostly do.  Patches have the numbers that hr2di_symmetry says, and no
   light.  May also return HR2D_ERANGE. */
hr2d_status hr2di_with_images_init(hr2di_with_plane *copy, const hr2d_scene *scene,
                                   const hr2d_allocator *alloc, hr2di_watch *watch);

/* Also of zeros. */
void hr2di_with_plane_clear(hr2di_with_plane *copy);

#endif
