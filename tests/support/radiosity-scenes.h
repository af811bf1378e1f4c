/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes of the radiosity tables, with their known B.  Without Check, because benchmarks
   use it too. */
#ifndef HR2D_TESTS_SUPPORT_RADIOSITY_SCENES_H
#define HR2D_TESTS_SUPPORT_RADIOSITY_SCENES_H

#include <hr2d/hr2d.h>

enum { RADIOSITY_MOST_PATCHES = 6, RADIOSITY_MOST_SCENES = 64 };

typedef struct radiosity_scene {
  char name[64];
  size_t patches;
  double patch[RADIOSITY_MOST_PATCHES][6]; /* ax ay bx by E ρ */
  char label[RADIOSITY_MOST_PATCHES][32];
  double average[RADIOSITY_MOST_PATCHES];                               /* of B */
  double quarter[RADIOSITY_MOST_PATCHES], half[RADIOSITY_MOST_PATCHES]; /* B at t = ¼, ½ */
} radiosity_scene;

typedef struct radiosity_scenes {
  size_t count;
  radiosity_scene scene[RADIOSITY_MOST_SCENES];
} radiosity_scenes;

/* Sets the name and the patches of a scene: "par0.1", "orth10", "par_d0.1_rho0.5",
   "orth_touch_rho0.7", "square_rho0.9", "square_furnace_rho0.9", "occ_square_walls0.5_occ0.5".
   0, or −1 for a name of another form. */
int radiosity_scene_name(radiosity_scene *scene, const char *name);

/* Reads a table with the columns scene, patch, avgB, B_quarter and B_half; the name of a scene
   gives its patches.  0, or −1 if the table cannot be read. */
int radiosity_scenes_read(const char *path, radiosity_scenes *scenes);

/* The scene of that name, or NULL. */
const radiosity_scene *radiosity_scenes_find(const radiosity_scenes *scenes, const char *name);

/* A committed scene, or NULL; hooks as of hr2d_scene_create(). */
hr2d_scene *radiosity_scene_make(const radiosity_scene *scene, const hr2d_allocator *hooks);

/* The largest relative error of a patch's average. */
double radiosity_average_error(const radiosity_scene *scene, const hr2d_solution *solution);

#endif
