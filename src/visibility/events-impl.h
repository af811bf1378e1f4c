/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rays of visibility events: what meets at a vertex, and what lines through vertices pass.

   From a point x look along a line: let u be the first vertex on it, v something next.  The
   view changes at x where light passes u on one side.  Hence a ray from v through u need
   not be followed beyond another vertex t on the line, nor v be seen past one: the pair
   (t, u) or (u, t) has the same line.  So all walls are closed here, but for those that end
   on another one: where they do, that one is met within rounding. */
#ifndef HR2D_SRC_VISIBILITY_EVENTS_IMPL_H
#define HR2D_SRC_VISIBILITY_EVENTS_IMPL_H

#include <hr2d/scene.h>

#include "occlusion/walls.h"
#include "scene/patch-runs.h"

#define HR2DI_NO_VERTEX     UINT32_MAX
#define HR2DI_EVENTS_NO_RUN UINT32_MAX

typedef struct hr2di_vertices {
  hr2d_allocator alloc;
  const hr2d_scene *scene;
  const hr2di_walls *walls;
  hr2d_point *point; /* of each vertex of the walls at which one ends */
  uint32_t *first;   /* of wall, those that end at a vertex; one more than vertices */
  uint32_t *wall;
  hr2di_runs runs;
  uint32_t *run;    /* 2·wall + forward: along either side */
  uint32_t blocker; /* the wall found last in the way */
} hr2di_vertices;

/* Of a committed scene; HR2D_OK or HR2D_ENOMEM.  To be ended by hr2di_vertices_clear() in
   either case. */
hr2d_status hr2di_vertices_init(hr2di_vertices *vertices, const hr2d_scene *scene,
                                const hr2d_allocator *alloc);
void hr2di_vertices_clear(hr2di_vertices *vertices);

enum { HR2DI_EVENTS_RIGHT = 1, HR2DI_EVENTS_LEFT = 2 };

/* Where radiosity or visibility is not smooth: v in the above. */
typedef struct hr2di_origin {
  hr2d_point at;
  uint32_t vertex; /* HR2DI_NO_VERTEX if no wall ends there */
  uint32_t host;   /* the wall on whose inside it lies, or HR2DI_NO_WALL */
  unsigned sides;  /* from which sides of the host there is something to see */
  uint32_t via;    /* u of the line on which it was found, or HR2DI_NO_VERTEX */
} hr2di_origin;

/* The patch that the ray from v beyond vertex u, which is not inside a wall, shines upon;
   0 if it is stopped, passes a vertex, leaves, or nothing changes at u. */
int hr2di_origin_reaches(hr2di_vertices *vertices, const hr2di_origin *v, uint32_t u,
                         uint32_t *patch);

/* The next of the walls on whose inside p lies, but for rounding; `stack` has room for
   HR2DI_BOX_DEPTH boxes, and box 0 on it, to begin with. */
uint32_t hr2di_events_next_host(const hr2di_vertices *vertices, hr2d_point p, uint32_t *stack,
                                uint32_t *count);

/* The patch along one side of a wall that has p strictly inside, where the line from → to
   goes through p and is not along the wall; 0 if there is none. */
int hr2di_events_patch_across(const hr2di_vertices *vertices, uint32_t wall, unsigned side,
                              hr2d_point from, hr2d_point to, uint32_t *patch);

#endif
