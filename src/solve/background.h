/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The form factor from the leaves to the background: the part of all directions in which they
   see it. */
#ifndef HR2D_SRC_SOLVE_BACKGROUND_H
#define HR2D_SRC_SOLVE_BACKGROUND_H

#include "solve/row-sums.h"
#include "solve/transport.h"

/* Sets t->sky to 1 less the row sums over patches and over their backs.  Returns HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_background_set(hr2di_transport *t, const hr2di_row_sums *rows);

/* The same at an order above 1, from the rows of the operator with its closure, and from the
   backs that points of each leaf see.  *sees is NULL, or what a former call has set: the
   patches that may see a back, of the scene alone and from t->alloc, for the caller to keep. */
hr2d_status hr2di_background_set_order_p(hr2di_transport *t, unsigned char **sees);

#endif
