/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Transformations after which the radiosity of a scene is known from the original's, and of
   which the library cannot know.  All are exact. */
#ifndef HR2D_TESTS_ADVERSARY_TRANSFORM_H
#define HR2D_TESTS_ADVERSARY_TRANSFORM_H

#include "adversary/scene.h"

typedef struct adv_transform {
  const char *name;
  int (*apply)(adv_scene *scene, adv_random *r); /* 0: it does not apply, nothing is changed */
  int of_day; /* for scenes with a sun or pieces of sky alone; these are the last ones */
} adv_transform;

/* Ends with a name of NULL. */
extern const adv_transform adv_transforms[];

#endif
