/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A constrained Delaunay triangulation of walls: the plane in triangles, each side of each wall
   a side of triangles. */
#ifndef HR2D_SRC_TRIANGULATION_TRIANGULATION_H
#define HR2D_SRC_TRIANGULATION_TRIANGULATION_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#include "base/watch.h"

/* What is behind the border of the box. */
#define HR2DI_SKY INT32_MIN

typedef struct hr2di_triangle {
  uint32_t corner[3]; /* vertices, counterclockwise */
  /* Behind the edge corner[k] -> corner[(k+1)%3]: the half-edge 4·triangle + k there if >= 0 (a
     free edge), else ~(2·edge + side) of a wall edge, or HR2DI_SKY. */
  int32_t across[3];
} hr2di_triangle;

/* The corners, and the edges that begin there, after and before number k. */
static inline int hr2di_corner_after(int k) {
  return k == 2 ? 0 : k + 1;
}

static inline int hr2di_corner_before(int k) {
  return k == 0 ? 2 : k - 1;
}

/* A part of a wall between two vertices, with none on its inside.  Side 0 is on the left of
   from -> to, side 1 on the right. */
typedef struct hr2di_wall_edge {
  uint32_t wall;        /* which of the segments that the triangulation was made of */
  uint32_t from, to;    /* vertices, in the direction of that segment */
  int32_t half_edge[2]; /* of the triangle on each side: from -> to, and to -> from */
  /* Walls that share a stretch have edges in a ring there: the next one.  Triangles know only
     the edge of the least number in the ring.  The edge itself, if no other wall is there. */
  uint32_t same;
} hr2di_wall_edge;

typedef struct hr2di_triangulation {
  hr2d_allocator alloc;
  hr2d_point *at; /* along a Hilbert curve, then the four corners of a box around all walls */
  size_t vertices;
  /* All triangles but those with a corner of the box make up the convex hull of the walls: what
     leaves them does not come back.  So it ends in the sky where it enters a triangle with a
     corner of at least this number. */
  uint32_t sky;
  hr2di_triangle *triangle;
  size_t triangles;
  hr2di_wall_edge *edge; /* by wall, and along each wall */
  size_t edges;
  uint32_t *edge_of; /* the edges of wall w are [edge_of[w], edge_of[w + 1]) */
  size_t walls;
} hr2di_triangulation;

static inline int hr2di_triangle_is_outside(const hr2di_triangulation *in,
                                            const hr2di_triangle *t) {
  return t->corner[0] >= in->sky || t->corner[1] >= in->sky || t->corner[2] >= in->sky;
}

/* Two walls that have more than an end in common. */
typedef struct hr2di_conflict {
  int together;     /* they share a stretch; else they cross */
  uint32_t wall[2]; /* the lesser number first */
} hr2di_conflict;

/* The tolerance of planes, in units. */
enum { HR2DI_UNITS = 4 };

/* Triangulates `count` walls, segments of finite coordinates below 2^200 that lie `stride`
   bytes apart.  What is within so many `units` in the last place of the largest coordinate is
   joined, so that ends that were computed meet; with 0 all coordinates are exact.  Returns
   HR2D_OK, HR2D_ENOMEM, the status of the watch, or HR2D_ESCENE with the conflict.  To be ended
   by hr2di_triangulation_clear() in any case. */
hr2d_status hr2di_triangulation_init(hr2di_triangulation *t, const hr2d_allocator *alloc,
                                     const hr2d_segment *first, size_t count, size_t stride,
                                     unsigned units, hr2di_conflict *conflict,
                                     hr2di_watch *watch);

void hr2di_triangulation_clear(hr2di_triangulation *t);

#endif
