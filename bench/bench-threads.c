/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much faster two threads solve to a target than one.

   The machine may have other work, so that wall time says little.  The linker puts a function
   of this program before hr2di_team_run(), which adds up the processor time P of what threads
   share, of the time T of all.  Two idle processors would take T − P/2, if tasks are shared out
   evenly: that is what is compared with the time of one thread.  Medians of several rounds. */
#include <hr2d/hr2d.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/team.h"
#include "support/slow-scenes.h"
#include "timing.h"

enum { ROUNDS = 3 };

#define BAR 1.7

static double shared; /* seconds of processor time in teams of several threads */

void __real_hr2di_team_run(size_t threads, size_t tasks, hr2di_team_fn run, void *ctx,
                           hr2di_watch *watch);
void __wrap_hr2di_team_run(size_t threads, size_t tasks, hr2di_team_fn run, void *ctx,
                           hr2di_watch *watch);

void __wrap_hr2di_team_run(size_t threads, size_t tasks, hr2di_team_fn run, void *ctx,
                           hr2di_watch *watch) {
  const double start = cpu_seconds();
  __real_hr2di_team_run(threads, tasks, run, ctx, watch);
  if (threads > 1 && tasks > 1) shared += cpu_seconds() - start;
}

typedef struct bench {
  const char *file; /* in examples/scenes; NULL: a scene of this kind and size */
  slow_kind kind;
  size_t patches;
  double error;
} bench;

static const bench benches[] = {{"occluders-200.geojson", SLOW_KINDS, 0, 1e-3},
                                {"partition.geojson", SLOW_KINDS, 0, 1e-9},
                                {NULL, SLOW_SQUARES, 1000, 1e-2},
                                {NULL, SLOW_SOUP, 600, 1e-2},
                                {NULL, SLOW_CITY, 1000, 1e-2}};

static hr2d_scene *make(const bench *b) {
  char path[4096];
  hr2d_scene *scene = NULL;
  snprintf(path, sizeof path, "%s/%s", BENCH_SCENES, b->file ? b->file : "");
  if (hr2d_scene_create(NULL, &scene) ||
      (b->file ? hr2d_scene_read(scene, path) : slow_add(scene, b->kind, b->patches)) ||
      hr2d_scene_commit(scene)) {
    fprintf(stderr, "bench_threads: no scene %s\n", path);
    exit(EXIT_FAILURE);
  }
  return scene;
}

/* Processor time of a solve, the part of it that threads share, and wall time. */
static void solve(const bench *b, unsigned threads, double *cpu, double *part, double *wall) {
  hr2d_scene *scene = make(b);
  hr2d_solution *solution = NULL;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = b->error;
  target.threads = threads;
  shared = 0;
  const double start = cpu_seconds(), now = hr2di_clock_now();
  if (hr2d_solve_to(scene, &target, &solution, NULL)) exit(EXIT_FAILURE);
  *wall = hr2di_clock_now() - now;
  *cpu = cpu_seconds() - start;
  *part = shared;
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}

int main(void) {
  printf("%-24s%8s%9s%9s%8s%8s%8s%6s\n", "seconds", "error", "one", "two", "shared", "wall",
         "idle", "bar");
  for (size_t k = 0; k < sizeof benches / sizeof *benches; k++) {
    const bench *b = &benches[k];
    double one[ROUNDS], two[ROUNDS], ideal[ROUNDS], part[ROUNDS], wall[2][ROUNDS], none;
    for (int r = 0; r < ROUNDS; r++) {
      solve(b, 1, &one[r], &none, &wall[0][r]);
      solve(b, 2, &two[r], &part[r], &wall[1][r]);
      ideal[r] = two[r] - part[r] / 2;
      part[r] /= two[r];
    }
    const double alone = median_of(one, ROUNDS), gain = alone / median_of(ideal, ROUNDS);
    printf("%-24s%8.0e%9.3f%9.3f%7.0f%%%8.2f%8.2f%6.1f  %s\n",
           b->file ? b->file : slow_name(b->kind), b->error, alone, median_of(two, ROUNDS),
           100 * median_of(part, ROUNDS),
           median_of(wall[0], ROUNDS) / median_of(wall[1], ROUNDS), gain, BAR,
           gain >= BAR ? "holds" : "MISSED");
  }
  return EXIT_SUCCESS;
}
