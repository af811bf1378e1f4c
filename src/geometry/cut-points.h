/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where to cut walls so that no two cross.  A wall is an undirected segment; patches lie on one
   or both of its sides. */
#ifndef HR2D_SRC_GEOMETRY_CUT_POINTS_H
#define HR2D_SRC_GEOMETRY_CUT_POINTS_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <stddef.h>

#include "base/watch.h"

typedef struct hr2di_cut_wall {
  hr2d_segment s;
  int sides; /* HR2DI_FORWARD, HR2DI_BACKWARD or both: directions of patches */
} hr2di_cut_wall;

enum { HR2DI_FORWARD = 1, HR2DI_BACKWARD = 2 };

/* A stretch of at most this many roundings, a billionth of the scene, that two patches share is
   an accident: at an angle of 2^-20 a rounding shifts a crossing by as much. */
#define HR2DI_SHORT_STRETCH 0x1p+20

typedef struct hr2di_cut {
  hr2d_point at;
  double along; /* grows from a to b */
} hr2di_cut;

/* The cuts of a wall, cut[first, end), from a to b. */
typedef struct hr2di_cut_range {
  size_t first, end;
} hr2di_cut_range;

typedef struct hr2di_cuts {
  const hr2d_allocator *alloc;
  hr2di_watch *watch;
  int exponent; /* points must be doubles when multiplied by 2^exponent */
  hr2di_cut *cut;
  hr2di_cut_range *of; /* by wall */
  size_t count;
  hr2d_point *place; /* where walls cross, each place at least once */
  size_t places, place_capacity;
} hr2di_cuts;

/* Replaces the cuts by the cuts of `walls` walls, and appends to `place` the points where these
   cross.  No two walls may have the same segment.  Coordinates are below 2.  `of` may be NULL
   if `count` is 0.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_cuts_init(hr2di_cuts *cuts, const hr2di_cut_wall *wall, size_t walls);

void hr2di_cuts_clear(hr2di_cuts *cuts);

#endif
