/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the convex hull of the walls a border of triangles. */
#ifndef HR2D_SRC_TRIANGULATION_HULL_H
#define HR2D_SRC_TRIANGULATION_HULL_H

#include "triangulation/mesh.h"

/* Flips edges to corners of the box until all triangles without such a corner make up the hull.
   *closed is whether they do: whether the border is one.  HR2D_OK, HR2D_ENOMEM or the status of
   the watch. */
hr2d_status hr2di_hull_fill(hr2di_mesh *m, int *closed);

#endif
