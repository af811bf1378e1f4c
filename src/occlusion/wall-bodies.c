/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls to bodies, and their chords. */
#include "occlusion/wall-bodies.h"

#include <math.h>

#include "base/alloc.h"
#include "base/union-find.h"

static const double direction[HR2DI_CHORDS][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};

/* Walls that share a vertex get one root, the least of them. */
static void unite(const hr2di_walls *w, uint32_t *parent, uint32_t *first) {
  for (size_t v = 0; v < w->vertices; v++) first[v] = HR2DI_NO_WALL;
  for (uint32_t k = 0; k < w->walls; k++) parent[k] = k;
  for (uint32_t k = 0; k < w->walls; k++)
    for (int e = 0; e < 2; e++) {
      uint32_t *at = &first[w->wall[k].vertex[e]];
      if (*at == HR2DI_NO_WALL) *at = k;
      hr2di_union_join(parent, *at, k);
    }
}

static double along(int k, hr2d_point p) {
  return direction[k][0] * p.x + direction[k][1] * p.y;
}

static void extend(hr2di_body *body, hr2d_point p) {
  for (int k = 0; k < HR2DI_CHORDS; k++) {
    if (along(k, p) < along(k, body->chord[k].a)) body->chord[k].a = p;
    if (along(k, p) > along(k, body->chord[k].b)) body->chord[k].b = p;
  }
}

hr2d_status hr2di_wall_bodies_init(hr2di_walls *w, hr2di_watch *watch) {
  uint32_t *parent = hr2di_alloc(&w->alloc, w->walls, sizeof *parent);
  uint32_t *first = hr2di_alloc(&w->alloc, w->vertices, sizeof *first);
  hr2d_status status = parent && first ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = hr2di_watch_work(watch, w->walls / 4);
  if (!status) unite(w, parent, first);
  for (uint32_t k = 0; k < w->walls && !status; k++) {
    if (k % 16 == 0) status = hr2di_watch_work(watch, 8);
    const uint32_t root = hr2di_union_find(parent, k);
    const hr2d_segment s = w->wall[k].at;
    if (root == k) {
      w->body_of[k] = (uint32_t)w->bodies++;
      for (int c = 0; c < HR2DI_CHORDS; c++) w->body[w->body_of[k]].chord[c] = s;
    }
    w->body_of[k] = w->body_of[root];
    extend(&w->body[w->body_of[k]], s.a);
    extend(&w->body[w->body_of[k]], s.b);
  }
  hr2di_alloc_free(&w->alloc, parent);
  hr2di_alloc_free(&w->alloc, first);
  return status;
}

hr2d_segment hr2di_body_chord_across(const hr2di_body *body, double dx, double dy) {
  if (fabs(dy) > 2.4 * fabs(dx)) return body->chord[0];
  if (fabs(dx) > 2.4 * fabs(dy)) return body->chord[1];
  return body->chord[(dx > 0) == (dy > 0) ? 3 : 2];
}
