/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random scenes of every kind of light and shape, small enough to be solved to many digits. */
#ifndef HR2D_TESTS_SUPPORT_ACCURACY_SCENES_H
#define HR2D_TESTS_SUPPORT_ACCURACY_SCENES_H

#include <hr2d/hr2d.h>
#include <stdio.h>

#include "support/room-plans.h"

enum { ACCURACY_BANDS = 3 };

typedef struct accuracy_scene {
  const char *shape;
  int open; /* not a room */
  plan plan;
  size_t bands;
  double (*emission)[ACCURACY_BANDS]; /* of each wall */
  double (*reflectance)[ACCURACY_BANDS];
  double background[ACCURACY_BANDS];
} accuracy_scene;

/* Scene number k of a seed: rooms with and without obstacles, open scenes, patches that
   touch at any angle or stand on each other; up to three bands; reflectances from 0 to
   `max`, some of them equal to `max`. */
accuracy_scene accuracy_draw(uint64_t seed, int k, double max);
void accuracy_free(accuracy_scene *s);

/* The sources for which B = 1; black backs would be colder than all that. */
void accuracy_set_isothermal(accuracy_scene *s);

/* Sources of 1 in a single band, with the largest reflectances of all bands.  Then the
   largest B is κ = ‖(I − ρK)⁻¹‖∞, the factor by which an error of any source may grow. */
void accuracy_set_uniform(accuracy_scene *s);

/* A committed scene. */
hr2d_scene *accuracy_make(const accuracy_scene *s);

/* Rooms of 1 × 1 in a row, with doors of 0.1 between them that are not in line; light in the
   first.  All walls reflect .5 but the last, which reflects `last`. */
hr2d_scene *accuracy_enfilade(int count, double last);

/* As GeoJSON. */
void accuracy_print(FILE *out, const accuracy_scene *s);

#endif
