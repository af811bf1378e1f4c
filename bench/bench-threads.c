/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much faster two threads solve to a target than one.

   The machine may have other work, so that wall time says little.  The linker puts a function
   of this program before hr2di_team_run(), which adds up the processor time P of what threads
   share, of the time T of all.  Two idle processors would take T − P/2, if tasks are shared out
   evenly: that is what is compared with the time of one thread.  Medians of several rounds.

   bench-threads [--long] [NAME]: with --long also scenes of thousands of patches, once; with
   NAME only those whose names begin like that. */
#include <hr2d/hr2d.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/team.h"
#include "solve-tasks.h"
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

static const solve_task short_tasks[] = {
    {"occluders-200", "examples/scenes/occluders-200.geojson", NULL, 0, 1e-3, 0},
    {"partition", "examples/scenes/partition.geojson", NULL, 0, 1e-9, 0},
    {"squares", NULL, solve_task_squares, 1000, 1e-2, 0},
    {"soup", NULL, solve_task_soup, 600, 1e-2, 0},
    {"city", NULL, solve_task_city, 1000, 1e-2, 0}};

/* Processor time of a solve, the part of it that threads share, and wall time. */
static void solve(const solve_task *t, unsigned threads, double *cpu, double *part,
                  double *wall) {
  hr2d_scene *scene = solve_task_scene(t);
  hr2d_solution *solution = NULL;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = t->error;
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

static void measure(const solve_task *t, int rounds, const char *name) {
  double one[ROUNDS], two[ROUNDS], ideal[ROUNDS], part[ROUNDS], wall[2][ROUNDS], none;
  if (strncmp(t->name, name, strlen(name)) != 0) return;
  for (int r = 0; r < rounds; r++) {
    solve(t, 1, &one[r], &none, &wall[0][r]);
    solve(t, 2, &two[r], &part[r], &wall[1][r]);
    ideal[r] = two[r] - part[r] / 2;
    part[r] /= two[r];
  }
  const double alone = median_of(one, rounds), gain = alone / median_of(ideal, rounds);
  printf("%-16s%8.0e%9.3f%9.3f%7.0f%%%8.2f%8.2f%6.1f  %s\n", t->name, t->error, alone,
         median_of(two, rounds), 100 * median_of(part, rounds),
         median_of(wall[0], rounds) / median_of(wall[1], rounds), gain, BAR,
         gain >= BAR ? "holds" : "MISSED");
  fflush(stdout);
}

int main(int argc, char **argv) {
  const int all = argc > 1 && strcmp(argv[1], "--long") == 0;
  const char *name = argc > 1 + all ? argv[1 + all] : "";
  printf("%-16s%8s%9s%9s%8s%8s%8s%6s\n", "seconds", "error", "one", "two", "shared", "wall",
         "idle", "bar");
  for (size_t k = 0; k < sizeof short_tasks / sizeof *short_tasks; k++)
    measure(&short_tasks[k], ROUNDS, name);
  for (size_t k = 0; k < long_solve_task_count && all; k++)
    measure(&long_solve_tasks[k], 1, name);
  return EXIT_SUCCESS;
}
