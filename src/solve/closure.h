/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closure: makes the row sums of leaves exact, which coarse links spread wrongly. */
#ifndef HR2D_SRC_SOLVE_CLOSURE_H
#define HR2D_SRC_SOLVE_CLOSURE_H

#include <float.h>

#include "solve/row-sums.h"
#include "solve/transport.h"

/* Sets t->receive, t->send and t->closure from the links and the exact row sums.  absorbed: per
   element, the form factors that its links lose to gas, or NULL.  Returns HR2D_OK, HR2D_ENOMEM
   or the status of the watch. */
hr2d_status hr2di_closure_set(hr2di_transport *t, const hr2di_row_sums *rows,
                              const double *absorbed);

/* At an order above 1, coefficients of d below this part of the row sum are 0, except on
   patches that see patches in every direction. */
static inline double hr2di_closure_noise(const hr2di_transport *t) {
  return t->blocks.single ? HR2DI_SINGLE_ROUNDING : 2 * DBL_EPSILON;
}

/* The same at an order above 1; no row sums need be integrated. */
hr2d_status hr2di_closure_set_order_p(hr2di_transport *t);

/* Sets t->mean to the mean of d over each element, from t->closure.  Returns HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_closure_set_mean(hr2di_transport *t);

/* Whether the mean over a patch is a rounding, or what clusters lack, and no part of K. */
int hr2di_closure_is_error(const hr2di_transport *t, size_t patch);

/* Changes H of B where the mean of d is such an error: H takes the place of B there.  The
   fields are not those of an equation any more, but H may be much less than B. */
void hr2di_closure_move_mean(const hr2di_transport *t, const double *radiosity,
                             double *irradiance);

#endif
