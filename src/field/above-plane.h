/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a small plane sees: the half of a view that is above it. */
#ifndef HR2D_SRC_FIELD_ABOVE_PLANE_H
#define HR2D_SRC_FIELD_ABOVE_PLANE_H

#include "field/visibility-polygon.h"

/* Cuts off what of an arc, seen from x, is below the plane through x with a normal.  Returns
   whether anything is left.  Where the arc is cut n·ω is 0, so that roundings of the place have
   an effect of second order on integrals of n·ω. */
int hr2di_arc_above_plane(hr2di_polygon_arc *arc, const hr2d_scene *scene, hr2d_point x,
                          hr2d_point normal);

#endif
