/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures what is done of a call when its time is up: how long it goes on.

   Usage: bench_budgets [PATCHES [SECONDS [CALL [KIND]]]].  For every call, or one, of every
   kind of scene, or one: the time that it took, by the wall, and how long it worked after
   SECONDS were over, in processor time of this process, on which other programs have little
   influence. A call that has no budget of its own gets one through its callback.  Fails where
   that is longer than a tenth of the budget, and than SLACK. */
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/time.h>

#include "budget-scenes.h"
#include "timing.h"

#define SLACK .2
/* Seconds for a scene that is given, which is left out if they do not suffice. */
#define MAKES   60
#define STOPPED ((hr2d_status)77)

/* Set by the alarm when the time is up; negative before. */
static volatile double cpu_then;

static void note(int signal) {
  (void)signal;
  cpu_then = cpu_seconds();
}

static double wall_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static hr2d_status ask(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  return wall_seconds() >= *(const double *)ctx ? STOPPED : HR2D_OK;
}

typedef struct stage {
  hr2d_scene *scene;
  int committed;
  hr2d_solution *solution; /* for a field; NULL: there is none */
  double seconds, end;
} stage;

static hr2d_status commit(stage *s) {
  hr2d_scene_set_progress(s->scene, ask, &s->end);
  const hr2d_status status = hr2d_scene_commit(s->scene);
  hr2d_scene_set_progress(s->scene, NULL, NULL);
  s->committed = !status;
  return status;
}

static hr2d_status ignore(void *ctx, const hr2d_warning *warning) {
  (void)ctx;
  (void)warning;
  return HR2D_OK;
}

static hr2d_status lint(stage *s) {
  hr2d_lint_options o = HR2D_LINT_OPTIONS_INIT;
  o.progress = ask;
  o.progress_ctx = &s->end;
  return hr2d_scene_lint(s->scene, ignore, NULL, &o);
}

static hr2d_status predict(stage *s) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_prediction prediction;
  target.error = 1e-2;
  target.progress = ask;
  target.progress_ctx = &s->end;
  return hr2d_predict(s->scene, &target, &prediction);
}

static hr2d_status rows(stage *s) {
  hr2d_matrix_options o = HR2D_MATRIX_OPTIONS_INIT;
  hr2d_exchange_rows *made = NULL;
  o.progress = ask;
  o.progress_ctx = &s->end;
  const hr2d_status status = hr2d_exchange_rows_create(s->scene, &o, &made, NULL);
  hr2d_exchange_rows_destroy(made);
  return status;
}

/* With a budget of its own, to the end of what it has to free. */
static hr2d_status solve(stage *s) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-2;
  target.seconds = s->seconds;
  return hr2d_solve_to(s->scene, &target, &s->solution, NULL);
}

static hr2d_status field(stage *s) {
  enum { SIDE = 150 };
  double *mean = malloc(SIDE * SIDE * hr2d_scene_bands(s->scene) * sizeof *mean);
  hr2d_field_grid grid = HR2D_FIELD_GRID_INIT;
  grid.low = hr2d_scene_segment(s->scene, 0).a;
  grid.high = hr2d_scene_segment(s->scene, hr2d_scene_patches(s->scene) / 2).b;
  if (grid.high.x <= grid.low.x) grid.high.x = grid.low.x + 1;
  if (grid.high.y <= grid.low.y) grid.high.y = grid.low.y + 1;
  grid.columns = grid.rows = SIDE;
  grid.tolerance = .01;
  const hr2d_field_options o = {
      .struct_size = sizeof o, .progress = ask, .progress_ctx = &s->end};
  const hr2d_field_values values = {.struct_size = sizeof values, .mean = mean};
  const hr2d_status status = !mean ? HR2D_ENOMEM
                             : s->solution
                                 ? hr2d_field_on_grid(s->solution, &grid, &o, &values, NULL)
                                 : HR2D_OK;
  free(mean);
  return status;
}

static const struct {
  const char *name;
  hr2d_status (*run)(stage *s);
} calls[] = {{"commit", commit},   {"lint", lint},   {"rows", rows},
             {"predict", predict}, {"solve", solve}, {"field", field}};
enum { CALLS = sizeof calls / sizeof *calls };

/* Returns how long it went on. */
static double measure(stage *s, const char *kind, size_t call) {
  const double us = 1e6 * s->seconds, start = wall_seconds();
  const struct itimerval alarm = {.it_value = {(time_t)(us / 1e6), (suseconds_t)us % 1000000}},
                         none = {{0, 0}, {0, 0}};
  cpu_then = -1;
  s->end = start + s->seconds;
  setitimer(ITIMER_REAL, &alarm, NULL);
  const hr2d_status status = calls[call].run(s);
  const double end = wall_seconds(), over = cpu_then < 0 ? 0 : cpu_seconds() - cpu_then;
  setitimer(ITIMER_REAL, &none, NULL);
  printf("%-10s %7zu  %-8s %7.3f s, %6.3f s of work after %g s%s%s\n", kind,
         hr2d_scene_patches(s->scene), calls[call].name, end - start, over, s->seconds,
         status && status != STOPPED ? ": " : "",
         status && status != STOPPED ? hr2d_strerror(status) : "");
  fflush(stdout);
  return over;
}

static void forget(stage *s) {
  hr2d_solution_destroy(s->solution);
  hr2d_scene_destroy(s->scene);
  s->solution = NULL;
  s->scene = NULL;
  s->committed = 0;
}

/* A scene as it is before commit, or committed without a budget. */
static hr2d_status make(stage *s, const budget_kind *kind, size_t patches, int committed) {
  const size_t max = kind->patches;
  forget(s);
  hr2d_status status = hr2d_scene_create(NULL, &s->scene);
  s->end = wall_seconds() + MAKES;
  if (!status) status = kind->add(s->scene, max && max < patches ? max : patches);
  if (!status && committed) status = commit(s);
  return status;
}

static int is_wanted(const char *only, const char *name) {
  return !only || !*only || !strcmp(only, name);
}

/* Returns the worst of one kind of scene. */
static double measure_kind(stage *s, const budget_kind *kind, size_t patches,
                           const char *only) {
  double worst = 0;
  for (size_t call = 0; call < CALLS; call++) {
    const int commits = calls[call].run == commit, draws = calls[call].run == field;
    if (!is_wanted(only, calls[call].name)) continue;
    if (!s->committed && make(s, kind, patches, !commits)) {
      printf("%s: %s\n", kind->name, hr2d_scene_message(s->scene));
      return 0;
    }
    if (draws && !s->solution) solve(s);
    const double over = measure(s, kind->name, call);
    worst = over > worst ? over : worst;
  }
  forget(s);
  return worst;
}

int main(int argc, char **argv) {
  const size_t patches = argc > 1 ? (size_t)atol(argv[1]) : 100000;
  stage s = {.seconds = argc > 2 ? atof(argv[2]) : 1};
  const char *only = argc > 3 ? argv[3] : NULL, *of = argc > 4 ? argv[4] : NULL;
  const double bar = .1 * s.seconds > SLACK ? .1 * s.seconds : SLACK;
  double worst = 0;
  int missed = 0, measured = 0, known = 0;
  sigaction(SIGALRM, &(struct sigaction){.sa_handler = note}, NULL); /* signal() lasts once */
  for (size_t call = 0; call < CALLS; call++) known |= is_wanted(only, calls[call].name);
  if (!known) {
    fprintf(stderr, "no call is called %s\n", only);
    return EXIT_FAILURE;
  }
  for (size_t k = 0; k < BUDGET_KINDS; k++) {
    if (!is_wanted(of, budget_kinds[k].name)) continue;
    const double over = measure_kind(&s, &budget_kinds[k], patches, only);
    measured++;
    missed += over > bar;
    worst = over > worst ? over : worst;
  }
  if (!measured) fprintf(stderr, "no kind of scene is called %s\n", of);
  printf("%d of %d kinds are more than %g s over; the worst is %.3f s\n", missed, measured, bar,
         worst);
  return missed || !measured ? EXIT_FAILURE : EXIT_SUCCESS;
}
