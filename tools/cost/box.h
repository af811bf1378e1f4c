/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A box around all patches, with their images: what is seen of the background is seen of it. */
#ifndef HR2D_TOOLS_COST_BOX_H
#define HR2D_TOOLS_COST_BOX_H

#include <hr2d/hr2d.h>

/* Coordinate 0 runs along the axis, 1 across it, to its left.  Mirrors and the ends of a period
   are parallel to a side; there the box is open. */
typedef struct box {
  hr2d_point axis; /* of length 1 */
  double low[2], high[2];
  int open_low[2], open_high[2];
} box;

/* It stands as far away as the scene is wide, or near by, where images go on for ever. */
box box_around(const hr2d_scene *scene);

#endif
