/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much of all directions the leaves see the background in. */
#ifndef HR2D_SRC_SOLVE_BACKGROUND_H
#define HR2D_SRC_SOLVE_BACKGROUND_H

#include "solve/row-sums.h"
#include "solve/transport.h"

/* Sets t->sky from row sums, which know backs: what each leaf sees besides patches and their
   backs.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_background_set(hr2di_transport *t, const hr2di_row_sums *rows);

/* The same at an order above 1, from the rows of the operator; from points of each leaf it is
   looked for backs. */
hr2d_status hr2di_background_set_order_p(hr2di_transport *t);

#endif
