/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points in the cells of a grid, to find those in a strip. */
#ifndef HR2D_SRC_MESH_POINT_GRID_H
#define HR2D_SRC_MESH_POINT_GRID_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <stddef.h>
#include <stdint.h>

#include "base/watch.h"

typedef struct hr2di_point_grid {
  double x0, y0, cell[2]; /* cell widths and heights; 0 if all points have one x or y */
  uint32_t columns, rows;
  uint32_t *first; /* per cell, in rows: where its points begin in `number`; one more */
  uint32_t *number;
} hr2di_point_grid;

/* Columns [from, to) of a row. */
typedef struct hr2di_grid_span {
  uint32_t from, to;
} hr2di_grid_span;

/* Of 1 ≤ count < 2³¹ finite points.  HR2D_OK, HR2D_ENOMEM or the status of the watch; to be
   cleared in any case. */
hr2d_status hr2di_point_grid_init(hr2di_point_grid *grid, const hr2d_point *point, size_t count,
                                  const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_point_grid_clear(hr2di_point_grid *grid, const hr2d_allocator *alloc);

/* The cells of a row that have all of its points in front of or behind a segment: those whose
   foot on the line of the segment is between its ends. */
hr2di_grid_span hr2di_point_grid_strip(const hr2di_point_grid *grid, uint32_t row,
                                       hr2d_segment segment);

#endif
