/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The classes of lines from i to j: by what they leave on their right and their left. */
#ifndef HR2D_SRC_OCCLUSION_LINE_CLASSES_H
#define HR2D_SRC_OCCLUSION_LINE_CLASSES_H

#include <stddef.h>
#include <stdint.h>

#include "occlusion/corridor.h"
#include "occlusion/shaft.h"
#include "occlusion/walls.h"

/* A wall in the way: what is in front of i and j of it. */
typedef struct hr2di_barrier {
  hr2di_obstacle at;
  uint32_t wall;
  unsigned char hand; /* 1 if it must be left on the right, 2 on the left, 3: blocked */
} hr2di_barrier;

/* Joined barriers that may be left on either side: a range of points. */
typedef struct hr2di_island {
  size_t first, count;
  double width;
} hr2di_island;

/* Work space. */
typedef struct hr2di_classes {
  const hr2di_walls *walls;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  hr2di_barrier *barrier;
  size_t barriers, barrier_capacity;
  uint32_t *parent; /* union-find: barriers that are joined leave no gap */
  size_t parent_capacity;
  hr2di_island *island;
  size_t islands, island_capacity;
  hr2di_incident_point *point; /* of the barriers, joined ones together */
  size_t points, point_capacity;
  uint32_t *joint, *joint_of; /* per vertex and wall: the barrier there, if its joint says so */
  size_t joint_capacity, joint_of_capacity;
  hr2di_chain right, left;             /* of the class under way */
  hr2di_chain wider_right, wider_left; /* the same with an island more */
  hr2di_incident_point *stack;         /* chains of the classes put off */
  size_t stacked, stack_capacity;
  struct hr2di_put_off *put_off;
  size_t put_offs, put_off_capacity;
} hr2di_classes;

void hr2di_classes_init(hr2di_classes *classes, const hr2di_walls *walls,
                        const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_classes_clear(hr2di_classes *classes);

/* Sorts the walls in the way of a shaft: to the right, to the left, and islands.
 *passable is 0 if they are seen to leave no gap.  HR2D_OK, HR2D_ENOMEM or the status of the
   watch. */
hr2d_status hr2di_classes_sort(hr2di_classes *classes, const hr2di_shaft *shaft,
                               const uint32_t *wall, size_t count, int *passable);

/* Visits a class that may be open, and tells whether it is.  `right` and `left` are NULL where
   nothing is in the shaft.  Returns HR2D_OK or a status that ends the visits. */
typedef struct hr2di_class_visitor {
  hr2d_status (*visit)(void *ctx, const hr2di_shaft *shaft, const hr2di_chain *right,
                       const hr2di_chain *left, int *open);
  void *ctx;
} hr2di_class_visitor;

/* Visits the classes, after sorting; *open tells whether there is one. */
hr2d_status hr2di_classes_visit(hr2di_classes *classes, const hr2di_shaft *shaft,
                                const hr2di_class_visitor *visitor, int *open);

#endif
