/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What points miss beside ends so near to a patch that no element resolves their effect. */
#ifndef HR2D_SRC_ESTIMATE_GAP_RESIDUALS_H
#define HR2D_SRC_ESTIMATE_GAP_RESIDUALS_H

#include "estimate/estimator.h"

/* Sets e->narrow, and raises e->stray, for gaps narrower than elements may be; does nothing in
   a scene without any.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_gap_residuals(hr2di_estimator *e);

#endif
