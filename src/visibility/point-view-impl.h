/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of a point's view: the directions of vertices, and the arcs of directions that
   patches cover. */
#ifndef HR2D_SRC_VISIBILITY_POINT_VIEW_IMPL_H
#define HR2D_SRC_VISIBILITY_POINT_VIEW_IMPL_H

#include "base/neumaier-sum.h"
#include "geometry/determinant.h"
#include "visibility/point-view.h"

/* HR2DI_HORIZON: the end of an arc whose patch goes on behind the patch of the point.
   HR2DI_NO_ARC: no arc. */
#define HR2DI_HORIZON UINT32_MAX
#define HR2DI_NO_ARC  UINT32_MAX

/* A vertex as the point sees it.  Members below `height` are set only if that is positive. */
typedef struct hr2di_bearing {
  hr2di_vector to;     /* from the point */
  double height;       /* over the line of the patch, its sign exact; 0 at the point itself */
  double distance;     /* |to| */
  double sine, cosine; /* of the angle to the normal; the sine grows towards the patch's b */
  double key;          /* from -2 to 2 as directions turn left, to 2^-50 */
} hr2di_bearing;

/* The directions between the ends of a patch: from `right`, counter-clockwise to `left`. */
typedef struct hr2di_arc {
  uint32_t patch;
  uint32_t right, left;          /* vertices, or HR2DI_HORIZON */
  int front;                     /* whether the patch's front looks at the point */
  uint32_t start, end;           /* ranks of these directions */
  uint32_t next_start, next_end; /* arcs of the same rank */
  uint32_t place;                /* in the heap */
} hr2di_arc;

typedef struct hr2di_direction {
  double key;
  uint32_t vertex;
} hr2di_direction;

struct hr2di_viewer {
  hr2d_allocator alloc;
  hr2di_watch *watch;
  const hr2d_scene *scene;
  size_t patches, vertices;
  hr2d_point *vertex;  /* each vertex once, times HR2DI_VIEW_SCALE */
  uint32_t (*end)[2];  /* the vertices of each patch's a and b */
  unsigned char *twin; /* per patch: another one stands back to back with it, end to end */

  /* The point. */
  size_t patch;
  double t;
  hr2di_bearing *bearing;
  hr2di_arc *arc;
  size_t arcs;

  /* The sweep. */
  hr2di_direction *direction[2]; /* sorted, and space to sort */
  uint32_t *rank;                /* per vertex in front, by its direction: from 1 on */
  uint32_t *starting, *ending;   /* per rank: the first arc */
  uint32_t *heap;                /* arcs under way, the nearest on top */
  size_t under_way;

  /* What was seen. */
  hr2di_glimpse *glimpse, *sorted;
  size_t glimpses;
  size_t *first; /* of each patch, to sort */
  hr2di_sum back;
};

/* Coordinates are at most 2; times this, they neither overflow nor underflow. */
#define HR2DI_VIEW_SCALE 0x1p+400

/* u → v turns left as seen from the point: 1; right: -1; exact for the vectors `to`. */
static inline int hr2di_view_turn(const hr2di_viewer *w, uint32_t u, uint32_t v) {
  const double det = hr2di_det(&w->bearing[u].to, &w->bearing[v].to);
  return (det > 0) - (det < 0);
}

/* Notes that the point sees an arc's patch between two directions. */
void hr2di_view_note(hr2di_viewer *w, const hr2di_arc *arc, uint32_t right, uint32_t left);

/* Notes all parts of arcs that the point sees, in the order of directions.  Returns HR2D_OK or
   the status of the watch. */
hr2d_status hr2di_view_sweep(hr2di_viewer *w);

#endif
