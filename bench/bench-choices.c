/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What solves to a target cost with other values of src/base/choices.h, in terms of the values
   there.  bench/choices.sh builds it with a table whose rows are variables.

   bench-choices [NAME=VALUE...]; without NAME half and twice the value of every row.  A line
   for each value and target: how many solves made other elements, links or kernels; of these
   the geometric mean of the ratio of processor times, the smallest and the largest, each the
   median of ROUNDS in turn; the same for links; and how many more of the solves missed the
   target. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/choices.h"
#include "solve-tasks.h"
#include "timing.h"

#ifndef HR2DI_CHOICES
#define HR2DI_CHOICES(row)
#endif
#define ROW(name) {#name, &hr2di_choice_##name},

static const struct choice {
  const char *name;
  double *value;
} choices[] = {HR2DI_CHOICES(ROW){"", NULL}};

#define EXAMPLE(name)                                                                          \
  { name, "examples/scenes/" name ".geojson", NULL, 0, 0, 0 }

static const solve_task tasks[] = {
    EXAMPLE("partition"),
    EXAMPLE("enfilade"),
    EXAMPLE("furnace-walls"),
    EXAMPLE("street-canyon"),
    EXAMPLE("occluders-200"),
    {"boxes-3", "bench/scenes/boxes-3.geojson", NULL, 0, 0, 0},
    {"fibres-30", "bench/scenes/fibres-30.geojson", NULL, 0, 0, 0},
    {"squares", NULL, solve_task_squares, 400, 0, 0},
    {"city", NULL, solve_task_city, 1000, 0, 0},
};
static const double errors[] = {1e-2, 1e-3, 1e-4, 1e-6};

#define LIMIT 20. /* seconds of a solve */

enum {
  TASKS = sizeof tasks / sizeof *tasks,
  ERRORS = sizeof errors / sizeof *errors,
  ROUNDS = 5
};

/* What a solve took; seconds of the processor. */
typedef struct cost {
  hr2d_account account;
  hr2d_status status;
  double seconds;
} cost;

/* A value that no loop is made for may never end one. */
static hr2d_status stop_late(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  return cpu_seconds() > *(const double *)ctx ? HR2D_STOPPED : HR2D_OK;
}

static cost solve(const hr2d_scene *scene, double error) {
  cost c = {0};
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  double end = cpu_seconds() + LIMIT;
  target.error = error;
  target.progress = stop_late;
  target.progress_ctx = &end;
  const double start = cpu_seconds();
  c.status = hr2d_solve_to(scene, &target, &solution, &c.account);
  c.seconds = cpu_seconds() - start;
  hr2d_solution_destroy(solution);
  return c;
}

static int same_work(const cost *a, const cost *b) {
  return a->status == b->status && a->account.elements == b->account.elements &&
         a->account.links == b->account.links && a->account.kernels == b->account.kernels &&
         a->account.solves == b->account.solves;
}

/* Geometric mean and range. */
typedef struct ratios {
  double log_sum, least, most;
  int count;
} ratios;

static void add_ratio(ratios *r, double ratio) {
  if (!r->count || ratio < r->least) r->least = ratio;
  if (!r->count || ratio > r->most) r->most = ratio;
  r->log_sum += log(ratio);
  r->count++;
}

static double time_ratio(const hr2d_scene *scene, double error, double *value, double other) {
  const double usual = *value;
  double ratio[ROUNDS];
  for (int k = 0; k < ROUNDS; k++) {
    const double before = solve(scene, error).seconds;
    *value = other;
    ratio[k] = solve(scene, error).seconds / before;
    *value = usual;
  }
  return median_of(ratio, ROUNDS);
}

static void compare(hr2d_scene *scene[TASKS], cost usual[TASKS][ERRORS], const struct choice *c,
                    double other) {
  const double value = *c->value;
  for (int e = 0; e < ERRORS; e++) {
    ratios time = {0}, links = {0};
    int missed = 0;
    for (int t = 0; t < TASKS; t++) {
      *c->value = other;
      const cost found = solve(scene[t], errors[e]);
      *c->value = value;
      if (same_work(&found, &usual[t][e])) continue;
      missed += (found.status != HR2D_OK) - (usual[t][e].status != HR2D_OK);
      if (found.status == HR2D_STOPPED) continue;
      add_ratio(&links, (double)found.account.links / (double)usual[t][e].account.links);
      add_ratio(&time, time_ratio(scene[t], errors[e], c->value, other));
    }
    if (!time.count && !missed) continue;
    printf("%-22s %-10g -> %-10g %-6g %d of %d  time %5.2f (%.2f to %.2f)  "
           "links %5.2f (%.2f to %.2f)",
           c->name, value, other, errors[e], time.count, TASKS, exp(time.log_sum / time.count),
           time.least, time.most, exp(links.log_sum / links.count), links.least, links.most);
    printf(missed ? "  missed %+d\n" : "\n", missed);
    fflush(stdout);
  }
}

/* The row of NAME=VALUE, and the value; NULL: there is none. */
static const struct choice *find(const char *argument, double *value) {
  const char *equals = strchr(argument, '=');
  if (!equals) return NULL;
  const size_t length = (size_t)(equals - argument);
  for (const struct choice *c = choices; c->value; c++)
    if (strlen(c->name) == length && !strncmp(c->name, argument, length)) {
      *value = strtod(equals + 1, NULL);
      return c;
    }
  return NULL;
}

/* Of a part half of what it leaves, where twice is more than all. */
static double twice(double value) {
  return value < 1 && 2 * value > 1 ? (1 + value) / 2 : 2 * value;
}

int main(int argc, char **argv) {
  hr2d_scene *scene[TASKS];
  static cost usual[TASKS][ERRORS];
  for (int k = 1; k < argc; k++) {
    double value;
    if (find(argv[k], &value)) continue;
    fprintf(stderr, "bench-choices: not NAME=VALUE of a row that can change: %s\n", argv[k]);
    return 2;
  }
  for (int t = 0; t < TASKS; t++) {
    scene[t] = solve_task_scene(&tasks[t]);
    for (int e = 0; e < ERRORS; e++) usual[t][e] = solve(scene[t], errors[e]);
  }
  for (int k = 1; k < argc; k++) {
    double value = 0;
    const struct choice *c = find(argv[k], &value);
    compare(scene, usual, c, value);
  }
  for (const struct choice *c = choices; argc == 1 && c->value; c++) {
    compare(scene, usual, c, *c->value / 2);
    compare(scene, usual, c, twice(*c->value));
  }
  for (int t = 0; t < TASKS; t++) hr2d_scene_destroy(scene[t]);
  return 0;
}
