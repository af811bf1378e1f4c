/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sorts the ends of walls along a Hilbert curve and makes those alike one vertex. */
#include "triangulation/points.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/vector.h"
#include "triangulation/hilbert.h"

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

static hr2d_point end_of(const hr2d_segment *first, size_t stride, size_t end) {
  const hr2d_segment *s = (const void *)((const char *)first + end / 2 * stride);
  return end % 2 ? s->b : s->a;
}

static void place_tips(tip *tips, const hr2d_segment *first, size_t stride, size_t count) {
  hr2d_point low = first->a, high = first->a;
  for (size_t k = 0; k < count; k++) {
    const hr2d_point p = tips[k].at = end_of(first, stride, k);
    tips[k].end = (uint32_t)k;
    low = (hr2d_point){fmin(low.x, p.x), fmin(low.y, p.y)};
    high = (hr2d_point){fmax(high.x, p.x), fmax(high.y, p.y)};
  }
  const double wide = fmax(fmax(high.x - low.x, high.y - low.y), 0x1p-500);
  const double scale = 0x0.ffffffffp+32 / wide;
  for (size_t k = 0; k < count; k++)
    tips[k].place = hr2di_hilbert_place((uint32_t)((tips[k].at.x - low.x) * scale),
                                        (uint32_t)((tips[k].at.y - low.y) * scale));
}

/* Numbers the vertices in the order of the curve. */
static void number(hr2di_mesh *m, const tip *tips, size_t count) {
  for (size_t k = 0; k < count; k++) {
    if (k == 0 || !hr2di_point_same(tips[k].at, tips[k - 1].at))
      m->at[m->vertices++] = tips[k].at;
    hr2di_wall_edge *e = &m->piece[tips[k].end / 2].edge;
    *(tips[k].end % 2 ? &e->to : &e->from) = (uint32_t)m->vertices - 1;
  }
  m->vertices += 4;
}

hr2d_status hr2di_points_init(hr2di_mesh *m, const hr2d_segment *first, size_t stride) {
  const size_t count = 2 * m->walls;
  tip *tips = hr2di_alloc(m->alloc, count, sizeof *tips);
  m->at = hr2di_alloc(m->alloc, count + 4, sizeof *m->at);
  m->piece = hr2di_alloc(m->alloc, m->walls, sizeof *m->piece);
  m->capacity = m->pieces = m->walls;
  hr2d_status status = tips && m->at && m->piece ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = hr2di_watch_work(m->watch, count);
  if (!status) {
    place_tips(tips, first, stride, count);
    for (uint32_t w = 0; w < m->walls; w++)
      m->piece[w] = (hr2di_piece){{.wall = w, .half_edge = {-1, -1}}, HR2DI_NO_PIECE};
    status = hr2di_sort(tips, count, sizeof *tips, by_place, m->watch);
  }
  if (!status) number(m, tips, count);
  hr2di_alloc_free(m->alloc, tips);
  return status;
}
