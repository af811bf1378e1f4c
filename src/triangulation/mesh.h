/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A triangulation while it is made: triangles that know their neighbours, and the parts of
   walls between them. */
#ifndef HR2D_SRC_TRIANGULATION_MESH_H
#define HR2D_SRC_TRIANGULATION_MESH_H

#include <math.h>

#include "triangulation/triangulation.h"

#define HR2DI_NO_PIECE UINT32_MAX

/* A part of a wall.  Piece w is the first of wall w.  Walls that share a stretch have pieces in
   a list there; the mesh knows only the first of them. */
typedef struct hr2di_piece {
  hr2di_wall_edge edge; /* edge.same is the next in the list, or HR2DI_NO_PIECE */
  uint32_t next;        /* along the wall, or HR2DI_NO_PIECE */
} hr2di_piece;

/* A half-edge is 4·triangle + k; a triangle on the other side of a piece has ~(2·piece + side)
   as its neighbour, as in the triangulation that will be made of the mesh. */
typedef struct hr2di_mesh {
  const hr2d_allocator *alloc;
  hr2di_watch *watch;
  const hr2d_segment *first; /* the walls, `stride` bytes apart */
  size_t stride;
  double unit;      /* in the last place of the largest coordinate */
  unsigned units;   /* that are the tolerance */
  double tolerance; /* what is nearer is joined */
  hr2d_point *at;
  size_t vertices; /* the last four are the corners of the box */
  hr2di_triangle *triangle;
  size_t triangles;
  int32_t *out; /* per vertex, a half-edge that leaves it; NULL while points are inserted */
  hr2di_piece *piece;
  size_t walls, pieces, capacity;
} hr2di_mesh;

static inline const hr2d_segment *hr2di_mesh_wall(const hr2di_mesh *m, size_t wall) {
  return (const void *)((const char *)m->first + wall * m->stride);
}

/* How far a wall may be moved: by no more than it is off because of roundings, and never so far
   that its shape would change. */
static inline double hr2di_mesh_reach(const hr2di_mesh *m, size_t wall) {
  const hr2d_segment *s = hr2di_mesh_wall(m, wall);
  return fmin(m->tolerance, 0x1p-20 * hypot(s->b.x - s->a.x, s->b.y - s->a.y));
}

/* Declares the work of a loop whose turns take up to 0.1 µs; `turn` counts them. */
static inline hr2d_status hr2di_mesh_poll(const hr2di_mesh *m, size_t turn) {
  return turn % 1024 == 0 ? hr2di_watch_work(m->watch, 1024) : HR2D_OK;
}

static inline int32_t hr2di_mesh_next(int32_t h) {
  return (h & 3) == 2 ? h - 2 : h + 1;
}

static inline int32_t hr2di_mesh_before(int32_t h) {
  return (h & 3) == 0 ? h + 2 : h - 1;
}

static inline uint32_t hr2di_mesh_from(const hr2di_mesh *m, int32_t h) {
  return m->triangle[h >> 2].corner[h & 3];
}

static inline uint32_t hr2di_mesh_to(const hr2di_mesh *m, int32_t h) {
  return hr2di_mesh_from(m, hr2di_mesh_next(h));
}

/* The corner opposite to h. */
static inline uint32_t hr2di_mesh_apex(const hr2di_mesh *m, int32_t h) {
  return hr2di_mesh_from(m, hr2di_mesh_before(h));
}

static inline int32_t hr2di_mesh_across(const hr2di_mesh *m, int32_t h) {
  return m->triangle[h >> 2].across[h & 3];
}

static inline uint32_t hr2di_mesh_piece(int32_t across) {
  return (uint32_t)~across >> 1;
}

/* The half-edge back, also through a wall; the edge is not on the border of the box. */
static inline int32_t hr2di_mesh_twin(const hr2di_mesh *m, int32_t h) {
  const int32_t across = hr2di_mesh_across(m, h);
  if (across >= 0) return across;
  return m->piece[hr2di_mesh_piece(across)].edge.half_edge[1 - (~across & 1)];
}

/* Makes `across` what is behind h, and h what is behind that. */
static inline void hr2di_mesh_hook(hr2di_mesh *m, int32_t h, int32_t across) {
  m->triangle[h >> 2].across[h & 3] = across;
  if (across >= 0)
    m->triangle[across >> 2].across[across & 3] = h;
  else if (across != HR2DI_SKY)
    m->piece[hr2di_mesh_piece(across)].edge.half_edge[~across & 1] = h;
}

/* Makes corner a, b, c of triangle t, without neighbours. */
void hr2di_mesh_set(hr2di_mesh *m, int32_t t, uint32_t a, uint32_t b, uint32_t c);

/* The box around points [0, vertices − 4) as two triangles; its corners are the last four
   vertices.  There is room for all triangles.  HR2D_OK or the status of the watch. */
hr2d_status hr2di_mesh_start(hr2di_mesh *m);

/* Makes v a corner of three triangles instead of t, in which it lies; or of four instead of
   those on both sides of h, on which it lies.  v is corner 2 of all of them. */
void hr2di_mesh_split(hr2di_mesh *m, int32_t t, uint32_t v);
void hr2di_mesh_split_edge(hr2di_mesh *m, int32_t h, uint32_t v);

/* Exchanges a free edge for the other diagonal of its quadrilateral.  The triangle of h keeps
   the corner opposite to h as its corner 2. */
void hr2di_mesh_flip(hr2di_mesh *m, int32_t h);

/* Makes `out`.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_mesh_find_out(hr2di_mesh *m);

#endif
