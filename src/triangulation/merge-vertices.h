/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points that are to be one: those within reach of each other. */
#ifndef HR2D_SRC_TRIANGULATION_MERGE_VERTICES_H
#define HR2D_SRC_TRIANGULATION_MERGE_VERTICES_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#include "base/watch.h"

/* The points so far, in a hash of square cells. */
typedef struct hr2di_merge_vertices {
  hr2d_point *at; /* of the caller, with room for all */
  size_t count;
  uint32_t found; /* the point that was added last, or that it is like */
  hr2di_watch *watch;
  double *reach;
  uint32_t *head, *next; /* point + 1 */
  uint64_t mask;
  double cell, tolerance;
} hr2di_merge_vertices;

/* `at` and `watch` are set, the rest is 0.  No reach will be above the tolerance.  HR2D_OK or
   HR2D_ENOMEM; to be ended by hr2di_merge_vertices_clear() in either case. */
hr2d_status hr2di_merge_vertices_init(hr2di_merge_vertices *a, const hr2d_allocator *alloc,
                                      size_t max, double tolerance);
void hr2di_merge_vertices_clear(hr2di_merge_vertices *a, const hr2d_allocator *alloc);

/* Adds a point, unless there is one within the reach of both; the nearest counts.  HR2D_OK or
   the status of the watch. */
hr2d_status hr2di_merge_vertices_add(hr2di_merge_vertices *a, hr2d_point p, double reach);

#endif
