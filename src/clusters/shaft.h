/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shaft of two segments: the convex hull of their parts in front of each other, in
   which a wall must lie to be in the way. */
#ifndef HR2D_SRC_CLUSTERS_SHAFT_H
#define HR2D_SRC_CLUSTERS_SHAFT_H

#include <hr2d/geometry.h>

#include "geometry/orient-incident.h"
#include "geometry/predicates.h"

/* A half plane n·p + offset > 0, rounded; beyond ±margin the side is certain. */
typedef struct hr2di_half_plane {
  double nx, ny, offset, margin;
} hr2di_half_plane;

typedef struct hr2di_shaft {
  hr2di_pair_lines frame;          /* of the patches of which i and j are parts */
  hr2di_incident_point a, b, c, d; /* i = ab and j = cd, clipped at each other's horizon */
  double x0, x1, y0, y1;           /* box around them */
  hr2di_half_plane side[4]; /* in front of i, of j, between them on the right, on the left */
} hr2di_shaft;

/* Makes the shaft of i and j, parts of two lines; 0 if there is none: they do not face
   each other, or one lies along the line of the other but for rounding, so that nothing
   is between them. */
int hr2di_shaft_init(hr2di_shaft *shaft, hr2di_facing facing, hr2d_segment i, hr2d_segment j,
                     hr2d_segment line_i, hr2d_segment line_j);

/* Whether the shaft may meet a box; never 0 if it does. */
int hr2di_shaft_meets_box(const hr2di_shaft *shaft, double x0, double x1, double y0, double y1);

/* Whether a box is in front of both i and j. */
int hr2di_shaft_has_in_front(const hr2di_shaft *shaft, double x0, double x1, double y0,
                             double y1);

typedef enum hr2di_in_way {
  HR2DI_ASIDE = 0, /* outside of the shaft, or touching it */
  HR2DI_INSIDE,    /* reaches into it */
  HR2DI_ACROSS     /* cuts it in two: nothing passes */
} hr2di_in_way;

/* What of a wall is in front of i and j. */
typedef struct hr2di_obstacle {
  hr2di_incident_point end[2];
  unsigned whole;       /* 1 and 2: this end is the wall's own */
  unsigned right, left; /* 1 and 2: this end reaches that side of the shaft, or is beyond */
} hr2di_obstacle;

/* How a wall lies to the shaft; what of it is in front if it is in the way. */
hr2di_in_way hr2di_shaft_test(const hr2di_shaft *shaft, hr2d_segment wall,
                              hr2di_obstacle *obstacle);

#endif
