/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rays of visibility events: which walls meet at a vertex, and which walls a line through
   vertices passes.

   From a point x look along a line: let u be the first vertex on it, and v the next point of
   interest.  The view changes at x if light passes u on one side.  A ray from v through u need
   not be followed beyond another vertex t on the line, and v need not be seen past one: the
   pair (t, u) or (u, t) has the same line.  So walls include their ends here, except an end
   that lies on another wall: there the other wall is met within rounding. */
#ifndef HR2D_SRC_VISIBILITY_EVENTS_IMPL_H
#define HR2D_SRC_VISIBILITY_EVENTS_IMPL_H

#include <hr2d/scene.h>

#include "occlusion/walls.h"

#define HR2DI_NO_VERTEX     UINT32_MAX
#define HR2DI_EVENTS_NO_RUN UINT32_MAX

typedef struct hr2di_vertices {
  hr2d_allocator alloc;
  const hr2d_scene *scene;
  const hr2di_walls *walls;
  hr2d_point *point; /* per vertex of the walls, if a wall ends there */
  uint32_t *first;   /* per vertex: where its walls begin in `wall`; one more */
  uint32_t *wall;    /* the walls that end at each vertex */
  uint32_t *run;     /* at 2·wall + forward: the run along this side of a wall */
  hr2di_watch *watch;
  uint32_t blocker; /* the wall that was last found in the way */
} hr2di_vertices;

/* For a committed scene.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch.  Call
   hr2di_vertices_clear() in any case. */
hr2d_status hr2di_vertices_init(hr2di_vertices *vertices, const hr2d_scene *scene,
                                const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_vertices_clear(hr2di_vertices *vertices);

enum { HR2DI_EVENTS_RIGHT = 1, HR2DI_EVENTS_LEFT = 2 };

/* A point where radiosity or visibility is not smooth: v above. */
typedef struct hr2di_origin {
  hr2d_point at;
  uint32_t vertex; /* HR2DI_NO_VERTEX if no wall ends there */
  uint32_t host;   /* the wall that has it inside, or HR2DI_NO_WALL */
  unsigned sides;  /* the sides of the host from which it matters */
  uint32_t via;    /* u of the line on which it was found, or HR2DI_NO_VERTEX */
} hr2di_origin;

/* Finds the patch that the ray from v through u hits beyond u, a vertex that is not inside a
   wall.  Returns 1, or 0 if the watch has stopped, or the ray is stopped, passes a vertex,
   leaves the scene, or nothing changes at u. */
int hr2di_origin_reaches(hr2di_vertices *vertices, const hr2di_origin *v, uint32_t u,
                         uint32_t *patch);

/* Returns the next wall that has p inside, within rounding, or HR2DI_NO_WALL.  `stack` has room
   for HR2DI_BOX_DEPTH boxes; before the first call it holds box 0. */
uint32_t hr2di_events_next_host(const hr2di_vertices *vertices, hr2d_point p, uint32_t *stack,
                                uint32_t *count);

/* Finds the patch, along one side of a wall, that the line from → to crosses strictly inside;
   the line does not run along the wall.  Returns 1, or 0 if there is none. */
int hr2di_events_patch_across(const hr2di_vertices *vertices, uint32_t wall, unsigned side,
                              hr2d_point from, hr2d_point to, uint32_t *patch);

#endif
