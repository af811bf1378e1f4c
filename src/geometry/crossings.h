/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds segments of a scaled scene that cross or lie on one another, which they should not.
   Signs are exact; segments within a rounding of touching count as touching.

   A rounding is 4·2^-52·M, where M is the largest coordinate of the two segments.  It covers
   the error of an end p = a + t(b − a) that was computed in doubles: t(b − a) is off by
   t·2·2^-53·2M, the sum by 2^-53·M more, hence p is off the line by √2·5·2^-53·M < 4·2^-52·M.
   A scene may be moved after that, which leaves errors of the size of the whole scene.  So M is
   at least min(1, 2^30·s), where 1 is the scale of the scene and s the length of the shorter
   segment; this lower bound makes a rounding of at most 2^-20·s. */
#ifndef HR2D_SRC_GEOMETRY_CROSSINGS_H
#define HR2D_SRC_GEOMETRY_CROSSINGS_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <stddef.h>

#include "base/watch.h"
#include "geometry/stars.h"

typedef enum hr2di_meeting_kind {
  HR2DI_MEET_FREE,  /* apart, touching, or back to back: nothing is wrong */
  HR2DI_MEET_CROSS, /* properly: no end counts as touching the other segment */
  HR2DI_MEET_LIE,   /* on one another, fronts on the same side */
  HR2DI_MEET_FACE   /* on one another up to rounding, fronts towards each other */
} hr2di_meeting_kind;

typedef struct hr2di_meeting {
  hr2di_meeting_kind kind;
  int together;        /* they share a stretch; also if back to back */
  int collinear;       /* together, and exactly on one line */
  hr2d_point from, to; /* the ends of the shared stretch; both are the crossing if they cross */
  double sine;         /* of the angle at which they cross */
} hr2di_meeting;

/* The length of a rounding, as defined above, for these two segments; below 2^-48. */
double hr2di_crossings_rounding(const hr2d_segment *i, const hr2d_segment *j);

/* How two segments meet.  Coordinates are below 2. */
hr2di_meeting hr2di_crossings_meet(const hr2d_segment *i, const hr2d_segment *j);

/* How far p is from the line of s, to a few units in the last place. */
double hr2di_crossings_distance(hr2d_point p, const hr2d_segment *s);

/* Calls `visit` with i < j for each pair of segments whose bounding boxes meet or are within a
   rounding of meeting; cost O(n log n) and what is visited, for segments that are spread out.
   Stops as soon as `visit` returns anything but HR2D_OK.  Returns HR2D_OK, that status,
   HR2D_ENOMEM, or the status of the watch.  Segments lie `stride` bytes apart. */
hr2d_status hr2di_crossings_sweep(const hr2d_allocator *alloc, const hr2d_segment *first,
                                  size_t count, size_t stride,
                                  hr2d_status (*visit)(void *ctx, size_t i, size_t j),
                                  void *ctx, hr2di_watch *watch);

/* The same in the same order, but for pairs of one star that are apart: hr2di_crossings_meet()
   says nothing of them.  Of those some are visited that are neighbours by direction, at least
   one of each segment.  So the cost stays O(n log n) where many segments share an end.  `stars`
   are those of the segments, or of others in boxes that these span; NULL: they are found here.
 */
hr2d_status hr2di_crossings_find(const hr2d_allocator *alloc, const hr2d_segment *first,
                                 size_t count, size_t stride, const hr2di_stars *stars,
                                 hr2d_status (*visit)(void *ctx, size_t i, size_t j), void *ctx,
                                 hr2di_watch *watch);

#endif
