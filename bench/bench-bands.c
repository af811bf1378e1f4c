/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many right-hand sides at once: in band b patch b·(patches/bands) of a scene alone emits 1.
   The time of a solve to a target with its account, and that per band as a part of the time of
   one band, in the same run.

   usage: bench-bands [SCENE ERROR BANDS...] */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bars.h"
#include "plans.h"
#include "timing.h"

enum { RUNS = 3 };

/* Of the time of one band, per band from four on. */
#define BAR 0.6

/* The patches of a scene with their first reflectance and other emissions. */
static hr2d_scene *with_bands(const hr2d_scene *of, size_t bands) {
  const size_t patches = hr2d_scene_patches(of);
  hr2d_scene *scene = NULL;
  double *emission = malloc(bands * sizeof *emission);
  if (!emission || hr2d_scene_create(NULL, &scene)) bars_fail("no scene");
  for (size_t k = 0; k < patches; k++) {
    const hr2d_segment at = hr2d_scene_segment(of, k);
    const double rho = hr2d_scene_reflectance(of, k, 0);
    hr2d_patch patch = HR2D_PATCH_INIT;
    for (size_t b = 0; b < bands; b++) emission[b] = k == b * (patches / bands);
    patch.a = at.a;
    patch.b = at.b;
    patch.emission = emission;
    patch.emission_bands = bands;
    patch.reflectance = &rho;
    patch.reflectance_bands = 1;
    if (hr2d_scene_add(scene, &patch, NULL)) bars_fail("no patch");
  }
  free(emission);
  if (hr2d_scene_commit(scene)) bars_fail(hr2d_scene_message(scene));
  return scene;
}

static double measure(const hr2d_scene *of, double error, size_t bands, hr2d_account *account) {
  hr2d_scene *scene = with_bands(of, bands);
  double seconds[RUNS];
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = error;
  target.threads = 1;
  for (int k = 0; k < RUNS; k++) {
    hr2d_solution *solution = NULL;
    const double begin = cpu_seconds();
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
    seconds[k] = cpu_seconds() - begin;
    if (status && !solution) bars_fail(hr2d_strerror(status));
    hr2d_solution_destroy(solution);
  }
  hr2d_scene_destroy(scene);
  return median_of(seconds, RUNS);
}

static void measure_file(const char *file, double error, size_t count, const size_t *bands) {
  hr2d_scene *scene = NULL;
  hr2d_account account;
  if (hr2d_scene_create(NULL, &scene)) bars_fail("no scene");
  if (hr2d_scene_read(scene, file) || hr2d_scene_commit(scene))
    bars_fail(hr2d_scene_message(scene));
  const double one = measure(scene, error, 1, &account);
  printf("%s to %g\n%6s %9s %9s %9s %9s %9s\n", file, error, "bands", "s", "times one",
         "per band", "order", "links");
  for (size_t k = 0; k < count; k++) {
    const double all = bands[k] == 1 ? one : measure(scene, error, bands[k], &account);
    const double part = all / one / (double)bands[k];
    printf("%6zu %9.4f %9.2f %9.2f %9u %9llu\n", bands[k], all, all / one, part, account.order,
           (unsigned long long)account.links);
    fflush(stdout);
    if (bands[k] >= 4) bars_hold("a band of many", part, BAR);
  }
  hr2d_scene_destroy(scene);
}

int main(int argc, char **argv) {
  enum { MOST = 16 };
  size_t bands[MOST] = {1, 2, 3, 4, 5, 8, 16}, count = 7;
  if (argc > 3) {
    for (count = 0; count < MOST && count + 3 < (size_t)argc; count++)
      bands[count] = (size_t)strtoul(argv[count + 3], NULL, 10);
    measure_file(argv[1], strtod(argv[2], NULL), count, bands);
  } else {
    measure_file(BENCH_SCENES "/partition.geojson", 1e-6, count, bands);
    measure_file(BENCH_SCENES "/occluders-200.geojson", 1e-3, count, bands);
  }
  return bars_status();
}
