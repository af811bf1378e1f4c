/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What can be in the way: walls, and a tree of boxes over them.

   A wall is a longest run of segments on one line, each joined to the next; a run blocks
   what one segment of its length would block.  Walls join where they share a vertex. */
#ifndef HR2D_SRC_OCCLUSION_WALLS_H
#define HR2D_SRC_OCCLUSION_WALLS_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#include "base/watch.h"

#define HR2DI_NO_WALL UINT32_MAX
#define HR2DI_NO_BODY UINT32_MAX

typedef struct hr2di_wall {
  hr2d_segment at;
  uint32_t vertex[2]; /* of its ends */
} hr2di_wall;

/* A leaf has one wall, other nodes have two children, `below` and the one behind it. */
typedef struct hr2di_box {
  double x0, x1, y0, y1;
  uint32_t below;
  uint32_t wall; /* HR2DI_NO_WALL above the leaves */
  uint32_t body; /* of whose walls it holds all, more than one, and no others; else none */
} hr2di_box;

typedef struct hr2di_body hr2di_body;

typedef struct hr2di_walls {
  hr2d_allocator alloc;
  hr2di_wall *wall;
  size_t walls;
  uint32_t *of_segment; /* the wall of each segment they were made from */
  size_t vertices;
  hr2di_body *body;  /* joined walls */
  uint32_t *body_of; /* the body of each wall */
  size_t bodies;
  hr2di_box *box; /* box 0 is around all; 2·walls − 1 of them */
} hr2di_walls;

/* Makes walls of `count` ≥ 1 segments, with coordinates in [-2,2]; HR2D_OK, HR2D_ENOMEM or
   the status of the watch.  To be ended by hr2di_walls_clear() in either case. */
hr2d_status hr2di_walls_init(hr2di_walls *walls, const hr2d_allocator *alloc,
                             const hr2d_segment *segment, size_t count, hr2di_watch *watch);

/* A wall on whose inside p lies, but for a rounding, and not the wall `but`; HR2DI_NO_WALL if
   there is none. */
uint32_t hr2di_walls_host(const hr2di_walls *walls, hr2d_point p, uint32_t but);

void hr2di_walls_clear(hr2di_walls *walls);

#endif
