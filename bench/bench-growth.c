/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures how the cost of all exchange areas grows with the number of patches.

   Usage: bench-growth [large|million [FAMILY]]; without a word, large: from 5120 to 102,400
   patches.  `million` measures a million segments from adding them on.  Fails where a bar is
   missed. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "alone.h"
#include "bars.h"
#include "base/clock.h"
#include "plans.h"
#include "rows.h"
#include "timing.h"

/* Rows of a new process, held or visited. */
typedef struct fresh {
  plan_fn draw;
  int n, visited;
  measured m;
} fresh;

static void make_fresh_rows(void *ctx) {
  fresh *f = ctx;
  hr2d_scene *scene = plan_scene(f->draw, f->n, 0);
  f->m.patches = hr2d_scene_patches(scene);
  if (f->visited) {
    balance b;
    const double start = cpu_seconds();
    rows_visit(scene, 1, &b);
    f->m.seconds = cpu_seconds() - start;
  } else {
    f->m.seconds = rows_hold(scene, &f->m);
  }
  hr2d_scene_destroy(scene);
}

static double exponent(const measured *first, const measured *second) {
  return log(second->seconds / first->seconds) /
         log((double)second->patches / (double)first->patches);
}

/* The median of processes that make the rows once: all that is new to a process, as pages that
   the system has to clear, counts at each size. */
static measured measure_fresh(const plan_family *f, int n, int visited) {
  enum { PROCESSES = 5 };
  double seconds[PROCESSES];
  fresh made = {.draw = f->draw, .n = n, .visited = visited};
  for (int k = 0; k < PROCESSES; k++) {
    made.m = (measured){0};
    if (!alone_run(make_fresh_rows, &made, sizeof made)) bars_fail("a process failed");
    seconds[k] = made.m.seconds;
  }
  made.m.seconds = median_of(seconds, PROCESSES);
  return made.m;
}

static void measure_growth(const plan_family *f) {
  static const int size[] = {5120, 20480, 102400};
  enum { SIZES = sizeof size / sizeof *size };
  measured held[SIZES], visited[SIZES];
  for (int k = 0; k < SIZES; k++) {
    held[k] = measure_fresh(f, size[k], 0);
    visited[k] = measure_fresh(f, size[k], 1);
    printf("%-8s%8zu%10.2f%10.2f%12llu%12llu\n", f->name, held[k].patches,
           1e3 * held[k].seconds, 1e3 * visited[k].seconds,
           (unsigned long long)held[k].counts.exchange_areas,
           (unsigned long long)held[k].counts.visibility_tests);
    bars_hold("worst row", held[k].row, 1e-13);
  }
  const double of_held = exponent(&held[0], &held[SIZES - 1]);
  const double of_visited = exponent(&visited[0], &visited[SIZES - 1]);
  printf("%-8s grows like N^%.2f held, N^%.2f visited\n", f->name, of_held, of_visited);
  bars_hold("exponent of held rows", of_held, f->growth);
  bars_hold("exponent of visited rows", of_visited, f->growth);
}

static double gigabytes(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return (double)usage.ru_maxrss * 1024e-9;
}

typedef struct million {
  plan_fn draw;
  size_t patches;
  double committed, one, two, held; /* seconds; `one` and `two` threads visit rows */
  double space, held_space;         /* gigabytes */
  balance rows;
} million;

/* From the first patch to the last row, with one thread and with two; then the rows are held.
 */
static void run_million(void *ctx) {
  million *m = ctx;
  measured held = {.entries = 1};
  const double start = hr2di_clock_now();
  hr2d_scene *scene = plan_scene(m->draw, 1000000, 0);
  m->patches = hr2d_scene_patches(scene);
  m->committed = hr2di_clock_now() - start;
  const double one = hr2di_clock_now();
  rows_visit(scene, 1, &m->rows);
  m->space = gigabytes();
  const double two = hr2di_clock_now();
  rows_visit(scene, 2, &m->rows);
  m->one = two - one;
  m->two = hr2di_clock_now() - two;
  m->held = rows_hold(scene, &held);
  m->held_space = gigabytes();
  hr2d_scene_destroy(scene);
}

static void measure_million(const plan_family *f) {
  million m = {.draw = f->draw};
  if (!alone_run(run_million, &m, sizeof m)) bars_fail("a process failed");
  printf("%s: %zu patches, %.2f s to commit, %.2f s for rows of %llu entries, %.2f s with two "
         "threads, %.2f GB, worst row %.1e\n",
         f->name, m.patches, m.committed, m.one, (unsigned long long)m.rows.entries, m.two,
         m.space, m.rows.worst);
  printf("%s: %.2f s and %.2f GB to hold them\n", f->name, m.held, m.held_space);
  bars_hold("seconds", m.committed + m.one, 60);
  bars_hold("GB", m.space, 2);
  bars_hold("worst row", m.rows.worst, 1e-13);
  if (sysconf(_SC_NPROCESSORS_ONLN) > 1)
    bars_hold("1.7 times two threads", 1.7 * m.two / m.one, 1);
}

int main(int argc, char **argv) {
  const char *what = argc > 1 ? argv[1] : "large", *only = argc > 2 ? argv[2] : NULL;
  const int large = strcmp(what, "large") == 0;
  if (!large && strcmp(what, "million") != 0)
    return fprintf(stderr, "usage: %s [large|million [FAMILY]]\n", argv[0]), 2;
  if (large)
    printf("%-8s%8s%10s%10s%12s%12s\n", "growth", "N", "held, ms", "visited", "pairs",
           "triangles");
  for (int k = 0; k < PLAN_FAMILIES; k++) {
    const plan_family *f = &plan_families[k];
    if (f->growth == 0 || (only && strcmp(only, f->name) != 0)) continue;
    if (large)
      measure_growth(f);
    else
      measure_million(f);
  }
  return bars_status();
}
