/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light on grids of 1000 × 700 nodes within 1e-3 of its range, in units u: the time of the
   plainest recursion that stores 983,056 links, in the same run.

   usage: bench-field [SCENE [ERROR]] */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bars.h"
#include "plain.h"
#include "plans.h"
#include "timing.h"

enum { COLUMNS = 1000, ROWS = 700, RUNS = 3 };

/* Units allowed. */
#define PARTITION_BAR 60
#define FIBRES_BAR    1000

static double unit(void) {
  double seconds[RUNS];
  uint64_t links;
  for (int k = 0; k < RUNS; k++) seconds[k] = plain_run(0.1, 0.0078125, 1, &links);
  return median_of(seconds, RUNS);
}

static hr2d_field_grid grid_around(const hr2d_scene *scene) {
  hr2d_field_grid g = HR2D_FIELD_GRID_INIT;
  g.low = g.high = hr2d_scene_segment(scene, 0).a;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    g.low.x = fmin(g.low.x, fmin(s.a.x, s.b.x));
    g.low.y = fmin(g.low.y, fmin(s.a.y, s.b.y));
    g.high.x = fmax(g.high.x, fmax(s.a.x, s.b.x));
    g.high.y = fmax(g.high.y, fmax(s.a.y, s.b.y));
  }
  g.columns = COLUMNS;
  g.rows = ROWS;
  g.tolerance = 1e-3;
  return g;
}

static void measure(const char *name, const hr2d_scene *scene, double error, double bar) {
  hr2d_solution *solution = NULL;
  hr2d_field_counts counts;
  double *mean = malloc(sizeof *mean * COLUMNS * ROWS * hr2d_scene_bands(scene));
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = error;
  if (!mean) bars_fail("out of memory");
  const double begin = cpu_seconds();
  hr2d_status status = hr2d_solve_to(scene, &target, &solution, NULL);
  if (status && !solution) bars_fail(hr2d_strerror(status));
  const hr2d_field_grid grid = grid_around(scene);
  const hr2d_field_values values = {.struct_size = sizeof values, .mean = mean};
  const double solved = cpu_seconds();
  status = hr2d_field_on_grid(solution, &grid, NULL, &values, &counts);
  if (status) bars_fail(hr2d_strerror(status));
  const double end = cpu_seconds(), u = unit();
  printf("%-10s %7zu %8.4f %8.1f %8.1f %8llu %8llu %8.1f %8.2f\n", name,
         hr2d_scene_patches(scene), u, (solved - begin) / u, (end - solved) / u,
         (unsigned long long)counts.exact, (unsigned long long)counts.interpolated,
         (double)counts.triangles / (double)counts.exact,
         1e6 * (end - solved) / (double)counts.exact);
  if (bar > 0) bars_hold(name, (end - solved) / u, bar);
  hr2d_solution_destroy(solution);
  free(mean);
}

static void measure_file(const char *name, const char *file, double error, double bar) {
  hr2d_scene *scene = NULL;
  if (hr2d_scene_create(NULL, &scene)) bars_fail("no scene");
  if (hr2d_scene_read(scene, file) || hr2d_scene_commit(scene))
    bars_fail(hr2d_scene_message(scene));
  measure(name, scene, error, bar);
  hr2d_scene_destroy(scene);
}

/* Sections of 1000 fibres in a room, of which each tenth shines. */
static void measure_fibres(void) {
  hr2d_scene *drawn = plan_scene(plan_fibres, 8000, 0), *scene = NULL;
  if (hr2d_scene_create(NULL, &scene)) bars_fail("no scene");
  for (size_t k = 0; k < hr2d_scene_patches(drawn); k++) {
    const hr2d_segment at = hr2d_scene_segment(drawn, k);
    const double emission = k >= 4 && (k - 4) / 8 % 10 == 0, reflectance = 0.5;
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = at.a;
    patch.b = at.b;
    patch.emission = &emission;
    patch.reflectance = &reflectance;
    patch.emission_bands = patch.reflectance_bands = 1;
    if (hr2d_scene_add(scene, &patch, NULL)) bars_fail(hr2d_scene_message(scene));
  }
  if (hr2d_scene_commit(scene)) bars_fail(hr2d_scene_message(scene));
  measure("fibres", scene, 0.05, FIBRES_BAR);
  hr2d_scene_destroy(scene);
  hr2d_scene_destroy(drawn);
}

int main(int argc, char **argv) {
  puts("scene      patches  u, sec.  solve,u   grid,u    views   interp. triang./v.  us/view");
  if (argc > 1) {
    measure_file("scene", argv[1], argc > 2 ? atof(argv[2]) : 1e-3, 0);
    return EXIT_SUCCESS;
  }
  measure_file("partition", BENCH_SCENES "/partition.geojson", 1e-3, PARTITION_BAR);
  measure_fibres();
  return bars_status();
}
