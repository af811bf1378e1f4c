/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors at points where the edge of a shadow cuts an element. */
#ifndef HR2D_SRC_ESTIMATE_SHADOW_RESIDUALS_H
#define HR2D_SRC_ESTIMATE_SHADOW_RESIDUALS_H

#include "estimate/estimator.h"

/* Adds to e->point, from e->error.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_shadow_residuals(hr2di_estimator *e);

#endif
