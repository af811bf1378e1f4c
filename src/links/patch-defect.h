/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The defect of a patch: A − Σ AF over its links, in units of the scene.  It is 0 where the
   patch sees patches in every direction, else its exchange area with the surroundings. */
#ifndef HR2D_SRC_LINKS_PATCH_DEFECT_H
#define HR2D_SRC_LINKS_PATCH_DEFECT_H

#include "base/neumaier-sum.h"
#include "links/linkset-impl.h"

/* A patch, or a component of patches, is closed if its defect is at most this fraction of its
   length.  Rounding alone stays below that: the sum is compensated, each exchange area is
   accurate to 4e-15 of itself, and the areas add up to the length. */
#define HR2DI_DEFECT_CLOSED 1e-14

/* The same fraction for the question whether light can escape at all.  It is coarser, because
   with an opening of 1e-14 the solution would be rounding errors times 1e14; solve.h states
   it. */
#define HR2DI_DEFECT_NO_ESCAPE 1e-13

/* Sets the defect of every patch.  Links of clusters do not count.  Returns HR2D_OK or the
   status of the watch. */
hr2d_status hr2di_defect_sum(const hr2d_linkset *links, hr2di_sum *defect, hr2di_watch *watch);

/* Sets closed[k] to 1 for each patch k that is closed by its defect, else to 0. */
void hr2di_defect_closed(const hr2d_linkset *links, const hr2di_sum *defect,
                         unsigned char *closed);

#endif
