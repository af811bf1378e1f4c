/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The triangles that a new part of a wall crosses, and those on its two sides that replace
   them. */
#ifndef HR2D_SRC_TRIANGULATION_CAVITY_H
#define HR2D_SRC_TRIANGULATION_CAVITY_H

#include "triangulation/mesh.h"

/* A vertex on the border of a cavity, and the edge to it from the vertex before it on its
   chain. */
typedef struct hr2di_cavity_edge {
  uint32_t vertex;
  int32_t within;  /* the half-edge in the cavity */
  int32_t outside; /* what the triangle that will have this edge is to be hooked to */
  uint32_t pair;   /* if both sides of the edge are in the cavity: 1 + the first rim of it */
} hr2di_cavity_edge;

/* Chains of the vertices on the left and on the right of the line, each from its start on.  The
   arrays are used again by the next cavity. */
typedef struct hr2di_cavity {
  hr2di_cavity_edge *edges[2];
  size_t count[2], room[2];
  int32_t *triangle; /* that the line crosses; then those that were flipped */
  size_t triangles, triangle_room;
  int32_t *half_edge; /* to be looked at */
  size_t half_edges, half_edge_room;
} hr2di_cavity;

void hr2di_cavity_clear(const hr2di_mesh *m, hr2di_cavity *c);

/* Each returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */

/* Begins where a line starts: at the corner opposite to h, in the triangle of h. */
hr2d_status hr2di_cavity_begin(const hr2di_mesh *m, hr2di_cavity *c, int32_t h);

/* Goes on through the free edge *h of the last triangle.  The corner behind it is on the left
   (side 0) or on the right (side 1) of the line; *h becomes the edge through which the line
   leaves. */
hr2d_status hr2di_cavity_go_on(const hr2di_mesh *m, hr2di_cavity *c, int32_t *h, int side);

/* Ends at the corner behind the free edge h, and makes the new triangles.  *made is the
   half-edge from the start to the end of the line.  After a failure the mesh is not whole. */
hr2d_status hr2di_cavity_close(hr2di_mesh *m, hr2di_cavity *c, int32_t h, int32_t *made);

/* Adds a triangle to the list. */
hr2d_status hr2di_cavity_touch(const hr2di_mesh *m, hr2di_cavity *c, int32_t t);

/* Flips edges of new triangles, and around them, until no circle is surely against it. */
hr2d_status hr2di_cavity_settle(hr2di_mesh *m, hr2di_cavity *c);

/* Lets hr2di_cavity_settle() look at h. */
hr2d_status hr2di_cavity_look(const hr2di_mesh *m, hr2di_cavity *c, int32_t h);

#endif
