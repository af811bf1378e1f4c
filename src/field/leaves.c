/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "field/leaves.h"

#include <math.h>

#include "base/alloc.h"
#include "hierarchy/push-pull.h"
#include "scene/scene-impl.h"

enum { STACK = 128 };

/* An element, and the part of its patch that it covers. */
typedef struct piece {
  uint32_t element;
  double from, to;
} piece;

/* |φ_l| ≤ √(2l+1), so that B differs from its average by at most Σ |c_l| √(2l+1). */
void hr2di_leaves_measure(const hr2di_leaves *l, size_t bands, uint32_t element, float *level,
                          float *varies) {
  const double *value = l->value + element * l->order * bands;
  double average = 0, max = 0;
  for (size_t b = 0; b < bands; b++) {
    double sum = 0;
    for (size_t k = 1; k < l->order; k++)
      sum += fabs(value[k * bands + b]) * sqrt(2 * (double)k + 1);
    if (sum > 0) max = fmax(max, sum / l->scale[b]);
    if (value[b] != 0) average = fmax(average, fabs(value[b]) / l->scale[b]);
  }
  *level = (float)average;
  *varies = (float)max;
}

/* With what the elements differ from B, or NULL. */
static int is_leaf(const hr2d_solution *s, uint32_t element, const double *difference) {
  const uint32_t child = s->hierarchy->element[element].child;
  return !child || child >= s->elements || (difference && difference[element] <= 1);
}

static hr2d_status add_leaves(hr2di_leaves *l, const hr2d_solution *s, size_t patch,
                              hr2di_watch *watch) {
  const hr2d_element *element = s->hierarchy->element;
  piece stack[STACK];
  size_t count = 0;
  stack[count++] = (piece){(uint32_t)patch, 0, 1};
  while (count > 0) {
    const piece p = stack[--count];
    const hr2d_status status = hr2di_watch_work(watch, 1);
    if (status) return status;
    if (!is_leaf(s, p.element, l->difference) && count < STACK - 2) {
      const uint32_t child = element[p.element].child;
      const double middle =
          p.from + hr2di_element_left_part(element, p.element) * (p.to - p.from);
      stack[count++] = (piece){child + 1, middle, p.to};
      stack[count++] = (piece){child, p.from, middle};
      continue;
    }
    if (hr2di_alloc_reserve(&l->alloc, &l->leaf, &l->room, l->leaves + 1, sizeof *l->leaf))
      return HR2D_ENOMEM;
    hr2di_leaf *leaf = &l->leaf[l->leaves++];
    *leaf = (hr2di_leaf){.from = p.from, .element = p.element};
    hr2di_leaves_measure(l, s->bands, p.element, &leaf->level, &leaf->varies);
  }
  return HR2D_OK;
}

/* The largest coefficient of each band, and of gas. */
static hr2d_status find_scale(const hr2d_solution *s, double *scale, hr2di_watch *watch) {
  const size_t each = s->order * s->bands;
  hr2d_status status = HR2D_OK;
  for (size_t b = 0; b < s->bands; b++) scale[b] = hr2di_solution_hottest(s, b);
  for (size_t e = 0; e < s->elements && !status; e++) {
    for (size_t k = 0; k < each; k++)
      scale[k % s->bands] = fmax(scale[k % s->bands], fabs(s->value[e * each + k]));
    if (e % 16 == 0) status = hr2di_watch_work(watch, 1 + each / 4);
  }
  return status;
}

/* How far an element is from one of its children, as a part of what is allowed: the sum of the
   differences of all coefficients, times √(2k+1). */
static double distance(const hr2di_leaves *l, size_t bands, const double *relation,
                       const double *parent, const double *child, const double *max) {
  const size_t order = l->order;
  double worst = 0;
  for (size_t b = 0; b < bands; b++) {
    double sum = 0;
    for (size_t k = 0; k < order; k++) {
      double c = -child[k * bands + b];
      for (size_t m = k; m < order; m++) c += relation[m * order + k] * parent[m * bands + b];
      sum += fabs(c) * sqrt(2 * (double)k + 1);
    }
    if (sum > 0) worst = fmax(worst, sum / max[b]);
  }
  return worst;
}

/* The projection of B on an element from those of its children. */
static void project(const hr2di_leaves *l, size_t bands, const double *relation, double part,
                    const double *child, double *parent) {
  for (size_t m = 0; m < l->order; m++)
    for (size_t k = 0; k <= m; k++)
      for (size_t b = 0; b < bands; b++)
        parent[m * bands + b] += part * relation[m * l->order + k] * child[k * bands + b];
}

/* The coefficients of an element of the solution, with a higher order; of one with children all
   of them from these, if the order is higher. */
static void raise(hr2di_leaves *l, const hr2d_solution *s, const hr2di_push_pull *trees,
                  size_t e) {
  const size_t square = l->order * l->order, width = l->order * s->bands,
               given = s->order * s->bands;
  double *here = l->raised + e * width;
  for (size_t k = 0; k < width; k++) here[k] = k < given ? s->value[e * given + k] : 0;
  if (is_leaf(s, (uint32_t)e, NULL) || l->order == s->order) return;
  const double left = hr2di_element_left_part(s->hierarchy->element, (uint32_t)e);
  const double *relation = hr2di_push_pull_relation(trees, (uint32_t)e),
               *child = l->raised + s->hierarchy->element[e].child * width;
  for (size_t k = 0; k < width; k++) here[k] = 0;
  project(l, s->bands, relation, left, child, here);
  project(l, s->bands, relation + square, 1 - left, child + width, here);
}

/* B differs from an element by no more than from one of its children, plus what this differs
   from the element.  Children have higher numbers. */
static void compare(hr2di_leaves *l, const hr2d_solution *s, const hr2di_push_pull *trees,
                    const double *max, size_t e) {
  const size_t square = l->order * l->order, width = l->order * s->bands;
  const uint32_t child = s->hierarchy->element[e].child;
  l->difference[e] = 0;
  if (is_leaf(s, (uint32_t)e, NULL)) return;
  const double *relation = hr2di_push_pull_relation(trees, (uint32_t)e);
  for (uint32_t k = 0; k < 2; k++)
    l->difference[e] = fmax(
        l->difference[e], l->difference[child + k] +
                              distance(l, s->bands, relation + k * square, l->value + e * width,
                                       l->value + (child + k) * width, max));
}

static hr2d_status merge(hr2di_leaves *l, const hr2d_solution *s, const double *max,
                         hr2di_watch *watch) {
  hr2di_push_pull trees;
  if (l->order < HR2DI_LEAVES_ORDER) l->order = HR2DI_LEAVES_ORDER;
  const size_t width = l->order * s->bands;
  l->difference = hr2di_alloc(&l->alloc, s->elements, sizeof *l->difference);
  l->value = l->raised = hr2di_alloc(&l->alloc, s->elements, width * sizeof *l->raised);
  if (!l->difference || !l->raised) return HR2D_ENOMEM;
  hr2d_status status =
      hr2di_push_pull_init(&trees, s->hierarchy, &l->alloc, l->order, s->bands, watch);
  for (size_t e = s->elements; e-- > 0 && !status;) {
    raise(l, s, &trees, e);
    compare(l, s, &trees, max, e);
    status = hr2di_watch_work(watch, 1 + l->order * width / 8);
  }
  hr2di_push_pull_clear(&trees);
  return status;
}

hr2d_status hr2di_leaves_init(hr2di_leaves *l, const hr2d_solution *solution, const double *max,
                              hr2di_watch *watch) {
  const size_t patches = solution->hierarchy->scene->patches;
  *l = (hr2di_leaves){
      .alloc = solution->alloc, .order = solution->order, .value = solution->value};
  l->of_patch = hr2di_alloc(&l->alloc, patches + 1, sizeof *l->of_patch);
  l->scale = hr2di_alloc(&l->alloc, solution->bands, sizeof *l->scale);
  hr2d_status status = l->of_patch && l->scale ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = find_scale(solution, l->scale, watch);
  if (!status && max) status = merge(l, solution, max, watch);
  for (size_t k = 0; k < patches && !status; k++) {
    l->of_patch[k] = l->leaves;
    status = add_leaves(l, solution, k, watch);
  }
  if (!status) l->of_patch[patches] = l->leaves;
  return status;
}

/* φ_l is √(2l+1) at the end of a leaf, and that with the sign of (−1)^l at its start. */
static int jumps(const hr2di_leaves *l, size_t bands, const hr2di_leaf *leaf,
                 const double *max) {
  const double *before = l->value + leaf[0].element * l->order * bands,
               *after = l->value + leaf[1].element * l->order * bands;
  for (size_t b = 0; b < bands; b++) {
    double jump = 0;
    for (size_t k = 0; k < l->order; k++) {
      const double phi = sqrt(2 * (double)k + 1);
      jump += phi *
              ((k % 2 ? -after[k * bands + b] : after[k * bands + b]) - before[k * bands + b]);
    }
    if (fabs(jump) > max[b]) return 1;
  }
  return 0;
}

hr2d_status hr2di_leaves_group(hr2di_leaves *l, size_t bands, const double *max,
                               hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  l->group = hr2di_alloc(&l->alloc, l->leaves, sizeof *l->group);
  if (!l->group) return HR2D_ENOMEM;
  for (size_t k = 0; k < l->leaves && !status; k++) {
    const int more = k > 0 && jumps(l, bands, &l->leaf[k - 1], max);
    l->group[k] = k > 0 ? l->group[k - 1] + (uint32_t)more : 0;
    status = hr2di_watch_work(watch, 1);
  }
  return status;
}

void hr2di_leaves_clear(hr2di_leaves *l) {
  hr2di_alloc_free(&l->alloc, l->raised);
  hr2di_alloc_free(&l->alloc, l->difference);
  hr2di_alloc_free(&l->alloc, l->scale);
  hr2di_alloc_free(&l->alloc, l->group);
  hr2di_alloc_free(&l->alloc, l->leaf);
  hr2di_alloc_free(&l->alloc, l->of_patch);
}

size_t hr2di_leaf_at(const hr2di_leaves *l, size_t patch, double at) {
  size_t low = l->of_patch[patch], high = l->of_patch[patch + 1];
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    if (l->leaf[middle].from <= at)
      low = middle;
    else
      high = middle;
  }
  return low;
}
