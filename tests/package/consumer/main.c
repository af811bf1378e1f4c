/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An outside program in C: a glowing floor under a grey ceiling of the same width and
   height.  By crossed strings AF = √2 − 1, and where nothing is subdivided and the
   black floor sends nothing back the ceiling's radiosity is ρ·AF. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int solve(double reflectance, double *average) {
  const double one = 1;
  hr2d_patch floor = HR2D_PATCH_INIT, ceiling = HR2D_PATCH_INIT;
  floor.b.x = 1;
  floor.emission = &one;
  floor.emission_bands = 1;
  ceiling.a = (hr2d_point){1, 1};
  ceiling.b = (hr2d_point){0, 1};
  ceiling.reflectance = &reflectance;
  ceiling.reflectance_bands = 1;

  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.max_level = HR2D_NO_SUBDIVISION;

  hr2d_scene *scene = NULL;
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2d_solution *solution = NULL;
  const int ok = !hr2d_scene_create(NULL, &scene) && !hr2d_scene_add(scene, &floor, NULL) &&
                 !hr2d_scene_add(scene, &ceiling, NULL) && !hr2d_scene_commit(scene) &&
                 !hr2d_hierarchy_create(scene, &hierarchy) &&
                 !hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links) &&
                 !hr2d_refine(links, &options) && !hr2d_solve(links, NULL, &solution);
  if (ok) *average = hr2d_solution_average(solution, 1, 0);
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
  return ok;
}

int main(void) {
  double average = 0;
  if (strcmp(hr2d_version(), HR2D_VERSION) != 0) {
    fprintf(stderr, "header %s, library %s\n", HR2D_VERSION, hr2d_version());
    return 1;
  }
  if (!solve(0.5, &average) || fabs(average - 0.5 * (sqrt(2) - 1)) > 1e-14) {
    fprintf(stderr, "ceiling %.17g, not (√2 − 1)/2\n", average);
    return 1;
  }
  return 0;
}
