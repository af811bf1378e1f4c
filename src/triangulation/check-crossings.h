/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls that cross in a vertex. */
#ifndef HR2D_SRC_TRIANGULATION_CHECK_CROSSINGS_H
#define HR2D_SRC_TRIANGULATION_CHECK_CROSSINGS_H

#include "triangulation/mesh.h"

/* Looks for two walls that cross in a vertex on the inside of both.  Returns HR2D_OK,
   HR2D_ENOMEM, the status of the watch, or HR2D_ESCENE with the conflict. */
hr2d_status hr2di_passes_check(hr2di_mesh *m, hr2di_conflict *conflict);

#endif
