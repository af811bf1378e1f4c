/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clumps: joined screens, as their convex hulls.

   A line that has two points of a connected set on different sides meets the set.  The lines
   from i to j are behind i before they come to it, and behind j when they have passed it.  So a
   line that misses joined screens between i and j misses all of their hull, and where hulls
   meet, the screens are as good as joined.  In the end all hulls are apart, and none of their
   edges cross, however many screens do. */
#ifndef HR2D_SRC_OCCLUSION_OCCLUDER_HULLS_H
#define HR2D_SRC_OCCLUSION_OCCLUDER_HULLS_H

#include <hr2d/memory.h>
#include <hr2d/status.h>

#include "base/watch.h"
#include "occlusion/clipped-occluders.h"

/* A convex polygon, a segment, or a point. */
typedef struct hr2di_occluder_hull {
  hr2d_segment box; /* from its least coordinates to its greatest */
  size_t first;     /* in hr2di_occluder_hulls::point; counterclockwise */
  size_t points;
} hr2di_occluder_hull;

typedef struct hr2di_occluder_hulls {
  hr2d_allocator alloc;
  hr2di_watch *watch;
  hr2di_occluder_hull *hull; /* 0 has b and c, 1 has a and d */
  size_t hulls, room;
  hr2d_point *point;
  size_t points, point_room;
  int blocked; /* hulls 0 and 1 are joined: no line passes; the rest is not made then */
  /* Work space. */
  uint32_t *parent; /* union-find */
  size_t parent_room;
} hr2di_occluder_hulls;

/* Joins the screens; sorts them.  HR2D_OK, HR2D_ENOMEM or the status of the watch; to be ended
   by hr2di_occluder_hulls_clear() in any case.  Cost O(n log n) for screens that are spread
   out, and the corners of hulls that come near to each other. */
hr2d_status hr2di_occluder_hulls_init(hr2di_occluder_hulls *hulls, const hr2d_allocator *alloc,
                                      const hr2di_opening *opening,
                                      hr2di_clipped_occluder *screen, size_t count,
                                      hr2di_watch *watch);
void hr2di_occluder_hulls_clear(hr2di_occluder_hulls *hulls);

#endif
