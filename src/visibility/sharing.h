/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shares sights among the patches along the two sides of walls that see each other. */
#ifndef HR2D_SRC_VISIBILITY_SHARING_H
#define HR2D_SRC_VISIBILITY_SHARING_H

#include "scene/side-parts.h"

enum { HR2DI_SHARING_BATCH = 128 };

/* The exchange area of two patches through one sight. */
typedef struct hr2di_share {
  double area;
  uint32_t place;        /* whose row it belongs to, in hr2di_runs::patch */
  uint32_t patch;        /* its column */
  unsigned char partial; /* something bounds the view but the patches themselves */
  unsigned char later;   /* the pair's other row comes first in sums */
} hr2di_share;

typedef struct hr2di_sharing {
  const hr2di_side_parts *parts;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  hr2di_share *share;
  size_t shares, room;
  /* Work space. */
  hr2d_segment pair[HR2DI_SHARING_BATCH][2];
  hr2di_share waiting[HR2DI_SHARING_BATCH]; /* for the area of a pair */
  size_t pairs;
  hr2d_point *point;
  size_t points;
} hr2di_sharing;

/* Sides of walls and the parts of them that share a sight. */
typedef struct hr2di_sharers {
  hr2di_parts near, far;
  int rows_far; /* the rows are those of the far patches */
  int later;
  int part; /* the ranges are not all parts of the two sides */
} hr2di_sharers;

/* Adds the shares of a sight; some of them wait until hr2di_sharing_finish().  HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_sharing_add(hr2di_sharing *sharing, const hr2di_sight *s,
                              const hr2di_sharers *among);

/* Adds the area of a pair with nothing in the way. */
hr2d_status hr2di_sharing_add_pair(hr2di_sharing *sharing, const hr2d_segment pair[2],
                                   hr2di_share share);

/* Adds a pair whose area is known.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_sharing_add_area(hr2di_sharing *sharing, hr2di_share share);

hr2d_status hr2di_sharing_finish(hr2di_sharing *sharing);
void hr2di_sharing_clear(hr2di_sharing *sharing);

#endif
