/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas of many pairs at once, bit for bit as from hr2d_exchange_area(), and of a
   corner. */
#ifndef HR2D_SRC_GEOMETRY_EXCHANGE_AREA_H
#define HR2D_SRC_GEOMETRY_EXCHANGE_AREA_H

#include <hr2d/oracle.h>
#include <stddef.h>

#include "geometry/determinant.h"

void hr2di_exchange_areas(const hr2d_element *elements, const hr2d_pair *pairs, size_t count,
                          double *area);

/* The vectors between the ends of i = ab and j = cd, without exponents. */
typedef struct hr2di_between {
  hr2di_vector ab, cd, ac, bd, ad, bc;
} hr2di_between;

/* The exchange area of two segments from vectors that have more digits than coordinates.  They
   must be within a factor of 2^400 of 1. */
double hr2di_exchange_area_of_vectors(const hr2di_between *vectors);

/* Of pairs of segments. */
void hr2di_exchange_areas_between(const hr2d_segment (*pairs)[2], size_t count, double *area);

/* (|xy| + |xz| − |yz|)/2 for a triangle xyz that turns left, to some roundings of itself: what
   its sides xy and zx exchange. */
double hr2di_corner_area(hr2d_point x, hr2d_point y, hr2d_point z);

#endif
