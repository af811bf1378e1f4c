/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stars: many segments that share an end, as the spokes of a wheel.

   Two segments that share an end p cross nowhere else, and lie on one another only if their
   directions from p differ by less than a rounding: with d below twice a rounding r the end of
   the shorter, of length s, is off the line of the longer, so that sin φ < 2r/s.  As
   r ≤ 2^-50·max(M, min(1, 2^30·s)) with M ≤ 2, this is below 2^-48·max(1/s, 2^29).

   So the pairs of a star that may meet are neighbours by direction, and a star of n segments
   has n log n work and not n². */
#ifndef HR2D_SRC_GEOMETRY_STARS_H
#define HR2D_SRC_GEOMETRY_STARS_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <stdint.h>

#include "base/watch.h"

/* With fewer segments all pairs take less than a star does. */
enum { HR2DI_STAR_LEAST = 16 };
#define HR2DI_NO_STAR UINT32_MAX

/* A segment of a star and its direction from the common end. */
typedef struct hr2di_ray {
  double angle; /* in [−π, π] */
  uint32_t segment;
} hr2di_ray;

typedef struct hr2di_star {
  uint32_t first, last; /* its rays and its members are [first, last) */
  double near;          /* rays whose angles differ by more do not meet */
} hr2di_star;

typedef struct hr2di_stars {
  const hr2d_allocator *alloc;
  hr2di_star *star;
  uint32_t count;
  hr2di_ray *ray;   /* star by star, by direction */
  uint32_t *member; /* star by star, in ascending order */
  uint32_t *of;     /* per segment: its star, or HR2DI_NO_STAR; NULL: there is no star */
  uint32_t *place;  /* per segment of a star: which ray it is */
} hr2di_stars;

/* Finds the stars of scaled segments that lie `stride` bytes apart.  A segment is in one star
   at most, that of its end with more segments.  HR2D_OK, HR2D_ENOMEM or the status of the
   watch; to be ended by hr2di_stars_clear() in any case. */
hr2d_status hr2di_stars_init(hr2di_stars *stars, const hr2d_allocator *alloc,
                             const hr2d_segment *first, size_t count, size_t stride,
                             hr2di_watch *watch);
void hr2di_stars_clear(hr2di_stars *stars);

/* Calls `take` with the segments of its star whose direction is near to that of a segment, and
   with the next one on each side in any case; with some of them twice. */
void hr2di_stars_neighbours(const hr2di_stars *stars, uint32_t segment,
                            void (*take)(void *ctx, uint32_t other), void *ctx);

#endif
