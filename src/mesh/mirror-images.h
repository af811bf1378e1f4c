/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mirror images: points where radiosity is nearly singular because of a wall close by.

   An end of a patch at height δ above a wall makes the wall's radiosity singular at its
   foot ± iδ.  The wall's light comes back over another δ: for the patch, the mirror image of
   the end behind the wall acts as one more end. */
#ifndef HR2D_SRC_MESH_MIRROR_IMAGES_H
#define HR2D_SRC_MESH_MIRROR_IMAGES_H

#include <hr2d/scene.h>
#include <stdint.h>

#include "base/watch.h"
#include "mesh/visible-vertices.h"

typedef struct hr2di_image_points {
  hr2d_point *point;
  size_t count, capacity;
} hr2di_image_points;

/* Appends to `points` the images of those that are there, and of the patch's ends, in walls
   that are near the patch and in front of it at least in part.  With `seen`, which has looked
   from the patch, other walls have no images.  Images at an ellipse of `max` or more are left
   out. Returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_images_add(const hr2d_scene *scene, uint32_t patch, double max,
                             const hr2di_visible_vertices *seen, hr2di_image_points *points,
                             hr2di_watch *watch);

#endif
