/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the cost of the exact oracle: a pair against nested adaptive quadrature, and a
   refinement against one by the size oracle. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "oracle/l1.h"
#include "timing.h"

enum { ROUNDS = 5, PAIRS = 40, LIMIT = 1000 };

/* |G − Gc| integrated by QAG inside QAG, in centred coordinates. */
typedef struct nested {
  double ix, iy, ux, uy, li, jx, jy, vx, vy, lj; /* centres, directions, lengths */
  double centre, t;
  gsl_integration_workspace *outer, *inner;
} nested;

static double kernel(const nested *n, double s, double t) {
  const double dx = n->jx + t * n->vx - n->ix - s * n->ux;
  const double dy = n->jy + t * n->vy - n->iy - s * n->uy;
  const double hi = n->ux * dy - n->uy * dx, hj = n->vy * dx - n->vx * dy;
  const double r2 = dx * dx + dy * dy;
  return hi > 0 && hj > 0 ? 0.5 * hi * hj / (r2 * sqrt(r2)) : 0;
}

static double deviation(double s, void *params) {
  const nested *n = params;
  return fabs(kernel(n, s, n->t) - n->centre);
}

static double inner_integral(double t, void *params) {
  nested *n = params;
  const gsl_function f = {deviation, n};
  double value, error;
  n->t = t;
  gsl_integration_qag(&f, -n->li / 2, n->li / 2, 1e-300, 1e-9, LIMIT, GSL_INTEG_GAUSS15,
                      n->inner, &value, &error);
  return value;
}

static double nested_l1(const hr2d_segment *i, const hr2d_segment *j) {
  nested n = {.ix = (i->a.x + i->b.x) / 2,
              .iy = (i->a.y + i->b.y) / 2,
              .jx = (j->a.x + j->b.x) / 2,
              .jy = (j->a.y + j->b.y) / 2};
  n.li = hypot(i->b.x - i->a.x, i->b.y - i->a.y);
  n.lj = hypot(j->b.x - j->a.x, j->b.y - j->a.y);
  n.ux = (i->b.x - i->a.x) / n.li, n.uy = (i->b.y - i->a.y) / n.li;
  n.vx = (j->b.x - j->a.x) / n.lj, n.vy = (j->b.y - j->a.y) / n.lj;
  n.centre = kernel(&n, 0, 0);
  const gsl_function f = {inner_integral, &n};
  n.outer = gsl_integration_workspace_alloc(LIMIT);
  n.inner = gsl_integration_workspace_alloc(LIMIT);
  double value, error;
  gsl_integration_qag(&f, -n.lj / 2, n.lj / 2, 1e-300, 1e-8, LIMIT, GSL_INTEG_GAUSS15, n.outer,
                      &value, &error);
  gsl_integration_workspace_free(n.outer);
  gsl_integration_workspace_free(n.inner);
  return value;
}

typedef struct pair {
  hr2d_segment i, j;
} pair;

static double random_unit(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-53;
}

/* Elements of two patches on level `level`. */
static void draw(pair *p, int level, const hr2d_segment *i, const hr2d_segment *j) {
  uint64_t state = 1;
  const double size = ldexp(1, -level);
  for (int k = 0; k < PAIRS; k++) {
    const hr2d_segment *from[2] = {i, j};
    hr2d_segment *to[2] = {&p[k].i, &p[k].j};
    for (int m = 0; m < 2; m++) {
      const hr2d_segment s = *from[m];
      const double t = floor(random_unit(&state) / size) * size;
      const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
      to[m]->a = (hr2d_point){s.a.x + t * dx, s.a.y + t * dy};
      to[m]->b = (hr2d_point){s.a.x + (t + size) * dx, s.a.y + (t + size) * dy};
    }
  }
}

static void compare_pairs(const char *name, int level, hr2d_segment i, hr2d_segment j) {
  static pair p[PAIRS];
  draw(p, level, &i, &j);
  double ours[ROUNDS], theirs[ROUNDS], off = 0;
  for (int round = 0; round < ROUNDS; round++) {
    double value[PAIRS] = {0}, start = hr2di_clock_now();
    for (int m = 0; m < 20; m++)
      for (int k = 0; k < PAIRS; k++) value[k] = hr2di_l1(&p[k].i, &p[k].j);
    ours[round] = (hr2di_clock_now() - start) / 20 / PAIRS;
    start = hr2di_clock_now();
    for (int k = 0; k < PAIRS; k++) {
      const double expected = nested_l1(&p[k].i, &p[k].j);
      off = fmax(off, fabs(value[k] / expected - 1));
    }
    theirs[round] = (hr2di_clock_now() - start) / PAIRS;
  }
  const double fast = median_of(ours, ROUNDS), slow = median_of(theirs, ROUNDS);
  printf("%-10s level %d: %6.2f us a pair, nested QAG at 1e-8 %8.1f us: %6.0f times; within "
         "%.1e\n",
         name, level, 1e6 * fast, 1e6 * slow, slow / fast, off);
}

static double refine(const hr2d_oracle *oracle, double epsilon, hr2d_refine_counts *counts) {
  hr2d_scene *scene = NULL;
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2d_patch bottom = HR2D_PATCH_INIT, top = HR2D_PATCH_INIT;
  options.epsilon = epsilon;
  bottom.b = (hr2d_point){1, 0};
  top.a = (hr2d_point){1, 0.1};
  top.b = (hr2d_point){0, 0.1};
  if (hr2d_scene_create(NULL, &scene) || hr2d_scene_add(scene, &bottom, NULL) ||
      hr2d_scene_add(scene, &top, NULL) || hr2d_scene_force(scene, HR2D_EFFECT_EMISSION) ||
      hr2d_scene_commit(scene) || hr2d_hierarchy_create(scene, &hierarchy) ||
      hr2d_linkset_create(hierarchy, oracle, NULL, NULL, NULL, &links))
    exit(EXIT_FAILURE);
  const double start = hr2di_clock_now();
  if (hr2d_refine_count(links, &options, counts)) exit(EXIT_FAILURE);
  const double seconds = hr2di_clock_now() - start;
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
  return seconds;
}

static void compare_refinements(const char *name, const hr2d_oracle *oracle, double epsilon,
                                double size_epsilon) {
  double exact[ROUNDS], size[ROUNDS];
  hr2d_refine_counts counts = {0}, size_counts = {0};
  for (int k = 0; k < ROUNDS; k++) {
    exact[k] = refine(oracle, epsilon, &counts);
    size[k] = refine(hr2d_oracle_size(), size_epsilon, &size_counts);
  }
  const double ours = median_of(exact, ROUNDS) / (double)counts.links;
  const double theirs = median_of(size, ROUNDS) / (double)size_counts.links;
  printf("par0.1 %s %.2g: L %llu, %.1f ns a link; size: L %llu, %.1f ns: %.1f times\n", name,
         epsilon, (unsigned long long)counts.links, 1e9 * ours,
         (unsigned long long)size_counts.links, 1e9 * theirs, ours / theirs);
}

int main(void) {
  gsl_set_error_handler_off();
  const hr2d_segment floor_patch = {{0, 0}, {1, 0}}, wall = {{0, 1}, {0, 0}};
  const hr2d_segment near = {{1, 0.1}, {0, 0.1}};
  for (int level = 0; level <= 6; level += 3) compare_pairs("par0.1", level, floor_patch, near);
  for (int level = 0; level <= 6; level += 3)
    compare_pairs("orth_touch", level, floor_patch, wall);
  compare_refinements("l1", hr2d_oracle_l1(), 1e-4, 0.25);
  compare_refinements("l1", hr2d_oracle_l1(), 1e-6, 0.05);
  compare_refinements("l1", hr2d_oracle_l1(), 1e-8, 0.01);
  compare_refinements("l1-grid", hr2d_oracle_l1_grid(), 1e-6, 0.05);
  return EXIT_SUCCESS;
}
