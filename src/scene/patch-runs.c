/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes runs of patches by sorting the patches along their walls. */
#include "scene/patch-runs.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "scene/scene-impl.h"

typedef struct place {
  uint32_t wall;
  int forward;  /* the coordinate along the wall grows along the patch */
  double along; /* the coordinate of its start, negative if it falls along the patch */
  uint32_t patch;
} place;

static int by_place(const void *left, const void *right) {
  const place *l = left, *r = right;
  if (l->wall != r->wall) return l->wall < r->wall ? -1 : 1;
  if (l->forward != r->forward) return l->forward - r->forward;
  if (l->along != r->along) return l->along < r->along ? -1 : 1;
  return (l->patch > r->patch) - (l->patch < r->patch);
}

static place place_of(const hr2d_scene *scene, uint32_t patch) {
  const hr2d_segment s = scene->patch[patch].scaled;
  const uint32_t wall = scene->walls.of_segment[patch];
  const hr2d_segment w = scene->walls.wall[wall].at;
  const int by_x = fabs(w.b.x - w.a.x) >= fabs(w.b.y - w.a.y);
  const double from = by_x ? s.a.x : s.a.y, to = by_x ? s.b.x : s.b.y;
  return (place){wall, to > from, to > from ? from : -from, patch};
}

hr2d_status hr2di_runs_init(hr2di_runs *runs, const hr2d_scene *scene, hr2di_watch *watch) {
  const size_t n = scene->patches;
  *runs = (hr2di_runs){.alloc = scene->alloc};
  runs->patch = hr2di_alloc(&runs->alloc, n, sizeof *runs->patch);
  runs->run = hr2di_alloc(&runs->alloc, n, sizeof *runs->run);
  place *places = hr2di_alloc(&runs->alloc, n, sizeof *places);
  if (!runs->patch || !runs->run || !places) {
    hr2di_alloc_free(&runs->alloc, places);
    return HR2D_ENOMEM;
  }
  hr2d_status status = hr2di_watch_work(watch, n / 4);
  for (uint32_t k = 0; k < n; k++) places[k] = place_of(scene, k);
  if (!status) status = hr2di_sort(places, n, sizeof *places, by_place, watch);
  for (uint32_t k = 0; k < n && !status; k++) {
    const int begins = k == 0 || places[k].wall != places[k - 1].wall ||
                       places[k].forward != places[k - 1].forward;
    if (begins) runs->run[runs->runs++].first = k;
    runs->run[runs->runs - 1].last = k + 1;
    runs->patch[k] = places[k].patch;
  }
  hr2di_alloc_free(&runs->alloc, places);
  return status;
}

void hr2di_runs_clear(hr2di_runs *runs) {
  hr2di_alloc_free(&runs->alloc, runs->patch);
  hr2di_alloc_free(&runs->alloc, runs->run);
}
