/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors of averages whose signs do not cancel. */
#ifndef HR2D_SRC_ESTIMATE_UNSIGNED_ERROR_H
#define HR2D_SRC_ESTIMATE_UNSIGNED_ERROR_H

#include "estimate/estimator.h"

/* Sets e->safe, per band: Σ A |⟨r, Z⟩| over leaves for the worst of the important averages of
   B, and of those of H, with its importance Z; and e->scatter, the root of the sum of the
   squares of these terms.  Changes e->error, e->max and
   e->rounding.  Returns HR2D_OK or the status of a solve. */
hr2d_status hr2di_unsigned_error(hr2di_estimator *e);

/* Sets the irradiance to Z of a source of importance: see unsigned-error.c.  Changes the source
   and e->error.  Returns HR2D_OK or the status of a solve. */
hr2d_status hr2di_unsigned_row(hr2di_estimator *e);

#endif
