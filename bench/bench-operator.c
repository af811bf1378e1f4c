/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What other light costs on a kept operator, as a part of a solve to a target with its account:
   another solve with and without an account, one that begins with a solution for light within 2
   percent, the gradient of a functional, and a light of sixteen at once.  Rounds alternate;
   medians of processor time, one thread.

   usage: bench-operator [--long] [NAME]: with --long also scenes of thousands of patches; with
   NAME only those whose names begin like that. */
#include <hr2d/hr2d.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bars.h"
#include "solve-tasks.h"
#include "timing.h"

enum { ROUNDS = 5, LIGHTS = 16 };

typedef enum work { SOLVE, OTHER, ACCOUNT, WARM, GRADIENT, MANY, WORKS } work;

typedef struct stage {
  hr2d_scene *scene;
  hr2d_target target;
  hr2d_operator *op, *many; /* of one light, and of many */
  double *emission, *near; /* LIGHTS × patches × bands, and one within 2 percent of the first */
  double *gradient;
  hr2d_solution *start;
} stage;

static void solve(hr2d_operator *op, const double *emission, size_t count, int account,
                  const hr2d_solution *start, hr2d_solution **kept) {
  hr2d_light light = HR2D_LIGHT_INIT;
  hr2d_solution *solution = NULL;
  light.emission.value = emission;
  light.count = count;
  light.no_error = !account;
  const hr2d_status status = hr2d_operator_solve(op, &light, start, &solution, NULL);
  if (status && status != HR2D_EACCURACY) bars_fail(hr2d_operator_message(op));
  if (kept)
    *kept = solution;
  else
    hr2d_solution_destroy(solution);
}

static void run(stage *s, work w) {
  hr2d_solution *solution = NULL;
  const hr2d_values weights = {s->emission, {0, 0, 0}};
  hr2d_gradient gradient = HR2D_GRADIENT_INIT;
  gradient.emission = s->gradient;
  if (w == SOLVE) {
    if (!hr2d_solve_to(s->scene, &s->target, &solution, NULL) && !solution)
      bars_fail("no solution");
    hr2d_solution_destroy(solution);
  }
  if (w == OTHER) solve(s->op, s->emission, 1, 0, NULL, NULL);
  if (w == ACCOUNT) solve(s->op, s->emission, 1, 1, NULL, NULL);
  if (w == WARM) solve(s->op, s->near, 1, 0, s->start, NULL);
  if (w == GRADIENT && hr2d_operator_gradient(s->op, s->start, &weights, NULL, &gradient))
    bars_fail(hr2d_operator_message(s->op));
  if (w == MANY) solve(s->many, s->emission, LIGHTS, 0, NULL, NULL);
}

static void begin(stage *s, const solve_task *task) {
  *s = (stage){.scene = solve_task_scene(task), .target = HR2D_TARGET_INIT};
  const size_t values = hr2d_scene_patches(s->scene) * hr2d_scene_bands(s->scene);
  s->target.error = task->error;
  s->emission = malloc(LIGHTS * values * sizeof *s->emission);
  s->near = malloc(values * sizeof *s->near);
  s->gradient = malloc(values * sizeof *s->gradient);
  if (!s->emission || !s->near || !s->gradient) bars_fail("no memory");
  for (size_t k = 0; k < LIGHTS * values; k++)
    s->emission[k] = k * 2654435761u % 7 == 0 ? (double)(k % 5 + 1) : 0;
  for (size_t k = 0; k < values; k++) s->near[k] = s->emission[k] * (k % 2 ? 1.02 : 0.98);
  hr2d_operator_create(s->scene, &s->target, &s->op, NULL);
  hr2d_operator_create(s->scene, &s->target, &s->many, NULL);
  if (!s->op || !s->many) bars_fail("no operator");
  solve(s->op, s->emission, 1, 1, NULL, &s->start);
  solve(s->many, s->emission, LIGHTS, 0, NULL, NULL);
}

static void end(stage *s) {
  hr2d_solution_destroy(s->start);
  hr2d_operator_destroy(s->op);
  hr2d_operator_destroy(s->many);
  hr2d_scene_destroy(s->scene);
  free(s->emission);
  free(s->near);
  free(s->gradient);
}

static void measure(const solve_task *task) {
  stage s;
  double seconds[WORKS][ROUNDS], median[WORKS];
  begin(&s, task);
  for (int k = 0; k < ROUNDS; k++)
    for (int w = 0; w < WORKS; w++) {
      const double start = cpu_seconds();
      run(&s, (work)w);
      seconds[w][k] = cpu_seconds() - start;
    }
  for (int w = 0; w < WORKS; w++) median[w] = median_of(seconds[w], ROUNDS);
  printf("%-16s %7g %10.5f", task->name, task->error, median[SOLVE]);
  for (int w = OTHER; w < WORKS; w++)
    printf(" %8.1f", median[SOLVE] / median[w] * (w == MANY ? LIGHTS : 1));
  printf("\n");
  fflush(stdout);
  end(&s);
}

int main(int argc, char **argv) {
  int all = 0;
  const char *name = "";
  for (int k = 1; k < argc; k++)
    if (strcmp(argv[k], "--long") == 0)
      all = 1;
    else
      name = argv[k];
  printf("times as fast as a solve, per light\n%-16s %7s %10s %8s %8s %8s %8s %8s\n", "scene",
         "error", "solve, s", "other", "account", "warm", "gradient", "of 16");
  for (size_t k = 0; k < solve_task_count; k++)
    if (strncmp(solve_tasks[k].name, name, strlen(name)) == 0) measure(&solve_tasks[k]);
  for (size_t k = 0; k < long_solve_task_count && all; k++)
    if (strncmp(long_solve_tasks[k].name, name, strlen(name)) == 0)
      measure(&long_solve_tasks[k]);
  return bars_status();
}
