/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each piece in turn: looks for where it leaves its ends, follows it to the next vertex on its
   line, and makes room for it (Anglada 1997). */
#include "triangulation/constraints.h"

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "triangulation/cavity.h"
#include "triangulation/pieces.h"

typedef struct inserter {
  hr2di_mesh *m;
  hr2di_conflict *conflict;
  hr2di_cavity cavity;
  uint32_t *waiting; /* pieces that are not in the mesh yet */
  size_t waits, room;
} inserter;

static hr2d_status wait_for(inserter *in, uint32_t piece) {
  if (hr2di_alloc_reserve(in->m->alloc, &in->waiting, &in->room, in->waits + 1,
                          sizeof *in->waiting))
    return HR2D_ENOMEM;
  in->waiting[in->waits++] = piece;
  return HR2D_OK;
}

/* A turn around a vertex, from half-edge to half-edge, for the place where the line to another
   vertex leaves. */
typedef struct turn {
  uint32_t at, to;
  int32_t h; /* leaves `at` */
  int sign;  /* the side of h on which `to` lies */
} turn;

static turn turn_begin(const hr2di_mesh *m, uint32_t at, uint32_t to) {
  const int32_t h = m->out[at];
  return (turn){at, to, h, hr2di_orient_sign(m->at[at], m->at[hr2di_mesh_to(m, h)], m->at[to])};
}

/* Whether the line leaves along h or between h and the edge after it; else goes on to that. */
static int turn_step(const hr2di_mesh *m, turn *t) {
  if (hr2di_mesh_to(m, t->h) == t->to) {
    t->sign = 0;
    return 1;
  }
  const uint32_t q = hr2di_mesh_apex(m, t->h);
  const int sign = hr2di_orient_sign(m->at[t->at], m->at[q], m->at[t->to]);
  if (t->sign >= 0 && sign < 0) return 1;
  t->h = hr2di_mesh_twin(m, hr2di_mesh_before(t->h));
  t->sign = sign;
  return 0;
}

/* Turns around both ends at once, as one of them may have very many edges: the sum of the
   lesser degrees over the edges of a planar graph is linear (Chiba and Nishizeki 1985). */
static hr2d_status find_start(const inserter *in, uint32_t piece, turn *found) {
  const hr2di_wall_edge e = in->m->piece[piece].edge;
  turn t[2] = {turn_begin(in->m, e.from, e.to), turn_begin(in->m, e.to, e.from)};
  for (;;)
    for (int k = 0; k < 2; k++) {
      const hr2d_status status = hr2di_watch_work(in->m->watch, 1);
      if (status) return status;
      if (!turn_step(in->m, &t[k])) continue;
      *found = t[k];
      return HR2D_OK;
    }
}

/* The line is in the mesh from its start to v, by the half-edge h.  What is left of the piece
   waits. */
static hr2d_status arrive(inserter *in, uint32_t piece, const turn *start, uint32_t v,
                          int32_t h) {
  uint32_t rest;
  if (v == start->to) {
    hr2di_piece_put(in->m, piece, h);
    return HR2D_OK;
  }
  hr2d_status status = hr2di_piece_cut(in->m, piece, v, &rest);
  const int forward = start->at == in->m->piece[piece].edge.from;
  if (!status) status = wait_for(in, forward ? rest : piece);
  if (!status) hr2di_piece_put(in->m, forward ? piece : rest, h);
  return status;
}

/* Cuts a piece at v; it waits again, in two parts. */
static hr2d_status lead_through(inserter *in, uint32_t piece, uint32_t v) {
  uint32_t rest;
  hr2d_status status = hr2di_piece_cut(in->m, piece, v, &rest);
  if (!status) status = wait_for(in, rest);
  return status ? status : wait_for(in, piece);
}

/* A piece meets another one, which is in the mesh.  If one of them ends within the reach of the
   other wall, that is led through this end; the nearest counts.  Else they cross. */
static hr2d_status meet(inserter *in, uint32_t piece, uint32_t other) {
  const hr2di_wall_edge e = in->m->piece[piece].edge, f = in->m->piece[other].edge;
  const uint32_t end[4] = {f.from, f.to, e.from, e.to};
  double nearest = INFINITY;
  int which = -1;
  for (int k = 0; k < 4; k++) {
    const double distance = hr2di_piece_distance(in->m, k < 2 ? piece : other, end[k]);
    if (distance >= nearest) continue;
    nearest = distance;
    which = k;
  }
  if (which < 0) return hr2di_piece_conflict(in->m, piece, other, 0, in->conflict);
  if (which < 2) return lead_through(in, piece, end[which]);
  hr2d_status status = hr2di_cavity_look(in->m, &in->cavity, f.half_edge[0]);
  hr2di_piece_take(in->m, other);
  for (uint32_t k = other, next; k != HR2DI_NO_PIECE && !status; k = next) {
    next = hr2di_piece_part(in->m, k);
    status = lead_through(in, k, end[which]);
  }
  return status ? status : wait_for(in, piece);
}

/* Follows a line that leaves `start` between two edges, to the next vertex on it. */
static hr2d_status follow(inserter *in, uint32_t piece, const turn *start) {
  hr2di_mesh *m = in->m;
  int32_t h = hr2di_mesh_next(start->h), made;
  hr2d_status status = hr2di_cavity_begin(m, &in->cavity, h);
  while (!status) {
    const int32_t back = hr2di_mesh_across(m, h);
    if (back < 0) return meet(in, piece, hr2di_mesh_piece(back));
    const uint32_t v = hr2di_mesh_apex(m, back);
    const int side =
        v == start->to ? 0 : hr2di_orient_sign(m->at[start->at], m->at[start->to], m->at[v]);
    if (side == 0) {
      status = hr2di_cavity_close(m, &in->cavity, h, &made);
      if (!status) status = arrive(in, piece, start, v, made);
      return status ? status : hr2di_cavity_settle(m, &in->cavity);
    }
    status = hr2di_cavity_go_on(m, &in->cavity, &h, side < 0);
  }
  return status;
}

static hr2d_status insert(inserter *in, uint32_t piece) {
  turn start;
  const hr2d_status status = find_start(in, piece, &start);
  if (status) return status;
  if (start.sign == 0) return arrive(in, piece, &start, hr2di_mesh_to(in->m, start.h), start.h);
  return follow(in, piece, &start);
}

hr2d_status hr2di_constraints_insert(hr2di_mesh *m, hr2di_conflict *conflict) {
  inserter in = {.m = m, .conflict = conflict};
  hr2d_status status = HR2D_OK;
  for (uint32_t w = 0; w < m->walls && !status; w++) {
    if (m->piece[w].edge.from == m->piece[w].edge.to) continue;
    status = wait_for(&in, w);
    while (in.waits > 0 && !status) status = insert(&in, in.waiting[--in.waits]);
    if (!status) status = hr2di_cavity_settle(m, &in.cavity);
  }
  hr2di_cavity_clear(m, &in.cavity);
  hr2di_alloc_free(m->alloc, in.waiting);
  return status;
}
