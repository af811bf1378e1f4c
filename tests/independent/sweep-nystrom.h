/* SPDX-License-Identifier: GPL-3.0-or-later */
/* B and H in scenes with occluders, absorbers and light from outside, by a method that shares
   nothing with the library: the Nyström method on panels that follow B, and H as the integral
   of B over the sine of all directions. */
#ifndef HR2D_TESTS_INDEPENDENT_SWEEP_NYSTROM_H
#define HR2D_TESTS_INDEPENDENT_SWEEP_NYSTROM_H

#include <stddef.h>

#include "independent/point-sweep.h"

enum { SWEPT_BANDS = 2 };

typedef struct swept_light {
  double emission[SWEPT_BANDS], reflectance[SWEPT_BANDS];
} swept_light;

typedef struct swept_scene {
  sweep_patches patches;
  const swept_light *light; /* of each patch */
  size_t bands;
  double background[SWEPT_BANDS];
} swept_scene;

/* How fine: Gauss points of a panel, and by how much B may differ from the polynomial of a
   panel, relative to the largest. */
typedef struct swept_mesh {
  size_t points;
  double tolerance;
} swept_mesh;

typedef struct swept_solution swept_solution;

/* The scene must outlive the solution, which the caller destroys. */
swept_solution *swept_solve(const swept_scene *scene, swept_mesh mesh);
void swept_destroy(swept_solution *solution);
size_t swept_nodes(const swept_solution *solution);

/* H of all bands at a place of a patch, 0 < t < 1, and its average over the patch. */
void swept_at(const swept_solution *solution, size_t patch, real t, double *irradiance);
void swept_average(const swept_solution *solution, size_t patch, double *irradiance);

#endif
