/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What two segments exchange past hulls. */
#ifndef HR2D_SRC_OCCLUSION_AREA_PAST_HULLS_H
#define HR2D_SRC_OCCLUSION_AREA_PAST_HULLS_H

#include "occlusion/occluder-hulls.h"

/* The exchange area of the parts of an opening; *all is whether nothing is in the way, so that
   it is that of i and j.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_past_clumps(const hr2di_opening *opening, const hr2di_occluder_hulls *hulls,
                              double *area, int *all);

#endif
