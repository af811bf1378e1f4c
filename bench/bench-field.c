/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light on grids of 1000 × 700 nodes within 1e-3 of its range, in units u: the time of the
   plainest recursion that stores 983,056 links, in the same run.

   usage: bench-field [SCENE [EPSILON]] */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "plain.h"
#include "timing.h"

enum { COLUMNS = 1000, ROWS = 700, RUNS = 3 };

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

static hr2d_status measure(const char *file, double error) {
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_field_counts counts;
  double *mean = malloc(sizeof *mean * COLUMNS * ROWS * 8);
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = error;
  hr2d_status status = mean ? hr2d_scene_create(NULL, &scene) : HR2D_ENOMEM;
  if (!status) status = hr2d_scene_read(scene, file);
  if (!status) status = hr2d_scene_commit(scene);
  if (!status && hr2d_scene_bands(scene) > 8) status = HR2D_EINVAL;
  const double begin = cpu_seconds();
  if (!status) status = hr2d_solve_to(scene, &target, &solution, NULL);
  const double solved = cpu_seconds();
  if (!status) {
    const hr2d_field_grid grid = grid_around(scene);
    const hr2d_field_values values = {.struct_size = sizeof values, .mean = mean};
    status = hr2d_field_on_grid(solution, &grid, NULL, &values, &counts);
  }
  const double end = cpu_seconds(), u = unit();
  if (!status)
    printf(
        "%s: u %.4f s, solve %.1f u, grid %.1f u; %llu views, %llu of %d nodes interpolated, "
        "%.1f triangles and %.2f us a view\n",
        file, u, (solved - begin) / u, (end - solved) / u, (unsigned long long)counts.exact,
        (unsigned long long)counts.interpolated, COLUMNS * ROWS,
        (double)counts.triangles / (double)counts.exact,
        1e6 * (end - solved) / (double)counts.exact);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  free(mean);
  return status;
}

int main(int argc, char **argv) {
  const char *file = argc > 1 ? argv[1] : BENCH_SCENES "/partition.geojson";
  const hr2d_status status = measure(file, argc > 2 ? atof(argv[2]) : 1e-3);
  if (status) fprintf(stderr, "bench-field: %s: %s\n", file, hr2d_strerror(status));
  return status != HR2D_OK;
}
