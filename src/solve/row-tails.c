/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/row-tails.h"

#include <math.h>

#include "base/legendre.h"
#include "scene/scene-impl.h"
#include "visibility/periodic-tail.h"

/* The ends are many periods away: what is seen of them bends little along a leaf. */
enum { POINTS = 8 };

typedef struct observer {
  const hr2d_hierarchy *h;
  const hr2d_scene *scene;
  hr2di_point_viewer *viewer;
  hr2di_rule rule;
} observer;

static hr2d_status sample(const observer *l, uint32_t leaf, size_t point,
                          hr2di_periodic_tail *tail) {
  const hr2d_element *e = &l->h->element[leaf];
  const double size = e->length / l->h->element[e->patch].length;
  const double t = hr2di_element_start(l->h, leaf) + size * (0.5 + 0.5 * l->rule.at[point]);
  hr2di_view_from seen;
  const hr2d_status status = hr2di_view_at(l->viewer, e->patch, t, &seen);
  if (!status) hr2di_periodic_tail_of(l->scene, e->patch, t, &seen, tail);
  return status;
}

static hr2d_status begin(observer *l, const hr2d_hierarchy *h, const hr2d_scene *scene,
                         hr2di_watch *watch) {
  *l = (observer){.h = h, .scene = scene};
  hr2di_rule_init(&l->rule, POINTS);
  return hr2di_point_viewer_create(scene, &h->alloc, watch, &l->viewer);
}

static hr2d_status move_leaf(const observer *l, uint32_t leaf, double *front, double *back) {
  hr2d_status status = HR2D_OK;
  for (size_t q = 0; q < POINTS && !status; q++) {
    hr2di_periodic_tail tail;
    status = sample(l, leaf, q, &tail);
    if (status || !(tail.ends > 0)) continue;
    const double weight = l->rule.weight[q];
    double open = tail.back;
    for (int k = 0; k < HR2DI_SKIES; k++) open += tail.sky[k];
    if (front) front[leaf] -= weight * open;
    if (back) back[leaf] += weight * tail.back;
  }
  return status;
}

hr2d_status hr2di_row_tails_move(const hr2d_hierarchy *h, const hr2d_scene *scene, size_t patch,
                                 double *front, double *back, hr2di_watch *watch) {
  observer l;
  hr2d_status status = begin(&l, h, scene, watch);
  uint32_t leaf = hr2di_hierarchy_first_leaf(h, (uint32_t)patch);
  do {
    if (!status) status = move_leaf(&l, leaf, front, back);
    if (!status) status = hr2di_watch_work(watch, 1);
    leaf = hr2di_hierarchy_next_leaf(h, leaf, (uint32_t)patch);
  } while (leaf && !status);
  hr2di_point_viewer_destroy(l.viewer);
  return status;
}

/* Whether an element is a leaf of the cell that light reaches. */
static int looks(const hr2d_hierarchy *h, uint32_t element) {
  const hr2d_element *e = &h->element[element];
  return !e->child && e->patch < hr2di_scene_cell(h->scene) &&
         hr2di_scene_lit(h->scene, e->patch);
}

hr2d_status hr2di_row_tails_check(const hr2d_hierarchy *h, int check, double *off,
                                  hr2di_watch *watch) {
  observer l;
  hr2d_status status = begin(&l, h, h->scene, watch);
  for (uint32_t k = 0; k < h->elements && !status; k++) {
    off[k] = 0;
    for (size_t q = 0; q < POINTS && looks(h, k) && !status; q++) {
      hr2di_periodic_tail tail;
      status = sample(&l, k, q, &tail);
      for (int m = 0; m < HR2DI_SKIES && !status; m++)
        off[k] += l.rule.weight[q] * tail.check[check][m];
    }
  }
  hr2di_point_viewer_destroy(l.viewer);
  return status;
}

hr2d_status hr2di_row_tails_seen(const hr2d_hierarchy *h, double *ends, double *sky,
                                 hr2di_watch *watch) {
  observer l;
  hr2d_status status = begin(&l, h, h->scene, watch);
  for (uint32_t k = 0; k < h->elements && !status; k++) {
    ends[k] = sky[k] = 0;
    for (size_t q = 0; q < POINTS && looks(h, k) && !status; q++) {
      hr2di_periodic_tail tail;
      status = sample(&l, k, q, &tail);
      if (!status) ends[k] = fmax(ends[k], tail.ends);
      for (int m = 0; m < HR2DI_SKIES && !status; m++) sky[k] += l.rule.weight[q] * tail.sky[m];
    }
  }
  hr2di_point_viewer_destroy(l.viewer);
  return status;
}
