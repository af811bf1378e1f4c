/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the extrapolation over a period that is cut off may leave of averages and at points. */
#ifndef HR2D_SRC_ESTIMATE_PERIOD_RESIDUALS_H
#define HR2D_SRC_ESTIMATE_PERIOD_RESIDUALS_H

#include "estimate/estimator.h"

/* Sets e->past and e->far.  Comes after the residual is set and before it is solved for: what a
   solve needs is as before.  HR2D_OK, or the status of a solve, a look or the watch. */
hr2d_status hr2di_period_residuals(hr2di_estimator *e);

#endif
