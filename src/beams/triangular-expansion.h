/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangular expansion (Bungiu et al. 2014): what lies between two borders that leave an edge
   of a triangulation, rays from a point or parallel lines.

   Both borders cross the edges of the triangles that are entered.  The vertex opposite to such
   an edge is between the borders, which splits what is between them in two; or all of that
   passes the vertex on one side.  It ends at a side of a wall or in the sky.  What is on the
   right of a split is walked first, so that ends come from the right to the left. */
#ifndef HR2D_SRC_BEAMS_TRIANGULAR_EXPANSION_H
#define HR2D_SRC_BEAMS_TRIANGULAR_EXPANSION_H

#include "base/watch.h"
#include "triangulation/triangulation.h"

/* A border is what the client takes for one, of at most so many bytes. */
enum { HR2DI_TRIANGULAR_BORDER = 96 };

/* Where a vertex is: −1 on the right of what is between the borders or on the right one, 1 on
   its left or on the left one, 0 inside.  Then the border through it is written to *split. */
typedef int (*hr2di_triangular_expansion_side_fn)(void *ctx, void *right, void *left,
                                                  uint32_t vertex, void *split);

/* What is between two borders ends at a side of a wall or in the sky, as in
   hr2di_triangle::across.  The left border is the right one of what comes next. */
typedef hr2d_status (*hr2di_triangular_expansion_end_fn)(void *ctx, int32_t what,
                                                         const void *right, void *left);

/* Work space, kept from walk to walk; what is not set is 0. */
typedef struct hr2di_triangular_expansion {
  const hr2di_triangulation *in;
  hr2di_watch *watch;
  hr2d_allocator alloc;
  size_t border; /* the bytes of one */
  int outside;   /* the walk may begin outside of the hull */
  hr2di_triangular_expansion_side_fn side;
  hr2di_triangular_expansion_end_fn end;
  void *ctx;
  uint64_t steps; /* triangles that were entered */
  /* The right border, and left ones, the next one last; each with what is on its left. */
  struct hr2di_triangular_expansion_frame *frame;
  size_t room;
} hr2di_triangular_expansion;

/* Walks from half-edge h, or ends at what it is.  HR2D_OK, HR2D_ENOMEM, the status of the watch
   or of `end`. */
hr2d_status hr2di_triangular_expansion_walk(hr2di_triangular_expansion *x, int32_t h,
                                            const void *right, const void *left);

/* Ends the use of the work space. */
void hr2di_triangular_expansion_clear(hr2di_triangular_expansion *x);

#endif
