/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies: walls joined at their vertices, and chords that stand for a whole body.

   A line that has two points of a body on different sides meets the body.  If the body is
   in front of i and of j, a line from x on i to y on j meets it between x and y, because
   before x it is behind i and beyond y behind j.  So a chord between two of its points is
   as good as a wall there. */
#ifndef HR2D_SRC_OCCLUSION_WALL_BODIES_H
#define HR2D_SRC_OCCLUSION_WALL_BODIES_H

#include "occlusion/walls.h"

/* Chords between the points that lie farthest in four directions: (1,0), (0,1), (1,1) and
   (1,-1). */
enum { HR2DI_CHORDS = 4 };

struct hr2di_body {
  hr2d_segment chord[HR2DI_CHORDS];
};

/* Fills walls->body and walls->body_of, which have room, from the vertices of the walls;
   HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_wall_bodies_init(hr2di_walls *walls, hr2di_watch *watch);

/* The chord of a body that lies most across a direction. */
hr2d_segment hr2di_body_chord_across(const hr2di_body *body, double dx, double dy);

#endif
