/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of a pair (i, j): i runs along the axis from 0, and what i sees lies above it.  The
   brute-force methods share it; nothing of it is the library's. */
#ifndef HR2D_TESTS_INDEPENDENT_PAIR_FRAME_H
#define HR2D_TESTS_INDEPENDENT_PAIR_FRAME_H

#include <hr2d/geometry.h>
#include <stddef.h>

typedef long double real;

typedef struct frame_point {
  real along, height; /* in the frame of i */
  real above;         /* height over the line of j, up to a factor */
} frame_point;

/* The signs of height and above are exact: they decide what is in front. */
frame_point frame_of(const hr2d_segment *i, const hr2d_segment *j, hr2d_point p);

/* p + t (q − p) */
frame_point frame_between(frame_point p, frame_point q, real t);

/* Cuts pq to the part in front of i, and of j if `both`; 0 if nothing is left. */
int frame_clip(frame_point *p, frame_point *q, int both);

/* The part of i in front of j; 0 if there is none. */
int frame_front(const hr2d_segment *i, const hr2d_segment *j, real *from, real *to);

/* Where the view of i changes, in ascending order: `from`, `to`, and every place between them
   at which a line through two of the ends meets i.  With `feet` also the places below the ends.
   Returns how many there are; `place` has room for ends·(ends + 1)/2 + 2. */
size_t frame_events(const frame_point *end, size_t ends, real from, real to, int feet,
                    real *place);

#endif
