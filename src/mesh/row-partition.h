/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Deals out rows of links to shares. */
#ifndef HR2D_SRC_MESH_ROW_PARTITION_H
#define HR2D_SRC_MESH_ROW_PARTITION_H

#include <hr2d/refine.h>

#include "links/linkset-impl.h"
#include "links/row-pieces.h"
#include "visibility/beam-cache.h"

/* Counts the links that a refinement of an empty set makes, each share those of some rows, and
   deals rows out so that each has about the same.  Returns HR2D_OK, HR2D_ENOMEM or the status
   of the count, the same on all shares; `pieces` are to be cleared in any case.  What patches
   see is kept in `beam_cache`, unless that is NULL. */
hr2d_status hr2di_row_partition(hr2di_row_pieces *pieces, hr2d_linkset *links,
                                hr2di_beam_cache *beam_cache,
                                const hr2d_refine_options *options);

hr2d_status hr2di_row_pieces_copy(hr2di_row_pieces *to, const hr2di_row_pieces *from,
                                  size_t rows, const hr2d_allocator *alloc);
void hr2di_row_pieces_clear(hr2di_row_pieces *pieces, const hr2d_allocator *alloc);

#endif
