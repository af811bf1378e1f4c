/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the cost of the public vtables against the plainest recursion that does the same
   work.

   Both refine two unit patches at distance 0.1 with max(A)/r ≤ ε, original variant,
   in rounds that alternate; medians and their ratios are printed.  The recursion
   grows the same trees (N is counted, too), decides by A² ≤ ε²r², and stores what a
   link needs, with the textbook's crossed strings. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "plain.h"
#include "timing.h"

enum { ROUNDS = 7 };

static double run_library(hr2d_scene *scene, double epsilon, int stored, uint64_t *links,
                          double *bytes) {
  const double start = hr2di_clock_now();
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *set = NULL;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2d_refine_counts counts = {0};
  options.epsilon = epsilon;
  if (hr2d_hierarchy_create(scene, &hierarchy) ||
      hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &set) ||
      (stored ? hr2d_refine(set, &options) : hr2d_refine_count(set, &options, &counts)))
    exit(EXIT_FAILURE);
  const double seconds = hr2di_clock_now() - start;
  *links = stored ? hr2d_linkset_size(set) : counts.links;
  *bytes = (double)hr2d_linkset_bytes(set) / (double)*links;
  hr2d_linkset_destroy(set);
  hr2d_hierarchy_destroy(hierarchy);
  return seconds;
}

/* Gather, push and pull: the cost of one sweep per link. */
static double run_sweeps(hr2d_scene *scene, double epsilon, uint64_t *links) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *set = NULL;
  hr2d_solution *solution = NULL;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  if (hr2d_hierarchy_create(scene, &hierarchy) ||
      hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &set) ||
      hr2d_refine(set, &options))
    exit(EXIT_FAILURE);
  const double start = hr2di_clock_now();
  if (hr2d_solve(set, NULL, &solution)) exit(EXIT_FAILURE);
  const double seconds = hr2di_clock_now() - start;
  *links = hr2d_linkset_size(set) * hr2d_solution_work(solution).gathers;
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(set);
  hr2d_hierarchy_destroy(hierarchy);
  return seconds;
}

static hr2d_scene *make_scene(void) {
  const double half = 0.5, one = 1;
  const hr2d_patch floor = {.a = {0, 0},
                            .b = {1, 0},
                            .emission = &one,
                            .emission_bands = 1,
                            .reflectance = &half,
                            .reflectance_bands = 1};
  const hr2d_patch ceiling = {
      .a = {1, .1}, .b = {0, .1}, .reflectance = &half, .reflectance_bands = 1};
  hr2d_scene *scene = NULL;
  if (hr2d_scene_create(NULL, &scene) || hr2d_scene_add(scene, &floor, NULL) ||
      hr2d_scene_add(scene, &ceiling, NULL) || hr2d_scene_commit(scene))
    exit(EXIT_FAILURE);
  return scene;
}

int main(int argc, char **argv) {
  const double epsilon = argc > 1 ? strtod(argv[1], NULL) : 1. / 256;
  hr2d_scene *scene = make_scene();
  double time[6][ROUNDS], bytes = 0, unused;
  uint64_t links[6];
  for (int k = 0; k < ROUNDS; k++) {
    time[0][k] = plain_run(0.1, epsilon, 1, &links[0]);
    time[1][k] = run_library(scene, epsilon, 1, &links[1], &bytes);
    time[2][k] = plain_run(0.1, epsilon, 0, &links[2]);
    time[3][k] = run_library(scene, epsilon, 0, &links[3], &unused);
    time[4][k] = plain_count(0.1, epsilon, &links[4]);
    time[5][k] = run_sweeps(scene, epsilon, &links[5]);
  }
  hr2d_scene_destroy(scene);
  if (links[0] != links[1] || links[2] != links[3] || links[0] != links[4]) {
    fprintf(stderr, "bench_refine: the numbers of links differ\n");
    return EXIT_FAILURE;
  }
  double median[6];
  for (int k = 0; k < 6; k++) median[k] = 1e9 * median_of(time[k], ROUNDS) / (double)links[k];
  printf("two unit patches, d = 0.1, epsilon = %g: L = %llu; ns per link, medians of %d\n",
         epsilon, (unsigned long long)links[0], ROUNDS);
  printf("%-34s%9s%9s%8s\n", "", "library", "plain", "ratio");
  printf("%-34s%9.2f%9.2f%8.2f\n", "refine, exact areas, stored", median[1], median[0],
         median[1] / median[0]);
  printf("%-34s%9.2f%9.2f%8.2f\n", "count, with trees", median[3], median[2],
         median[3] / median[2]);
  printf("%-34s%9.2f%9.2f%8.2f\n", "count, plain without trees or N", median[3], median[4],
         median[3] / median[4]);
  printf("%-34s%9.2f\n", "solve, per link and sweep", median[5]);
  printf("%-34s%9.2f\n", "bytes per stored link", bytes);
  return EXIT_SUCCESS;
}
