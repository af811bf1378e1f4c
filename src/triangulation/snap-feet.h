/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ends of walls that are a rounding in front of another wall. */
#ifndef HR2D_SRC_TRIANGULATION_SNAP_FEET_H
#define HR2D_SRC_TRIANGULATION_SNAP_FEET_H

#include "triangulation/mesh.h"

/* Leads walls through the vertices in front of them that they reach.  HR2D_OK, HR2D_ENOMEM or
   the status of the watch. */
hr2d_status hr2di_feet_snap(hr2di_mesh *m);

#endif
