/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Delaunay triangulation of the vertices, before any wall is in it. */
#ifndef HR2D_SRC_TRIANGULATION_DELAUNAY_H
#define HR2D_SRC_TRIANGULATION_DELAUNAY_H

#include "triangulation/mesh.h"

/* Makes the triangles.  No two vertices are the same point.  Returns HR2D_OK, HR2D_ENOMEM or
   the status of the watch.  Cost: expected O(n log n). */
hr2d_status hr2di_delaunay_init(hr2di_mesh *m);

#endif
