/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures how long the library works between two questions to the progress callback: whether
   the work that its loops declare is what they do.

   Usage: bench_polls [PATCHES [ORDER [THREADS [PHASE [KIND]]]]].  For every phase, or one, of
   every kind of scene, or one: the longest time between two questions, by the clock of the
   calling thread, on which other programs have little influence, and by the wall.  Fails where
   it is longer than the bar.  Calls are stopped after a while, and what they are made of, too:
   with many patches most of them take hours. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "support/slow-phases.h"

/* Seconds: of a gap, of a call, and of what is made for it. */
#define BAR   0.01
#define CALL  20
#define MAKES 60

/* Above, pairs of patches are too many for links without clusters, and for a matrix. */
enum { MOST_PAIRED = 3000 };
#define TARGET .1

#define STOPPED ((hr2d_status)77)

typedef struct stopwatch {
  double cpu, wall;  /* of the last question */
  double start, max; /* of the call, by the thread's clock */
  double longest_cpu, longest_wall;
  unsigned long asks;
  const char *phase; /* of the longest */
} stopwatch;

static double now(clockid_t id) {
  struct timespec t;
  clock_gettime(id, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void look(stopwatch *w, const char *phase) {
  const double cpu = now(CLOCK_THREAD_CPUTIME_ID), wall = now(CLOCK_MONOTONIC);
  if (cpu - w->cpu > w->longest_cpu) {
    w->longest_cpu = cpu - w->cpu;
    w->phase = phase;
  }
  if (wall - w->wall > w->longest_wall) w->longest_wall = wall - w->wall;
  w->cpu = now(CLOCK_THREAD_CPUTIME_ID);
  w->wall = now(CLOCK_MONOTONIC);
}

static hr2d_status ask(void *ctx, const hr2d_progress *progress) {
  stopwatch *w = ctx;
  w->asks++;
  look(w, progress->phase);
  return w->cpu - w->start > w->max ? STOPPED : HR2D_OK;
}

static int needs_pairs(const char *phase) {
  static const char *const names[] = {"factors", "validate", "solve"};
  for (size_t k = 0; k < sizeof names / sizeof *names; k++)
    if (!strcmp(phase, names[k])) return 1;
  return 0;
}

static stopwatch start(double max) {
  const double cpu = now(CLOCK_THREAD_CPUTIME_ID);
  return (stopwatch){
      .cpu = cpu, .start = cpu, .wall = now(CLOCK_MONOTONIC), .max = max, .phase = ""};
}

static int measure(slow_kind kind, const slow_phase *phase, const slow_stage *like) {
  slow_stage s = *like;
  stopwatch w = start(MAKES);
  s.kind = kind;
  s.ask = s.hurry = ask;
  s.ctx = &w;
  hr2d_status status = phase->prepare(&s);
  const int made = status != STOPPED;
  w = start(CALL);
  const double wall = w.wall;
  if (!status) status = phase->run(&s);
  look(&w, "end");
  printf("%-8s %-10s %9.3f s %8lu asks   longest %7.2f ms (wall %7.2f) in %s%s%s\n",
         slow_name(kind), phase->name, w.wall - wall, w.asks, 1e3 * w.longest_cpu,
         1e3 * w.longest_wall, w.phase, status ? ": " : "",
         !made               ? "takes too long to be made"
         : status == STOPPED ? "stopped"
         : status            ? hr2d_strerror(status)
                             : "");
  fflush(stdout);
  slow_clear(&s);
  return (status && status != STOPPED) || w.longest_cpu > BAR;
}

int main(int argc, char **argv) {
  const size_t count = argc > 1 ? (size_t)atol(argv[1]) : 1000;
  const slow_stage like = {.count = count,
                           .target = count > MOST_PAIRED ? TARGET : 0,
                           .order = argc > 2 ? (unsigned)atoi(argv[2]) : 1,
                           .threads = argc > 3 ? (unsigned)atoi(argv[3]) : 1,
                           .epsilon = 0.5};
  const char *only = argc > 4 && *argv[4] ? argv[4] : NULL;
  const char *of = argc > 5 ? argv[5] : NULL;
  int missed = 0, runs = 0;
  for (int kind = 0; kind < SLOW_KINDS; kind++)
    for (size_t k = 0; k < SLOW_PHASES; k++) {
      if (only && strcmp(only, slow_phases[k].name) != 0) continue;
      if (of && strcmp(of, slow_name((slow_kind)kind)) != 0) continue;
      if (like.count > MOST_PAIRED && needs_pairs(slow_phases[k].name)) continue;
      missed += measure((slow_kind)kind, &slow_phases[k], &like);
      runs++;
    }
  printf("%d of %d are longer than %g ms, or failed\n", missed, runs, 1e3 * BAR);
  return missed ? EXIT_FAILURE : EXIT_SUCCESS;
}
