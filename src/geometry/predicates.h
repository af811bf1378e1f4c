/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Determinants with full relative accuracy, and decisions by their signs. */
#ifndef HR2D_SRC_GEOMETRY_PREDICATES_H
#define HR2D_SRC_GEOMETRY_PREDICATES_H

#include <hr2d/geometry.h>

#include "base/scaled-double.h"

/* A few units in the last place of coordinates below 2: what is so near to a line was computed
   to lie on it.  Where coordinates are not scaled, it is a fraction of the largest. */
#define HR2DI_TOUCH 0x1p-50

/* (b−a)×(c−a) for any finite points.  The sign is exact and the relative error at most 2·2^-53.
   m is not normalised to [½,1). */
hr2di_scaled hr2di_orient_scaled(hr2d_point a, hr2d_point b, hr2d_point c);

/* (b−a)×(c−a), twice the signed area of the triangle, to a few units in the last
   place.  It may underflow; use hr2d_orientation() where only the sign matters. */
double hr2di_orient(hr2d_point a, hr2d_point b, hr2d_point c);

/* Where p→q meets the line through a and b, as a fraction of p→q, to a few units in the
   last place; nothing under- or overflows.  NaN if p and q lie on the line. */
double hr2di_line_crossing(hr2d_point a, hr2d_point b, hr2d_point p, hr2d_point q);

/* The point of s on the line through p and q, which has the ends of s on different sides, to
   the rounding of its coordinates. */
hr2d_point hr2di_line_crossing_at(hr2d_segment s, hr2d_point p, hr2d_point q);

/* How two segments see each other's fronts, exactly. */
typedef enum hr2di_facing {
  HR2DI_FACING_NONE, /* exchange area 0 */
  HR2DI_FACING_PART, /* one crosses the horizon of the other */
  HR2DI_FACING_FULL
} hr2di_facing;

hr2di_facing hr2di_facing_of(const hr2d_segment *i, const hr2d_segment *j);

#endif
