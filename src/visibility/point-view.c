/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A viewer, and the order of what it sees. */
#include "visibility/point-view.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "scene/scene-impl.h"
#include "visibility/point-view-impl.h"

hr2d_status hr2di_point_viewer_create(const hr2d_scene *scene, const hr2d_allocator *alloc,
                                      hr2di_watch *watch, hr2di_point_viewer **viewer) {
  *viewer = hr2di_alloc_zero(alloc, 1, sizeof **viewer);
  if (!*viewer) return HR2D_ENOMEM;
  (*viewer)->alloc = *alloc;
  (*viewer)->watch = watch;
  (*viewer)->scene = scene;
  return HR2D_OK;
}

void hr2di_point_viewer_destroy(hr2di_point_viewer *viewer) {
  if (!viewer) return;
  const hr2d_allocator alloc = viewer->alloc;
  hr2di_triangular_expansion_clear(&viewer->between);
  hr2di_alloc_free(&alloc, viewer->span);
  hr2di_alloc_free(&alloc, viewer->interval);
  hr2di_alloc_free(&alloc, viewer->sorted);
  hr2di_alloc_free(&alloc, viewer->arc);
  hr2di_alloc_free(&alloc, viewer->order);
  hr2di_alloc_free(&alloc, viewer);
}

static int by_number(const void *left, const void *right) {
  const uint64_t l = *(const uint64_t *)left, r = *(const uint64_t *)right;
  return (l > r) - (l < r);
}

/* By patches, keeping the order of those of one patch. */
static hr2d_status sort_intervals(hr2di_point_viewer *w) {
  const size_t count = w->intervals;
  if (count > UINT32_MAX ||
      hr2di_alloc_reserve(&w->alloc, &w->order, &w->order_room, count, sizeof *w->order) ||
      hr2di_alloc_reserve(&w->alloc, &w->sorted, &w->sorted_room, count, sizeof *w->sorted))
    return HR2D_ENOMEM;
  for (size_t k = 0; k < count; k++) w->order[k] = (uint64_t)w->interval[k].patch << 32 | k;
  const hr2d_status status = hr2di_sort(w->order, count, sizeof *w->order, by_number, w->watch);
  for (size_t k = 0; k < count; k++) w->sorted[k] = w->interval[w->order[k] & UINT32_MAX];
  return status;
}

static int is_hidden(const hr2di_point_viewer *w) {
  return w->scene->effect[HR2D_EFFECT_OCCLUSION].on ||
         ((w->scene->sky.pieces || hr2di_symmetry_cuts(&w->scene->symmetry)) &&
          w->scene->parts.wanted);
}

static hr2d_status examine(hr2di_point_viewer *w, const hr2di_ray border[2],
                           hr2di_view_from *seen) {
  const int hidden = is_hidden(w);
  w->intervals = w->arcs = 0;
  w->back = (hr2di_sum){0, 0};
  hr2d_status status = hr2di_watch_work(w->watch, 1);
  if (!status) status = hidden ? hr2di_view_walk(w, border) : hr2di_view_all(w);
  if (!status && hidden) status = sort_intervals(w);
  if (status) return status;
  const hr2di_visible_interval *interval = hidden ? w->sorted : w->interval;
  hr2di_sum front = {0, 0};
  for (size_t k = 0; k < w->intervals; k++) hr2di_sum_add(&front, interval[k].sine);
  *seen = (hr2di_view_from){.interval = interval,
                            .count = w->intervals,
                            .arc = (const double(*)[2])w->arc,
                            .arcs = w->arcs,
                            .front = fmin(hr2di_sum_total(&front), 1),
                            .back = fmin(hr2di_sum_total(&w->back), 1)};
  seen->sky = fmax(1 - seen->front - seen->back, 0);
  return HR2D_OK;
}

hr2d_status hr2di_view_at(hr2di_point_viewer *viewer, size_t patch, double t,
                          hr2di_view_from *seen) {
  hr2di_viewpoint_init(&viewer->viewpoint, viewer->scene->patch[patch].scaled, patch, t);
  return examine(viewer, NULL, seen);
}

hr2d_status hr2di_view_between(hr2di_point_viewer *viewer, size_t patch, double t,
                               const hr2d_point border[2], hr2di_view_from *seen) {
  hr2di_ray ray[2];
  hr2di_viewpoint_init(&viewer->viewpoint, viewer->scene->patch[patch].scaled, patch, t);
  for (int k = 0; k < 2; k++) {
    ray[k] = hr2di_ray_to(&viewer->viewpoint, border[k]);
    hr2di_ray_measure(&viewer->viewpoint, &ray[k]);
  }
  const int all = !(ray[0].height > 0) || !(ray[1].height > 0) || !is_hidden(viewer);
  viewer->sines_only = 1;
  const hr2d_status status = examine(viewer, all ? NULL : ray, seen);
  viewer->sines_only = 0;
  return status;
}
