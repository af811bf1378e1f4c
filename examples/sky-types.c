/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A street from north to south under the skies of ISO 15469: what the ground and the walls of
   10 m get for 100 klx of a horizontal surface in the open, with the sun in the south-east at
   35 degrees.  Direct light of the sun is not part of it. */
#include <hr2d/hr2d.h>
#include <stdio.h>

static hr2d_status solve(int type, double *h) {
  /* Fronts look into the street: its ground, the wall in the east and the wall in the west. */
  static const hr2d_segment part[] = {
      {{0, 0}, {12, 0}}, {{12, 0}, {12, 10}}, {{0, 10}, {0, 0}}};
  static const double rho = 0.3;
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_sky sky = HR2D_SKY_INIT;
  sky.irradiance = 100;
  sky.sun_elevation = 35;
  sky.sun_azimuth = 135;
  sky.section_azimuth = 90; /* +x is in the east */
  target.error = 1e-6;
  hr2d_status status = hr2d_sky_cie(type, &sky);
  if (!status) status = hr2d_scene_create(NULL, &scene);
  if (!status) status = hr2d_scene_set_continuous_sky(scene, &sky, 1);
  for (int k = 0; k < 3 && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = part[k].a;
    patch.b = part[k].b;
    patch.reflectance = &rho;
    patch.reflectance_bands = 1;
    status = hr2d_scene_add(scene, &patch, NULL);
  }
  if (!status) status = hr2d_scene_commit(scene);
  if (!status) status = hr2d_solve_to(scene, &target, &solution, NULL);
  for (size_t k = 0; k < 3 && !status; k++) h[k] = hr2d_solution_irradiance(solution, k, 0);
  if (status) fprintf(stderr, "sky %d: %s\n", type, hr2d_scene_message(scene));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return status;
}

int main(void) {
  static const int types[] = {1, 16, 3, 5, 7, 10, 12, 13, 15};
  printf("sky  ground  east wall  west wall\n");
  for (size_t k = 0; k < sizeof types / sizeof *types; k++) {
    double h[3];
    if (solve(types[k], h)) return 1;
    printf("%3d  %6.2f  %9.2f  %9.2f\n", types[k], h[0], h[1], h[2]);
  }
  return 0;
}
