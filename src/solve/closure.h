/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closure: makes the row sums of leaves exact, which coarse links spread wrongly. */
#ifndef HR2D_SRC_SOLVE_CLOSURE_H
#define HR2D_SRC_SOLVE_CLOSURE_H

#include <float.h>

#include "solve/row-sums.h"
#include "solve/transport.h"

/* Sets t->receive, t->send and t->closure from the links and the exact row sums.  Returns
   HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_closure_set(hr2di_transport *t, const hr2di_row_sums *rows);

/* At an order above 1, coefficients of d below this part of the row sum are 0, except on
   patches that see patches in every direction. */
#define HR2DI_CLOSURE_NOISE (2 * DBL_EPSILON)

/* The same at an order above 1; no row sums need be integrated. */
hr2d_status hr2di_closure_set_order_p(hr2di_transport *t);

#endif
