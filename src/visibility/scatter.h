/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shares line classes among the patches along the two sides of walls that see each other. */
#ifndef HR2D_SRC_VISIBILITY_SCATTER_H
#define HR2D_SRC_VISIBILITY_SCATTER_H

#include "scene/side-parts.h"

enum { HR2DI_SHARING_BATCH = 128 };

/* The exchange area of two patches through one line class. */
typedef struct hr2di_contribution {
  double area;
  uint32_t place;        /* whose row it belongs to, in hr2di_runs::patch */
  uint32_t patch;        /* its column */
  unsigned char partial; /* something bounds the view but the patches themselves */
  unsigned char later;   /* the pair's other row comes first in sums */
} hr2di_contribution;

typedef struct hr2di_scatter {
  const hr2di_side_parts *parts;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  hr2di_contribution *share;
  size_t contributions, room;
  /* Work space. */
  hr2d_segment pair[HR2DI_SHARING_BATCH][2];
  hr2di_contribution waiting[HR2DI_SHARING_BATCH]; /* for the area of a pair */
  size_t pairs;
  hr2d_point *point;
  size_t points;
} hr2di_scatter;

/* Sides of walls and the parts of them that share a line class. */
typedef struct hr2di_patch_ranges {
  hr2di_parts near, far;
  int rows_far; /* the rows are those of the far patches */
  int later;
  int part; /* the ranges are not all parts of the two sides */
} hr2di_patch_ranges;

/* Adds the shares of a line class; some of them wait until hr2di_scatter_finish().  HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_scatter_add(hr2di_scatter *scatter, const hr2di_line_class *s,
                              const hr2di_patch_ranges *among);

/* Adds the area of a pair with nothing in the way. */
hr2d_status hr2di_scatter_add_pair(hr2di_scatter *scatter, const hr2d_segment pair[2],
                                   hr2di_contribution share);

/* Adds a pair whose area is known.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_scatter_add_area(hr2di_scatter *scatter, hr2di_contribution share);

hr2d_status hr2di_scatter_finish(hr2di_scatter *scatter);
void hr2di_scatter_clear(hr2di_scatter *scatter);

#endif
