/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a mesh to the triangulation that others read. */
#ifndef HR2D_SRC_TRIANGULATION_FREEZE_H
#define HR2D_SRC_TRIANGULATION_FREEZE_H

#include "triangulation/mesh.h"

/* Fills `t` but for its allocator, and takes the vertices from the mesh, whose pieces are all
   in it.  *conflict becomes the first two walls that share a stretch, if any do.  HR2D_OK,
   HR2D_ENOMEM, or the status of the watch; `t` is to be cleared in any case. */
hr2d_status hr2di_freeze(hr2di_mesh *m, hr2di_triangulation *t, hr2di_conflict *conflict);

#endif
