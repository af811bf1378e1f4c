/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The convex hull of segments: which of them have all others on one side. */
#ifndef HR2D_SRC_GEOMETRY_HULL_H
#define HR2D_SRC_GEOMETRY_HULL_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stddef.h>

#include "base/watch.h"

typedef struct hr2di_hull {
  hr2d_allocator alloc;
  hr2d_point *at;  /* the lower chain, then the upper one, both from the least point, by x and
                      then y, to the greatest */
  size_t count[2]; /* points of the two chains */
} hr2di_hull;

/* The hull of `count` ≥ 1 segments that lie `stride` bytes apart.  HR2D_OK, HR2D_ENOMEM or the
   status of the watch; to be ended by hr2di_hull_clear() in any case.  Cost O(n log n). */
hr2d_status hr2di_hull_init(hr2di_hull *hull, const hr2d_allocator *alloc,
                            const hr2d_segment *first, size_t count, size_t stride,
                            hr2di_watch *watch);

/* On which sides of the line of s, one of the segments or a part of one, the others have points
   that are not on that line: 1 left, 2 right, 3 both; exact.  Cost O(log n). */
unsigned hr2di_hull_sides(const hr2di_hull *hull, hr2d_segment s);

void hr2di_hull_clear(hr2di_hull *hull);

#endif
