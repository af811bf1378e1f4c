/* SPDX-License-Identifier: GPL-3.0-or-later */
/* At each vertex, the walls that go on behind it are compared with each other.  Walls that do
   not cross there, although it is inside of both, touch within roundings; they are few. */
#include "triangulation/check-crossings.h"

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "triangulation/pieces.h"

/* Whether q is on the left of the way from -> v -> to; no two of the four are in one direction
   from v. */
static int on_left(const hr2di_mesh *m, uint32_t from, uint32_t v, uint32_t to, uint32_t q) {
  const hr2d_point at = m->at[v], next = m->at[q];
  const int turn = hr2di_orient_sign(m->at[from], at, m->at[to]);
  const int before = hr2di_orient_sign(m->at[from], at, next) > 0,
            behind = hr2di_orient_sign(at, m->at[to], next) > 0;
  return turn >= 0 ? before && behind : before || behind;
}

/* Both pieces end in a vertex behind which their walls go on.  Walls that share one of the
   edges there do not cross. */
static int cross(const hr2di_mesh *m, const hr2di_piece *p, const hr2di_piece *q) {
  const uint32_t from = p->edge.from, v = p->edge.to, to = m->piece[p->next].edge.to;
  const uint32_t a = q->edge.from, b = m->piece[q->next].edge.to;
  if (a == from || a == to || b == from || b == to) return 0;
  return on_left(m, from, v, to, a) != on_left(m, from, v, to, b);
}

/* `last` is the last piece found that ends in each vertex, and `before` the one found before
   each piece. */
static hr2d_status examine(const hr2di_mesh *m, uint32_t *last, uint32_t *before,
                           hr2di_conflict *conflict) {
  for (uint32_t k = 0; k < m->pieces; k++) {
    const hr2di_piece *p = &m->piece[k];
    hr2d_status status = hr2di_watch_work(m->watch, 1);
    if (p->next == HR2DI_NO_PIECE) continue;
    before[k] = last[p->edge.to];
    last[p->edge.to] = k;
    for (uint32_t q = before[k]; q != HR2DI_NO_PIECE && !status; q = before[q]) {
      status = hr2di_watch_work(m->watch, 1);
      if (!cross(m, p, &m->piece[q])) continue;
      return hr2di_piece_conflict(m, k, q, 0, conflict);
    }
    if (status) return status;
  }
  return HR2D_OK;
}

hr2d_status hr2di_passes_check(hr2di_mesh *m, hr2di_conflict *conflict) {
  uint32_t *last = hr2di_alloc(m->alloc, m->vertices, sizeof *last);
  uint32_t *before = hr2di_alloc(m->alloc, m->pieces, sizeof *before);
  hr2d_status status = last && before ? HR2D_OK : HR2D_ENOMEM;
  for (size_t v = 0; v < m->vertices && !status; v++) last[v] = HR2DI_NO_PIECE;
  if (!status) status = examine(m, last, before, conflict);
  hr2di_alloc_free(m->alloc, last);
  hr2di_alloc_free(m->alloc, before);
  return status;
}
