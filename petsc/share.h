/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The refinement of a rank's share of the pairs. */
#ifndef HR2D_PETSC_SHARE_H
#define HR2D_PETSC_SHARE_H

#include "hr2dp-impl.h"

/* Makes an empty hierarchy and link set.  HR2D_OK or HR2D_ENOMEM; not collective. */
hr2d_status hr2dpi_share_init(hr2dp *p);
void hr2dpi_share_clear(hr2dp *p);

/* Collective: shares out rows, unless that is done, and makes the links of each rank.  The
   counts that do not depend on trees are set. */
PetscErrorCode hr2dpi_share_refine(hr2dp *p, const hr2d_refine_options *options);

/* Gives up to `room` links from number *next on that are this rank's own, and moves *next on.
   Returns how many; 0 at the end. */
size_t hr2dpi_share_read(const hr2dp *p, uint64_t *next, hr2d_link *link, size_t room);

#endif
