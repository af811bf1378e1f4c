/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a point of a patch sees, in every direction, by brute force: the directions of all ends
   are sorted, and between two of them each patch is asked whether it is the nearest. */
#ifndef HR2D_TESTS_INDEPENDENT_POINT_SWEEP_H
#define HR2D_TESTS_INDEPENDENT_POINT_SWEEP_H

#include <stddef.h>

typedef long double real;

typedef struct spot {
  real x, y;
} spot;

/* Patches ax ay bx by, with their front on the left. A back is opaque and black, unless another
   patch has the same ends in the opposite order. */
typedef struct sweep_patches {
  size_t count;
  const double (*at)[4];
} sweep_patches;

/* The frame of a point: the origin is the point, the first axis runs along its patch, the
   second is the normal. */
typedef struct sweep_frame {
  size_t patch;
  spot origin, along;
} sweep_frame;

/* What is seen between two directions, which are angles from the normal towards the end of the
   patch. */
typedef struct sweep_span {
  real low, high;
  size_t seen; /* a patch, or one of: */
} sweep_span;
#define SWEEP_SKY  ((size_t)-1)
#define SWEEP_BACK ((size_t)-2)

spot sweep_place(const sweep_patches *p, size_t patch, real t);
sweep_frame sweep_frame_at(const sweep_patches *p, size_t patch, real t);
spot sweep_local(const sweep_frame *f, spot place);
real sweep_angle(spot local);
real sweep_cross(spot p, spot q);

/* From the first direction to the last one; `span` has room for 2·count + 1. Returns how many
   there are. */
size_t sweep_all(const sweep_patches *p, const sweep_frame *f, sweep_span *span);

/* The places t of a patch where a line through two ends of patches that it sees meets it, with
   0 and 1, in ascending order. To be freed by the caller. */
real *sweep_events(const sweep_patches *p, size_t patch, size_t *count);

/* How near other patches come to a part of a patch without touching it. */
real sweep_clearance(const sweep_patches *p, size_t patch, real from, real to);

#endif
