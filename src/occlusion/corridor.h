/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of one class: those that leave some points on their right and others on
   their left.

   Lines from a segment a→b to a segment c→d separate b and c from a and d.  With more
   points on either side they are the lines that separate two convex hulls; a chain is
   the part of a hull that faces the other. */
#ifndef HR2D_SRC_OCCLUSION_CORRIDOR_H
#define HR2D_SRC_OCCLUSION_CORRIDOR_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/status.h>

#include "base/watch.h"
#include "geometry/orient-incident.h"

typedef enum hr2di_hand { HR2DI_RIGHT = 1, HR2DI_LEFT = -1 } hr2di_hand;

/* From b to c on the right hand, from a to d on the left; at least these two points,
   which coincide where i and j touch. */
typedef struct hr2di_chain {
  hr2di_hand hand;
  hr2di_incident_point *point;
  size_t count, capacity;
  hr2di_watch *watch;
} hr2di_chain;

/* What a function below returns after its watch has stopped it has no meaning. */

/* Makes the chain from `from` to `to`; HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_chain_init(hr2di_chain *chain, const hr2d_allocator *alloc,
                             hr2di_incident_point from, hr2di_incident_point to);

/* Adds points to the hull; *grown tells whether one of them lay outside of it.  `known` is
   HR2DI_ON_BOTH, or 0 for turns by what coordinates alone say.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_chain_add(hr2di_chain *chain, const hr2d_allocator *alloc,
                            const hr2di_pair_lines *frame, unsigned known,
                            const hr2di_incident_point *point, size_t count, int *grown);

/* Whether a chain is a hull.  Where walls hug the line of i or j within roundings, what points
   know of that line may contradict what their coordinates say to others, and points are lost;
   by coordinates alone they are not. */
int hr2di_chain_sound(const hr2di_pair_lines *frame, const hr2di_chain *chain);

/* Whether some line from i to j has one chain on its right and the other on its left,
   touching neither.  Exact. */
int hr2di_corridor_open(const hr2di_pair_lines *frame, const hr2di_chain *right,
                        const hr2di_chain *left);

/* The vertices that bound the lines of a class: of the right chain and of the left one. */
typedef struct hr2di_corridor {
  size_t right_first, right_last, left_first, left_last;
} hr2di_corridor;

/* The same; and the vertices.  The line from the first of the left to the last of the right is
   the first, if lines turn left, and that from the first of the right to the last of the left
   the last. */
int hr2di_corridor_find(const hr2di_pair_lines *frame, const hr2di_chain *right,
                        const hr2di_chain *left, hr2di_corridor *corridor);

/* hr2di_corridor_open(), whatever roundings do; and half the measure of these lines, which is
   what they contribute to the exchange area of i. */
int hr2di_corridor_area(const hr2di_pair_lines *frame, const hr2di_chain *right,
                        const hr2di_chain *left, hr2d_segment i, double *area);

#endif
