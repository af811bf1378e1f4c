/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the cost of exact occlusion: all exchange areas of a scene against crossed strings,
   which ignore occluders.

   Usage: bench-visibility [rows|hard|views|commit [FAMILY]]; without a word, rows.  Times are
   medians of rounds in which both sides of a ratio alternate.  Fails where a bar is missed.
   `hard` has scenes that this method does worst, `views` counts the views of single points in a
   second, and `commit` times hr2d_scene_commit(). */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bars.h"
#include "base/alloc.h"
#include "plans.h"
#include "rows.h"
#include "timing.h"
#include "visibility/point-view.h"

enum { MOST_ROUNDS = 15 };

#define DISTANCE(p, q)                                                                         \
  sqrt(((p).x - (q).x) * ((p).x - (q).x) + ((p).y - (q).y) * ((p).y - (q).y))

/* Half of the matrix is enough for a comparison.  As gcc -O3 compiles it without further
   options: roots may set errno then, and come one by one.  Without errno it takes half the
   time. */
#if defined __GNUC__ && !defined __clang__
__attribute__((optimize("O3")))
#endif
static void
fill_strings(const hr2d_segment *s, size_t n, double *area) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++)
      area[i * n + j] = 0.5 * ((DISTANCE(s[i].a, s[j].a) + DISTANCE(s[i].b, s[j].b)) -
                               (DISTANCE(s[i].a, s[j].b) + DISTANCE(s[i].b, s[j].a)));
}

/* Strings take n² numbers: without them beyond `MOST_STRINGS` patches. */
enum { MOST_STRINGS = 6000 };

static double make_strings(const hr2d_segment *segment, size_t n, double *area) {
  const double start = cpu_seconds();
  if (area) fill_strings(segment, n, area);
  return cpu_seconds() - start;
}

static measured measure_rows(plan_fn draw, int n) {
  hr2d_scene *scene = plan_scene(draw, n, 0);
  measured m = {.patches = hr2d_scene_patches(scene)};
  const size_t patches = m.patches;
  const int rounds = n > 2048 ? 5 : MOST_ROUNDS;
  double *area = patches <= MOST_STRINGS ? calloc(patches * patches, sizeof *area) : NULL;
  hr2d_segment *segment = malloc(patches * sizeof *segment);
  if ((!area && patches <= MOST_STRINGS) || !segment) bars_fail("out of memory");
  for (size_t k = 0; k < patches; k++) segment[k] = hr2d_scene_segment(scene, k);
  double strings[MOST_ROUNDS], exact[MOST_ROUNDS];
  for (int k = -1; k < rounds; k++) {
    const double first = make_strings(segment, patches, area);
    const double second = rows_hold(scene, &m);
    if (k >= 0) strings[k] = first, exact[k] = second;
  }
  m.seconds = median_of(exact, rounds);
  m.strings = area ? median_of(strings, rounds) : 0;
  free(segment);
  free(area);
  hr2d_scene_destroy(scene);
  return m;
}

/* The family that was asked for; NULL for all. */
static const char *only;

static int is_wanted(const char *name) {
  return !only || strcmp(name, only) == 0;
}

static void print_titles(void) {
  printf("%-8s%8s%10s%10s%8s%10s%12s%12s%12s\n", "rows", "N", "ms", "strings", "ratio", "row",
         "pairs", "partial", "triangles");
}

static void print_measured(const char *name, const measured *m) {
  printf("%-8s%8zu%10.2f%10.2f%8.2f%10.1e%12llu%12llu%12llu\n", name, m->patches,
         1e3 * m->seconds, 1e3 * m->strings, m->strings > 0 ? m->seconds / m->strings : 0,
         m->row, (unsigned long long)m->counts.exchange_areas,
         (unsigned long long)m->counts.partial_pairs,
         (unsigned long long)m->counts.visibility_tests);
  bars_hold("worst row", m->row, 1e-13);
}

static measured measure_and_print(const char *name, plan_fn draw, int n) {
  const measured m = measure_rows(draw, n);
  print_measured(name, &m);
  fflush(stdout);
  return m;
}

/* Up to the size at which strings are the measure. */
static void measure_families(void) {
  static const int size[] = {128, 512, 1024, 2048};
  print_titles();
  for (size_t k = 0; k < PLAN_FAMILIES; k++) {
    const plan_family *f = &plan_families[k];
    if (!is_wanted(f->name)) continue;
    for (size_t m = 0; m < sizeof size / sizeof *size; m++)
      measure_and_print(f->name, f->draw, size[m]);
    const measured last = measure_and_print(f->name, f->draw, f->size);
    bars_hold("the ratio to strings", last.seconds / last.strings, f->ratio);
  }
}

/* Where beams pass many triangles, and where everything sees everything. */
static void measure_hard(void) {
  static const struct {
    const char *name;
    plan_fn draw;
  } hard[] = {{"thin", plan_thin},
              {"tiny", plan_tiny},
              {"round", plan_round},
              {"backs", plan_segments},
              {"open", plan_open}};
  static const int size[] = {1024, 5120, 10240};
  print_titles();
  for (size_t k = 0; k < sizeof hard / sizeof *hard; k++)
    for (size_t m = 0; m < sizeof size / sizeof *size && is_wanted(hard[k].name); m++)
      measure_and_print(hard[k].name, hard[k].draw, size[m]);
}

/* Views of points anywhere, and what one sees. */
static void measure_views(const plan_family *f) {
  enum { VIEWS = 2000 };
  hr2d_scene *scene = plan_scene(f->draw, f->size, 0);
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2di_point_viewer *viewer;
  double seconds[MOST_ROUNDS];
  size_t intervals = 0;
  for (int round = 0; round < 5; round++) {
    intervals = 0;
    plan_random_start(20250103);
    const double start = cpu_seconds();
    if (hr2di_point_viewer_create(scene, &alloc, NULL, &viewer)) bars_fail("no viewer");
    for (int k = 0; k < VIEWS; k++) {
      hr2di_view_from seen;
      const size_t patch = (size_t)plan_random(0, (double)hr2d_scene_patches(scene));
      if (hr2di_view_at(viewer, patch, plan_random(0, 1), &seen)) bars_fail("no view");
      intervals += seen.count;
    }
    hr2di_point_viewer_destroy(viewer);
    seconds[round] = cpu_seconds() - start;
  }
  printf("%-8s%8zu%12.0f%12.1f\n", f->name, hr2d_scene_patches(scene),
         VIEWS / median_of(seconds, 5), (double)intervals / VIEWS);
  hr2d_scene_destroy(scene);
}

static void measure_all_views(void) {
  printf("%-8s%8s%12s%12s\n", "views", "N", "a second", "intervals");
  for (int k = 0; k < PLAN_FAMILIES; k++)
    if (is_wanted(plan_families[k].name)) measure_views(&plan_families[k]);
}

/* Seconds of commit alone. */
static double commit_seconds(plan_fn draw, int n, int lamps) {
  hr2d_scene *scene = plan_patches(draw, n, lamps);
  const double start = cpu_seconds();
  if (hr2d_scene_commit(scene)) bars_fail(hr2d_scene_message(scene));
  const double seconds = cpu_seconds() - start;
  hr2d_scene_destroy(scene);
  return seconds;
}

/* Where all patches emit, and where one does: then dark patches are searched for. */
static void measure_commits(void) {
  static const plan_family committed[] = {{"open", plan_open, 0, 0, 1.3},
                                          {"squares", plan_squares, 0, 0, 1.3},
                                          {"fibres", plan_fibres, 0, 0, 1.3}};
  static const int size[] = {10240, 102400, 1024000};
  printf("%-8s%10s%12s%12s\n", "commit", "N", "s", "one lamp, s");
  for (size_t f = 0; f < sizeof committed / sizeof *committed; f++) {
    double first = 0;
    for (int k = 0; k < 3 && is_wanted(committed[f].name); k++) {
      const double lit = commit_seconds(committed[f].draw, size[k], 0);
      printf("%-8s%10d%12.3f%12.3f\n", committed[f].name, size[k], lit,
             commit_seconds(committed[f].draw, size[k], 1));
      if (k == 0) first = lit;
      if (k == 2)
        bars_hold("exponent of commit", log(lit / first) / log(100), committed[f].growth);
    }
  }
}

int main(int argc, char **argv) {
  const char *what = argc > 1 ? argv[1] : "rows";
  only = argc > 2 ? argv[2] : NULL;
  if (strcmp(what, "rows") == 0)
    measure_families();
  else if (strcmp(what, "hard") == 0)
    measure_hard();
  else if (strcmp(what, "commit") == 0)
    measure_commits();
  else if (strcmp(what, "views") == 0)
    measure_all_views();
  else
    return fprintf(stderr, "usage: %s [rows|hard|views|commit [FAMILY]]\n", argv[0]), 2;
  return bars_status();
}
