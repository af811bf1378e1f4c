/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a point of the plane is: in which triangle, and whether it touches walls. */
#ifndef HR2D_SRC_FIELD_LOCATE_H
#define HR2D_SRC_FIELD_LOCATE_H

#include "scene/scene-impl.h"

/* Of a point beyond the box: the border of the box that lies before it. */
#define HR2DI_BEYOND (-1)

/* The triangle at x, found from triangle *near on, where the next search may begin; its border
   belongs to it.  Signs are exact.  HR2DI_BEYOND if there is none: then *border is a half-edge
   of the border with x behind it. */
int32_t hr2di_locate(const hr2di_triangulation *t, hr2d_point x, int32_t *near,
                     int32_t *border);

/* Points nearer than this to a wall touch it: more than scaled walls are moved by the
   triangulation. */
#define HR2DI_FIELD_TOUCH 0x1p-48

/* So far from the inside of a wall is the point from which a point that touches it looks. */
#define HR2DI_FIELD_BESIDE 0x1p-44

/* What a point that touches walls looks at: all that lies between two sides of walls that show
   most fronts, that have the widest angle, or else one of the patch of the lowest number.  It
   comes to the walls along the line that halves this angle. */
typedef struct hr2di_touch {
  hr2d_point x;     /* the vertex where the walls meet, or a point beside one wall */
  hr2d_point ahead; /* the direction of this line */
  int32_t first;    /* the half-edge along the wall on the right; HR2DI_SKY if x is beside it */
  double angle;     /* of all directions, that each of the two walls takes at a vertex */
  uint32_t beside[2]; /* their patches, on the right and on the left, or HR2DI_NOBODY */
} hr2di_touch;

/* Whether x, in triangle `at`, touches walls. */
int hr2di_offset_viewpoint(const hr2d_scene *scene, int32_t at, hr2d_point x,
                           hr2di_touch *touch);

/* The patch on a side of a wall at x, a point of it, or HR2DI_NOBODY. */
uint32_t hr2di_patch_beside(const hr2d_scene *scene, hr2di_wall_side side, hr2d_point x);

#endif
