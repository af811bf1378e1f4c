/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What form factors from points of one element to another one are between. */
#ifndef HR2D_SRC_ENCLOSURE_ENCLOSURE_FACTORS_H
#define HR2D_SRC_ENCLOSURE_ENCLOSURE_FACTORS_H

#include <hr2d/geometry.h>

/* An element as a part of its patch: the line of a short element is that of its patch. */
typedef struct hr2di_enclosed {
  hr2d_segment part, patch;
  double dx, dy; /* unit vector along the patch */
  double length; /* of the patch */
  double off;    /* what the coordinates of ends are off at most */
} hr2di_enclosed;

void hr2di_enclosed_init(hr2di_enclosed *e, hr2d_segment part, hr2d_segment patch,
                         unsigned level);

/* A range that holds a number for certain: roundings are in it. */
typedef struct hr2di_range {
  double lower, upper;
} hr2di_range;

/* A function of the place on an element that lies between two straight lines: their values at
   the ends of the element. */
typedef struct hr2di_strip {
  hr2di_range at[2];
} hr2di_strip;

/* Of F(x,j) = ∫j G dy, with nothing in the way, over x on i; not below 0. */
hr2di_strip hr2di_factor_strip(const hr2di_enclosed *i, const hr2di_enclosed *j);

/* The largest G less the smallest one of the points of two elements; infinite if they touch. */
double hr2di_kernel_spread(const hr2di_enclosed *i, const hr2di_enclosed *j);

#endif
