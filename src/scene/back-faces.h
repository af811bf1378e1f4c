/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The backs of patches that have a front only: black, and opaque to the background. */
#ifndef HR2D_SRC_SCENE_BACK_FACES_H
#define HR2D_SRC_SCENE_BACK_FACES_H

#include <hr2d/scene.h>
#include <stdint.h>

#include "base/watch.h"

/* A part of the back of a patch, directed as its front would be. */
typedef struct hr2di_back {
  hr2d_segment at;
  uint32_t patch;
} hr2di_back;

typedef struct hr2di_backs {
  hr2di_back *back;
  size_t count, capacity;
} hr2di_backs;

/* Appends the parts of backs that no patch covers with its front.  Returns HR2D_OK; or,
   with some of the parts appended, HR2D_ENOMEM or the status of the watch.  Cost O(n²). */
hr2d_status hr2di_backs_init(const hr2d_scene *scene, hr2di_backs *backs, hr2di_watch *watch);

#endif
