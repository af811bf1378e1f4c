/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plane between the walls of a scene, in triangles.

   Commit forgives walls that cross, or lie on one another, within roundings of coordinates.  A
   triangulation is exact, so such walls are cut where they cross, and of those that share a
   stretch each has its own edge there. */
#ifndef HR2D_SRC_SCENE_PLANE_H
#define HR2D_SRC_SCENE_PLANE_H

#include "scene/wall-pieces.h"
#include "triangulation/triangulation.h"

typedef struct hr2di_plane {
  hr2di_wall_pieces pieces;
  hr2di_triangulation triangulation; /* of the pieces */
} hr2di_plane;

/* Of a scene with walls.  HR2D_OK, HR2D_ENOMEM, the status of the watch, or HR2D_ESCENE for
   more crossings than roundings make, of which those of two walls are one; to be ended by
   hr2di_plane_clear() in any case. */
hr2d_status hr2di_plane_init(hr2di_plane *plane, const hr2d_scene *scene, uint32_t wall[2],
                             hr2di_watch *watch);
void hr2di_plane_clear(hr2di_plane *plane);

#endif
