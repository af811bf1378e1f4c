/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ends of walls as vertices along a Hilbert curve. */
#ifndef HR2D_SRC_TRIANGULATION_POINTS_H
#define HR2D_SRC_TRIANGULATION_POINTS_H

#include "triangulation/mesh.h"

/* Makes the vertices of a mesh of walls, with room for the box, and a piece for each wall. Ends
   within the reach of both their walls are one vertex.  Both ends of a piece are one vertex
   only if the wall is a point.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_points_init(hr2di_mesh *m);

#endif
