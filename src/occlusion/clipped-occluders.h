/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What of an occluder is between two segments that face each other.

   All lines from i = ab to j = cd leave b and c on their right, a and d on their left.  None
   meets the line of i beside i, nor that of j beside j.  So an occluder that reaches the line
   of i beyond b stands on the right hand of all lines, as if it were joined to b.  No point has
   to be computed there; rounded points are only the feet of occluders that cross i or j. */
#ifndef HR2D_SRC_OCCLUSION_CLIPPED_OCCLUDERS_H
#define HR2D_SRC_OCCLUSION_CLIPPED_OCCLUDERS_H

#include <hr2d/geometry.h>

#include "geometry/orient-incident.h"
#include "geometry/predicates.h"

/* Two segments, and what of each is in front of the other, with an end rounded if it is not all
   of it. */
typedef struct hr2di_opening {
  hr2di_axis line[2];   /* of i and of j */
  hr2d_segment part[2]; /* of i and of j */
  int hands[2];         /* whether the ends of the parts on the right, b and c, and those on the
                           left are the ends of i and j */
} hr2di_opening;

/* 0 if rounding leaves nothing of i or of j. */
int hr2di_opening_init(hr2di_opening *opening, hr2di_facing facing, hr2d_segment i,
                       hr2d_segment j);

/* Whether a point lies on line 0 or 1 within roundings, and on the inside of the part there. */
int hr2di_opening_foot(const hr2di_opening *opening, int line, hr2d_point p);

enum { HR2DI_JOINS_RIGHT = 1, HR2DI_JOINS_LEFT = 2 };

typedef struct hr2di_clipped_occluder {
  hr2d_point at[2];
  unsigned points; /* of `at`: ends in front of i and j, and feet on them */
  unsigned joins;  /* HR2DI_JOINS_…: the hands on which all lines must leave it */
} hr2di_clipped_occluder;

/* What of an occluder is in front of i and j; 0 if that is not in the way. */
int hr2di_clipped_occluder_of(hr2di_clipped_occluder *screen, const hr2di_opening *opening,
                              hr2d_segment occluder);

#endif
