/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "triangulation/pieces.h"

#include "base/alloc.h"
#include "geometry/crossings.h"
#include "geometry/vector.h"

hr2d_status hr2di_piece_cut(hr2di_mesh *m, uint32_t piece, uint32_t v, uint32_t *rest) {
  /* Two numbers per piece are stored in 31 bits. */
  if (m->pieces >= INT32_MAX / 2 ||
      hr2di_alloc_reserve(m->alloc, &m->piece, &m->capacity, m->pieces + 1, sizeof *m->piece))
    return HR2D_ENOMEM;
  *rest = (uint32_t)m->pieces++;
  hr2di_piece *p = &m->piece[piece];
  m->piece[*rest] = *p;
  m->piece[*rest].edge.from = v;
  p->edge.to = v;
  p->next = *rest;
  return HR2D_OK;
}

void hr2di_piece_put(hr2di_mesh *m, uint32_t piece, int32_t h) {
  const int32_t back = hr2di_mesh_across(m, h);
  hr2di_wall_edge *e = &m->piece[piece].edge;
  if (back < 0) {
    hr2di_wall_edge *first = &m->piece[hr2di_mesh_piece(back)].edge;
    e->same = first->same;
    first->same = piece;
    return;
  }
  const uint32_t side = hr2di_mesh_from(m, h) != e->from;
  hr2di_mesh_hook(m, h, ~(int32_t)(2 * piece + side));
  hr2di_mesh_hook(m, back, ~(int32_t)(2 * piece + 1 - side));
}

void hr2di_piece_take(hr2di_mesh *m, uint32_t piece) {
  const int32_t *h = m->piece[piece].edge.half_edge;
  hr2di_mesh_hook(m, h[0], h[1]);
}

uint32_t hr2di_piece_part(hr2di_mesh *m, uint32_t piece) {
  const uint32_t next = m->piece[piece].edge.same;
  m->piece[piece].edge.same = HR2DI_NO_PIECE;
  return next;
}

double hr2di_piece_distance(const hr2di_mesh *m, uint32_t piece, uint32_t v) {
  const hr2di_wall_edge *e = &m->piece[piece].edge;
  const hr2d_segment *s = hr2di_mesh_wall(m, e->wall);
  const hr2d_segment part = {m->at[e->from], m->at[e->to]};
  if (!hr2di_point_between(*s, part, m->at[v])) return INFINITY;
  const double distance = hr2di_crossings_distance(m->at[v], s);
  return distance <= hr2di_mesh_reach(m, e->wall) ? distance : INFINITY;
}

hr2d_status hr2di_piece_conflict(const hr2di_mesh *m, uint32_t p, uint32_t q, int together,
                                 hr2di_conflict *conflict) {
  const uint32_t i = m->piece[p].edge.wall, j = m->piece[q].edge.wall;
  *conflict = (hr2di_conflict){together, {i < j ? i : j, i < j ? j : i}};
  return HR2D_ESCENE;
}
