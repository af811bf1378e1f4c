/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How two segments of a scaled scene lie to each other where they should not: they
   cross, or lie on one another.  Signs are exact; what is within a rounding of
   touching touches.

   A rounding is 4·2^-52·M.  With M the largest coordinate of two segments that covers
   an end p = a + t(b − a) computed in doubles: t(b − a) is off by t·2·2^-53·2M, the sum
   by 2^-53·M more, hence p from the line by √2·5·2^-53·M < 4·2^-52·M.  Scenes are also
   moved after that, which leaves errors of the size of the whole scene: M is at least
   1, the scene's scale, unless that were more than 2^-20 of the shorter segment. */
#ifndef HR2D_SRC_GEOMETRY_CROSSINGS_H
#define HR2D_SRC_GEOMETRY_CROSSINGS_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <stddef.h>

typedef enum hr2di_meeting_kind {
  HR2DI_MEET_FREE,  /* apart, or a touch, or back to back: nothing is wrong */
  HR2DI_MEET_CROSS, /* properly, every end beyond a rounding */
  HR2DI_MEET_LIE,   /* on one another, fronts on the same side */
  HR2DI_MEET_FACE   /* with opposite fronts and no more than a rounding between them */
} hr2di_meeting_kind;

typedef struct hr2di_meeting {
  hr2di_meeting_kind kind;
  int together;        /* sharing a stretch, back to back as well */
  int collinear;       /* together, and exactly on one line */
  hr2d_point from, to; /* the ends of what they share; twice the crossing */
  double sine;         /* of the angle at which they cross */
} hr2di_meeting;

/* What is called a rounding for these two; below 2^-48. */
double hr2di_crossings_rounding(const hr2d_segment *i, const hr2d_segment *j);

/* Coordinates are below 2. */
hr2di_meeting hr2di_crossings_meet(const hr2d_segment *i, const hr2d_segment *j);

/* How far p is from the line of s, to a few units in the last place. */
double hr2di_crossings_distance(hr2d_point p, const hr2d_segment *s);

/* Calls `visit` with i < j for each two segments whose boxes are within a rounding of
   meeting, until it returns other than HR2D_OK, and returns that; HR2D_ENOMEM if there
   is no memory.  Segments lie `stride` bytes apart. */
hr2d_status hr2di_crossings_sweep(const hr2d_allocator *alloc, const hr2d_segment *first,
                                  size_t count, size_t stride,
                                  hr2d_status (*visit)(void *ctx, size_t i, size_t j),
                                  void *ctx);

#endif
