/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What roundings may do to a solution. */
#ifndef HR2D_SRC_ESTIMATE_ROUNDING_BOUND_H
#define HR2D_SRC_ESTIMATE_ROUNDING_BOUND_H

#include "estimate/estimator.h"

/* Sets e->rounding of averages and e->stray at points from roundings of B, of H and of
   coordinates.  e->error is used up.  Returns HR2D_OK, HR2D_ENOMEM or the status of a solve. */
hr2d_status hr2di_rounding_bound(hr2di_estimator *e, int reflects);

#endif
