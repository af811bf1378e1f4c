/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mirror images: where radiosity is nearly singular on account of a wall close by.

   At height δ above a wall an end of a patch makes the wall's radiosity singular at its foot ±
   iδ. From there, another δ away, it comes back: to the patch it is as if the end's mirror
   image behind the wall were an end, too. */
#ifndef HR2D_SRC_ACCURACY_MIRROR_IMAGES_H
#define HR2D_SRC_ACCURACY_MIRROR_IMAGES_H

#include <hr2d/scene.h>
#include <stdint.h>

typedef struct hr2di_image_points {
  hr2d_point *point;
  size_t count, capacity;
} hr2di_image_points;

/* Appends to `points` the images of its first `count` points, and of the patch's ends, in walls
   near to the patch, as far as they are in front of it and within an ellipse of `max`; HR2D_OK
   or HR2D_ENOMEM. */
hr2d_status hr2di_images_add(const hr2d_scene *scene, uint32_t patch, double max,
                             hr2di_image_points *points, size_t count);

#endif
