/* The shortest whole program, with the paper's algorithm step by step: scene, hierarchy, link
   set, refinement, solution.  You learn the objects and the order in which they are made.

   The scene is a lit floor under a ceiling. */
#include <hr2d/hr2d.h>
#include <stdio.h>

int main(void) {
  const double lit = 1, grey = 0.5;
  hr2d_patch floor = {.a = {0, 0},
                      .b = {1, 0},
                      .emission = &lit,
                      .emission_bands = 1,
                      .reflectance = &grey,
                      .reflectance_bands = 1};
  hr2d_patch ceiling = {
      .a = {1, 0.1}, .b = {0, 0.1}, .reflectance = &grey, .reflectance_bands = 1};
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 1. / 64;

  hr2d_scene *scene = NULL;
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2d_solution *solution = NULL;
  int ok = !hr2d_scene_create(NULL, &scene) && !hr2d_scene_add(scene, &floor, NULL) &&
           !hr2d_scene_add(scene, &ceiling, NULL) && !hr2d_scene_commit(scene) &&
           !hr2d_hierarchy_create(scene, &hierarchy) &&
           !hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links) &&
           !hr2d_refine(links, &options) && !hr2d_solve(links, NULL, &solution);
  if (ok)
    printf("floor %.4f  ceiling %.4f\n", hr2d_solution_average(solution, 0, 0),
           hr2d_solution_average(solution, 1, 0));
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
  return !ok;
}
