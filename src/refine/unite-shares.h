/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What shares do after each has refined its rows. */
#ifndef HR2D_SRC_REFINE_UNITE_SHARES_H
#define HR2D_SRC_REFINE_UNITE_SHARES_H

#include <hr2d/refine.h>

#include "links/linkset-impl.h"

/* Divides the elements as all shares together have, and renames those of the links that this
   share has made.  The first `elements` were there before, on all shares.  `status` is that of
   the refinement.  Returns HR2D_OK or the status of a share; then the hierarchy has its former
   size. */
hr2d_status hr2di_unite_shares(hr2d_hierarchy *hierarchy, hr2d_share *share, size_t elements,
                               hr2di_store *made, hr2di_watch *watch, hr2d_status status);

/* Adds up counts over shares, but those of elements. */
hr2d_status hr2di_unite_counts(hr2d_refine_counts *counts, hr2d_share *share,
                               hr2d_status status);

#endif
