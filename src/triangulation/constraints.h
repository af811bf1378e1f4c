/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Puts the walls into the triangulation of their ends. */
#ifndef HR2D_SRC_TRIANGULATION_CONSTRAINTS_H
#define HR2D_SRC_TRIANGULATION_CONSTRAINTS_H

#include "triangulation/mesh.h"

/* Makes every piece an edge of the mesh; walls through vertices become more pieces.  Returns
   HR2D_OK, HR2D_ENOMEM, the status of the watch, or HR2D_ESCENE with a conflict. */
hr2d_status hr2di_constraints_insert(hr2di_mesh *m, hr2di_conflict *conflict);

#endif
