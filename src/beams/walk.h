/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams from one side of a wall edge through a triangulation.

   A beam is the set of lines that cross the edge and then a sequence of free edges.  It splits
   at a vertex that it sees and ends at a side of a wall edge: its lines are then one line
   class. All lines of a beam that is followed are there: it is never followed in vain but to
   sides that nobody looks from, and into the sky. */
#ifndef HR2D_SRC_BEAMS_WALK_H
#define HR2D_SRC_BEAMS_WALK_H

#include "base/watch.h"
#include "beams/line-class.h"
#include "triangulation/triangulation.h"

/* A side of a wall edge: 2·edge + side. */
typedef uint32_t hr2di_wall_side;

/* Takes a line class from the side that is walked from to side j.  The chains are lost when it
   returns. */
typedef hr2d_status (*hr2di_line_class_fn)(void *ctx, const hr2di_line_class *s,
                                           hr2di_wall_side j);

typedef struct hr2di_walk_frame hr2di_walk_frame;

typedef struct hr2di_walk {
  const hr2di_triangulation *in;
  const unsigned char *wanted; /* per side: whether line classes that end there are taken */
  int once;                    /* each line class only from one of its sides, see walk.c */
  hr2di_line_class_fn take;
  void (*see)(void *ctx, uint32_t vertex); /* a vertex that the side sees, maybe not for the
                                              first time; may be NULL */
  void *ctx;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  uint64_t steps; /* triangles that were entered */
  /* Work space, kept from walk to walk. */
  hr2d_point *chain[2];
  size_t capacity[2];
  hr2di_walk_frame *frame;
  size_t frames, room;
} hr2di_walk;

/* The two ends of a side, with its front on the left of a → b. */
hr2d_segment hr2di_wall_side_at(const hr2di_triangulation *t, hr2di_wall_side side);

/* Walks from `side`.  With a `part` of the segment of the side, beams without lines from it are
   dropped where that is certain.  HR2D_OK, HR2D_ENOMEM, the status of the watch or of `take`.
 */
hr2d_status hr2di_walk_from(hr2di_walk *w, hr2di_wall_side side, const hr2d_segment *part);

/* Walks on from `side` of a wall edge as if the edge were free, with the lines of a line class
   that ends at the other side of that edge.  The same statuses.  What `ends` says of the line
   classes that are taken is nothing. */
hr2d_status hr2di_walk_on(hr2di_walk *w, hr2di_wall_side side, const hr2di_line_class *s);

/* The bytes of the work space. */
uint64_t hr2di_walk_bytes(const hr2di_walk *w);

/* Ends the use of the work space. */
void hr2di_walk_clear(hr2di_walk *w);

#endif
