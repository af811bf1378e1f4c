/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Families of small scenes, each a function of some numbers in [0, 1], its genes.  Neighbouring
   genes give neighbouring scenes, so that an error can be followed uphill. */
#ifndef HR2D_TESTS_ADVERSARY_FAMILIES_H
#define HR2D_TESTS_ADVERSARY_FAMILIES_H

#include "adversary/scene.h"

enum { ADV_GENES = 32 };

typedef struct adv_family {
  const char *name, *what;
  int genes;
  void (*build)(adv_scene *scene, const double *gene);
} adv_family;

/* Ends with a name of NULL. */
extern const adv_family adv_families[];

/* A scene of a family; there may be none, if patches would be shorter than the grid. */
void adv_express(const adv_family *family, const double *gene, adv_scene *scene);

#endif
