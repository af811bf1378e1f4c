/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures what solves to a target take, in units of u: the time in which the plainest
   recursion stores 983,056 links of two patches, measured in the same run.

   bench-solves [--long [SECONDS]] [NAME]: with --long also scenes of thousands of patches; no
   solve takes longer than SECONDS, 60 unless given.  With NAME only scenes whose names begin
   like that. */
#include <hr2d/hr2d.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "plain.h"
#include "solve-tasks.h"
#include "timing.h"

enum { ROUNDS = 9, FEW = 3 };

/* A median of FEW runs, for solves that take no longer. */
#define SHORT 2.0

static double measure_unit(void) {
  double time[ROUNDS];
  uint64_t links;
  for (int k = 0; k < ROUNDS; k++) time[k] = plain_run(0.1, 1. / 128, 1, &links);
  return median_of(time, ROUNDS);
}

static hr2d_status stop_late(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  return hr2di_clock_now() > *(const double *)ctx ? HR2D_STOPPED : HR2D_OK;
}

/* Seconds, and the account in the last of them. */
static double solve_once(const hr2d_scene *scene, const hr2d_target *target,
                         hr2d_account *account, hr2d_status *status) {
  hr2d_solution *solution = NULL;
  const double start = hr2di_clock_now();
  *status = hr2d_solve_to(scene, target, &solution, account);
  hr2d_solution_destroy(solution);
  return hr2di_clock_now() - start;
}

static void run(const solve_task *t, double limit) {
  hr2d_scene *scene = solve_task_scene(t);
  const double unit = measure_unit();
  hr2d_account account[FEW];
  double time[FEW], end = hr2di_clock_now() + limit;
  hr2d_status status;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = t->error;
  target.progress = stop_late;
  target.progress_ctx = &end;
  int runs = 0;
  do {
    time[runs] = solve_once(scene, &target, &account[runs], &status);
    runs++;
  } while (runs < FEW && time[0] < SHORT);
  const hr2d_account *a = &account[0];
  const double seconds = runs == FEW ? median_of(time, FEW) : time[0],
               of_error = a->error_seconds;
  const double solve = a->refine_seconds + a->coefficients_seconds + a->solve_seconds;
  printf("%-16s%7zu%8.0e%9.1f%7.0f%9.3f%9.3f%9.3f%9.2f%8u%9llu%10llu%13llu%10.1e%10.1e  %s%s\n",
         t->name, hr2d_scene_patches(scene), t->error, seconds / unit, t->bar, seconds, solve,
         of_error, of_error / solve, a->order, (unsigned long long)a->elements,
         (unsigned long long)a->links, (unsigned long long)a->kernels, a->average.estimate,
         a->average.bound, status ? hr2d_strerror(status) : "",
         t->bar > 0 && seconds > t->bar * unit ? " ABOVE THE BAR" : "");
  fflush(stdout);
  hr2d_scene_destroy(scene);
}

static void run_all(const solve_task *list, size_t count, const char *name, double limit) {
  for (size_t k = 0; k < count; k++)
    if (strncmp(list[k].name, name, strlen(name)) == 0) run(&list[k], limit);
}

int main(int argc, char **argv) {
  double limit = 60;
  int at = 1, all = 0;
  if (at < argc && strcmp(argv[at], "--long") == 0) {
    all = 1;
    at++;
    char *rest = NULL;
    const double seconds = at < argc ? strtod(argv[at], &rest) : 0;
    if (seconds > 0 && *rest == '\0') {
      limit = seconds;
      at++;
    }
  }
  const char *name = at < argc ? argv[at] : "";
  printf("u = %.2f ms; one thread; the error costs error/solve of the solve\n",
         1e3 * measure_unit());
  printf("%-16s%7s%8s%9s%7s%9s%9s%9s%9s%8s%9s%10s%13s%10s%10s\n", "scene", "patches", "target",
         "u", "bar", "s", "solve s", "error s", "ratio", "order", "N", "L", "kernels",
         "estimate", "bound");
  run_all(solve_tasks, solve_task_count, name, limit);
  if (all) run_all(long_solve_tasks, long_solve_task_count, name, limit);
  return EXIT_SUCCESS;
}
