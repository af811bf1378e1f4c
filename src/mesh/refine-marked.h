/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A copy of trees with some leaves halved. */
#ifndef HR2D_SRC_MESH_REFINE_MARKED_H
#define HR2D_SRC_MESH_REFINE_MARKED_H

#include "hierarchy/hierarchy-impl.h"

/* A hierarchy with the same elements, each leaf k halved depth[k] times, and its halves with
   it. Returns HR2D_OK, HR2D_ENOMEM, HR2D_EMAX_ELEMENTS or the status of the watch. */
hr2d_status hr2di_refine_marked(const hr2d_hierarchy *from, const unsigned char *depth,
                                uint64_t max_elements, hr2di_watch *watch,
                                hr2d_hierarchy **divided);

#endif
