/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches that stand back to back, as the two sides of a wall, have images that do, too.

   An end of one that lies within the other is, in an image, off the line of the other by some
   roundings.  Where it comes to its front the two would see nothing but each other.  Ends of
   images are moved behind, by no more than that. */
#ifndef HR2D_SRC_SCENE_BACK_TO_BACK_H
#define HR2D_SRC_SCENE_BACK_TO_BACK_H

#include <hr2d/geometry.h>
#include <stddef.h>

#include "base/watch.h"
#include "geometry/crossings.h"

struct hr2d_scene;

/* An end of an image, and where it goes; both scaled. */
typedef struct hr2di_step {
  hr2d_point from, to;
} hr2di_step;

typedef struct hr2di_steps {
  hr2di_step *step;
  size_t count, capacity;
} hr2di_steps;

/* Notes what has to be moved so that i and j, of which one is an image, no longer face each
   other.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_steps_add(hr2di_steps *steps, const struct hr2d_scene *scene, size_t i,
                            size_t j, const hr2di_meeting *m);

/* Moves all ends of images that are where a step begins, and forgets the steps. */
hr2d_status hr2di_steps_take(hr2di_steps *steps, struct hr2d_scene *scene, hr2di_watch *watch);

#endif
