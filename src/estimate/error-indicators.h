/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which elements make the errors that are too large. */
#ifndef HR2D_SRC_ESTIMATE_ERROR_INDICATORS_H
#define HR2D_SRC_ESTIMATE_ERROR_INDICATORS_H

#include "estimate/estimator.h"

/* Sets depth, per element of the hierarchy: how often each leaf is to be halved, and its halves
   with it, so that the errors of averages which are above a third of `target` fall below half
   of it; 0 for elements with children.  The estimator has measured errors and the largest of
   them is `worst`; changes its other fields.  Returns HR2D_OK or the status of a solve. */
hr2d_status hr2di_error_indicators(hr2di_estimator *e, double target, double worst,
                                   unsigned char *depth);

#endif
