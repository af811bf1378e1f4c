/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Links of trees of which some leaves were divided. */
#ifndef HR2D_SRC_MESH_REUSE_LINKS_H
#define HR2D_SRC_MESH_REUSE_LINKS_H

#include <hr2d/refine.h>

#include "links/linkset-impl.h"
#include "refine/refine-how.h"

/* Fills an empty set, on a copy of the elements of `coarse` with some leaves divided, images as
   their patches; the oracle and the policy are those of
   `coarse`.  Links that `coarse` has come first, and their blocks are taken over: `coarse` has
   none from then on.  Pairs without such a leaf in either tree are not refined again.  Returns
   HR2D_OK or a status, with a message in `links`; on failure `coarse` may have lost its blocks.
 */
hr2d_status hr2di_reuse_links(hr2d_linkset *links, hr2d_linkset *coarse,
                              const hr2di_refine_how *how, const hr2d_refine_options *options);

#endif
