/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The triangle in front of a patch has a vertex opposite to it; of the walls at this vertex,
   the two are taken that border on the same free sector, to the left and to the right. */
#include "scene/near-pairs.h"

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "triangulation/triangulation.h"

/* A sector is searched through so many triangles at most. */
enum { MOST_STEPS = 16 };

typedef struct pair {
  uint32_t i, j;
} pair;

typedef struct finder {
  const hr2d_scene *scene;
  hr2di_triangulation plane; /* of the patches */
  pair *pair;
  size_t pairs;
  hr2di_watch *watch;
} finder;

static int32_t half_edge(int32_t h, int turn) {
  return h / 4 * 4 + (h % 4 + turn) % 3;
}

/* Adds patch i with the patch whose front is on the side of an edge that `across` names. */
static void add(finder *f, uint32_t i, int32_t across) {
  if (across >= 0 || across == HR2DI_SKY) return;
  const uint32_t first = (uint32_t)~across / 2, left = !((uint32_t)~across % 2);
  uint32_t e = first;
  do {
    const hr2di_wall_edge *edge = &f->plane.edge[e];
    const int along = edge->from == f->plane.edge[first].from;
    if ((along ? left : !left) && edge->wall != i) {
      f->pair[f->pairs++] = (pair){i, edge->wall};
      return;
    }
    e = edge->same;
  } while (e != first);
}

/* Turns around the corner opposite to h, to the edge behind the free sector on one side. */
static int32_t turn(const hr2di_triangulation *t, int32_t h, int left) {
  int32_t across = t->triangle[h / 4].across[half_edge(h, left ? 1 : 2) % 4];
  for (int step = 0; step < MOST_STEPS && across >= 0; step++)
    across = t->triangle[across / 4].across[half_edge(across, left ? 2 : 1) % 4];
  return across;
}

static hr2d_status find_pairs(finder *f) {
  const hr2di_triangulation *t = &f->plane;
  hr2d_status status = HR2D_OK;
  f->pair = hr2di_alloc(&f->scene->alloc, t->edges, 2 * sizeof *f->pair);
  if (!f->pair) return HR2D_ENOMEM;
  for (size_t k = 0; k < t->edges && !status; k++) {
    status = hr2di_watch_work(f->watch, 4);
    add(f, t->edge[k].wall, turn(t, t->edge[k].half_edge[0], 0));
    add(f, t->edge[k].wall, turn(t, t->edge[k].half_edge[0], 1));
  }
  return status;
}

/* Sorts the pairs by patch, from both sides. */
static hr2d_status sort_pairs(const finder *f, hr2di_near_pairs *near) {
  const size_t n = f->scene->patches;
  near->other = hr2di_alloc(&f->scene->alloc, f->pairs, 2 * sizeof *near->other);
  if (!near->other) return HR2D_ENOMEM;
  hr2d_status status = hr2di_watch_work(f->watch, f->pairs / 4);
  for (size_t k = 0; k < f->pairs; k++) {
    near->first[f->pair[k].i + 1]++;
    near->first[f->pair[k].j + 1]++;
  }
  for (size_t k = 0; k < n; k++) near->first[k + 1] += near->first[k];
  for (size_t k = f->pairs; k-- > 0 && !status;) {
    const pair p = f->pair[k];
    near->other[--near->first[p.i + 1]] = p.j;
    near->other[--near->first[p.j + 1]] = p.i;
  }
  for (size_t k = 0; k < n; k++) near->first[k] = near->first[k + 1];
  near->first[n] = (uint32_t)(2 * f->pairs);
  return status;
}

hr2d_status hr2di_near_pairs_init(hr2di_near_pairs *near, const hr2d_scene *scene,
                                  hr2di_watch *watch) {
  finder f = {.scene = scene, .watch = watch};
  hr2di_conflict conflict;
  near->first = hr2di_alloc_zero(&scene->alloc, scene->patches + 1, sizeof *near->first);
  near->other = NULL;
  if (!near->first) return HR2D_ENOMEM;
  hr2d_status status =
      hr2di_triangulation_init(&f.plane, &scene->alloc, &scene->patch[0].scaled, scene->patches,
                               sizeof *scene->patch, &conflict, watch);
  const int cross = status == HR2D_ESCENE && !conflict.together;
  if (status == HR2D_ESCENE) status = HR2D_OK;
  if (!status && !cross) status = find_pairs(&f);
  if (!status && !cross) status = sort_pairs(&f, near);
  hr2di_alloc_free(&scene->alloc, f.pair);
  hr2di_triangulation_clear(&f.plane);
  return status;
}
