/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sorts the ends of walls along a Hilbert curve and makes those alike one vertex. */
#include "triangulation/points.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/vector.h"
#include "triangulation/hilbert.h"
#include "triangulation/merge-vertices.h"

/* An end of a wall. */
typedef struct tip {
  uint64_t place; /* on the curve */
  hr2d_point at;
  uint32_t end; /* 2·wall + which */
} tip;

static int by_place(const void *left, const void *right) {
  const tip *l = left, *r = right;
  if (l->place != r->place) return l->place < r->place ? -1 : 1;
  if (l->at.x != r->at.x) return l->at.x < r->at.x ? -1 : 1;
  if (l->at.y != r->at.y) return l->at.y < r->at.y ? -1 : 1;
  return (l->end > r->end) - (l->end < r->end);
}

static double largest(hr2d_point p) {
  return fmax(fabs(p.x), fabs(p.y));
}

/* Also makes the pieces and finds the tolerance.  2^32 cells a side, a little less. */
static hr2d_status place_tips(hr2di_mesh *m, tip *tips) {
  hr2d_point low = {HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL};
  hr2d_status status = HR2D_OK;
  for (uint32_t w = 0; w < m->walls && !status; w++) {
    const hr2d_segment s = *hr2di_mesh_wall(m, w);
    status = hr2di_mesh_poll(m, w);
    tips[2 * w] = (tip){.at = s.a, .end = 2 * w};
    tips[2 * w + 1] = (tip){.at = s.b, .end = 2 * w + 1};
    m->piece[w] = (hr2di_piece){{.wall = w, .same = HR2DI_NO_PIECE}, HR2DI_NO_PIECE};
    low = (hr2d_point){fmin(low.x, fmin(s.a.x, s.b.x)), fmin(low.y, fmin(s.a.y, s.b.y))};
    high = (hr2d_point){fmax(high.x, fmax(s.a.x, s.b.x)), fmax(high.y, fmax(s.a.y, s.b.y))};
  }
  m->unit = 0x1p-52 * fmax(largest(low), largest(high));
  m->tolerance = m->units * m->unit;
  const double wide = fmax(fmax(high.x - low.x, high.y - low.y), 0x1p-500);
  const double scale = 0x0.ffffffffp+32 / wide;
  for (size_t k = 0; k < 2 * m->walls && !status; k++) {
    status = hr2di_mesh_poll(m, k);
    tips[k].place = hr2di_hilbert_place((uint32_t)((tips[k].at.x - low.x) * scale),
                                        (uint32_t)((tips[k].at.y - low.y) * scale));
  }
  return status;
}

/* Numbers the vertices in the order of the curve. */
static hr2d_status number(hr2di_mesh *m, hr2di_merge_vertices *merged, const tip *tips) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0, end; k < 2 * m->walls && !status; k = end) {
    double reach = INFINITY;
    status = hr2di_watch_work(m->watch, 2);
    for (end = k; end < 2 * m->walls && hr2di_point_same(tips[end].at, tips[k].at); end++)
      reach = fmin(reach, hr2di_mesh_reach(m, tips[end].end / 2));
    if (!status) status = hr2di_merge_vertices_add(merged, tips[k].at, reach);
    for (size_t i = k; i < end && !status; i++) {
      hr2di_wall_edge *e = &m->piece[tips[i].end / 2].edge;
      *(tips[i].end % 2 ? &e->to : &e->from) = merged->found;
    }
  }
  m->vertices = merged->count + 4;
  return status;
}

hr2d_status hr2di_points_init(hr2di_mesh *m) {
  const size_t count = 2 * m->walls;
  tip *tips = hr2di_alloc(m->alloc, count, sizeof *tips);
  m->at = hr2di_alloc(m->alloc, count + 4, sizeof *m->at);
  m->piece = hr2di_alloc(m->alloc, m->walls, sizeof *m->piece);
  m->capacity = m->pieces = m->walls;
  hr2d_status status = tips && m->at && m->piece ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = place_tips(m, tips);
  if (!status) status = hr2di_sort(tips, count, sizeof *tips, by_place, m->watch);
  hr2di_merge_vertices merged = {.at = m->at, .watch = m->watch};
  if (!status)
    status = hr2di_merge_vertices_init(&merged, m->alloc, count, fmax(m->tolerance, m->unit));
  if (!status) status = number(m, &merged, tips);
  hr2di_merge_vertices_clear(&merged, m->alloc);
  hr2di_alloc_free(m->alloc, tips);
  return status;
}
