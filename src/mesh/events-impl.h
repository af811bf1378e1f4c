/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams of visibility events: what an origin sees, and what it sees past the ends of walls.

   From a point x look along a line: let u be the last vertex before x on it, and v the next
   point of interest behind u.  The view changes at x if light passes u on one side.  So the
   angle that v sees, walked through the triangles of the plane, splits at u, and the part on
   the side where light passes ends at x, with the ray through u on its border. */
#ifndef HR2D_SRC_MESH_EVENTS_IMPL_H
#define HR2D_SRC_MESH_EVENTS_IMPL_H

#include "beams/triangular-expansion.h"
#include "scene/scene-impl.h"

#define HR2DI_NO_VERTEX UINT32_MAX

/* A line through an origin and vertex `via` meets the front of a patch strictly inside.  It may
   be found more than once.  A status but HR2D_OK ends the walk. */
typedef hr2d_status (*hr2di_event_fn)(void *ctx, uint32_t patch, double at, uint32_t via);

/* The border of an angle: from the origin through its tip, a vertex that the origin sees, or
   along the wall of the origin. */
typedef struct hr2di_border {
  hr2d_point from, to;
  uint32_t tip;    /* HR2DI_NO_VERTEX for the wall of the origin */
  uint32_t behind; /* the last end of a wall exactly on the ray behind the tip */
} hr2di_border;

typedef struct hr2di_event_beams {
  hr2d_allocator alloc;
  const hr2d_scene *scene; /* with a plane */
  const hr2di_triangulation *in;
  hr2di_watch *watch;
  hr2di_event_fn take;
  void *ctx;
  uint64_t turns; /* triangles that were turned past at vertices */
  /* Found once. */
  uint32_t *wall_of;   /* per edge */
  unsigned char *free; /* per vertex: a wall ends there, and none goes on */
  unsigned char *lit;  /* per triangle: it is in a part of the plane with a patch in light */
  /* The last origin and its number. */
  hr2d_point at;
  uint32_t via;       /* the vertex that is not looked past */
  uint32_t number;    /* counts origins */
  uint32_t *own_wall; /* per wall: the number of the last origin that lies on it */
  uint32_t *own_end;  /* the same per vertex: of whose walls it is an end */
  hr2di_triangular_expansion between; /* two borders */
} hr2di_event_beams;

/* For a scene with a plane.  HR2D_OK, HR2D_ENOMEM or the status of the watch; to be ended by
   hr2di_event_beams_clear() in any case. */
hr2d_status hr2di_event_beams_init(hr2di_event_beams *b, const hr2d_scene *scene,
                                   const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_event_beams_clear(hr2di_event_beams *b);

/* Looks from the start of a side into the angle from there to the next wall, unless what is
   seen goes on there from one to the other without a change.  The sides that triangles know are
   at once all such angles.  HR2D_OK, HR2D_ENOMEM, the status of the watch or of `take`; so for
   the others. */
hr2d_status hr2di_event_beams_from_vertex(hr2di_event_beams *b, hr2di_wall_side side);

/* Looks from a point of a part in all directions in front of its wall, past all vertices but
   `via`. */
hr2d_status hr2di_event_beams_from_part(hr2di_event_beams *b, hr2d_point at,
                                        const hr2di_side_part *part, uint32_t via);

/* Looks along a wall past its end: the last one if `last`, else the first one. */
hr2d_status hr2di_event_beams_along_wall(hr2di_event_beams *b, uint32_t wall, int last);

/* The half-edge that leaves the end of a side, with the last triangle before the next wall in
   front of the side on its left. */
int32_t hr2di_event_beams_turn(const hr2di_event_beams *b, hr2di_wall_side side);

#endif
