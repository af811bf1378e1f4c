/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The L¹ error of a link: ∫∫ |G(x_c,y_c) − G(x,y)| dy dx (paper, section 4). */
#ifndef HR2D_SRC_ORACLE_L1_H
#define HR2D_SRC_ORACLE_L1_H

#include <hr2d/geometry.h>
#include <hr2d/oracle.h>

/* The error of a pair of segments, in their unit of length, with a relative error of at most
   1e-10.  Infinity if the segments face each other and their centres coincide, or if the ratios
   of lengths and distance are beyond a double.  The order of the segments changes no bit.
   Allocates nothing. */
double hr2di_l1(const hr2d_segment *i, const hr2d_segment *j);

/* Whether scale·hr2di_l1(i, j) ≤ epsilon.  The decision is the same, mostly at a lower cost. */
int hr2di_l1_accept(const hr2d_segment *i, const hr2d_segment *j, double scale, double epsilon);

/* Bounds on hr2di_l1() from the derivatives of G at the centres; low = 0 and high = infinity
   for pairs that are too close or too flat.  `high` also bounds the result of every midpoint
   rule on a product grid. */
typedef struct hr2di_l1_range {
  double low, high;
} hr2di_l1_range;

hr2di_l1_range hr2di_l1_bounds(const hr2d_segment *i, const hr2d_segment *j);

#endif
