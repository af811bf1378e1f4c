/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Transformations after which the radiosity of a scene is known from the original's, and of
   which the library cannot know.  All are exact. */
#ifndef HR2D_TESTS_ADVERSARY_TRANSFORM_H
#define HR2D_TESTS_ADVERSARY_TRANSFORM_H

#include "adversary/scene.h"

typedef enum adv_need {
  ADV_ANY,
  ADV_DAY,     /* a sun, or pieces of sky */
  ADV_SYMMETRY /* mirrors, or a period */
} adv_need;

typedef struct adv_transform {
  const char *name;
  int (*apply)(adv_scene *scene, adv_random *r); /* 0: it does not apply, nothing is changed */
  adv_need need;
} adv_transform;

/* Ends with a name of NULL. */
extern const adv_transform adv_transforms[];

/* Images in oblique mirrors are rounded, which their size magnifies: allows for that. */
void adv_allow_images(adv_scene *scene);

/* Those of mirrors and periods; the original is drawn otherwise, and images of patches as well.
   They leave the images of the copy as they are. */
int adv_unfold(adv_scene *scene, adv_random *r);
int adv_cells(adv_scene *scene, adv_random *r);
int adv_negate(adv_scene *scene, adv_random *r);
int adv_redraw(adv_scene *scene, adv_random *r);
int adv_wander(adv_scene *scene, adv_random *r);
int adv_flip(adv_scene *scene, adv_random *r);
int adv_fold(adv_scene *scene, adv_random *r);

#endif
