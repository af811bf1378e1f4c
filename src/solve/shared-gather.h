/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A gather over the links of all shares. */
#ifndef HR2D_SRC_SOLVE_SHARED_GATHER_H
#define HR2D_SRC_SOLVE_SHARED_GATHER_H

#include "solve/transport.h"

/* Makes room; HR2D_OK or HR2D_ENOMEM.  Call hr2di_shared_gather_clear() in any case. */
hr2d_status hr2di_shared_gather_init(hr2di_transport *t);
void hr2di_shared_gather_clear(hr2di_transport *t);

/* Sets t->down to the power that elements receive from t->up, over the links of all shares;
   with `sends`, over directed links the other way.  Sets t->failed if that fails on any of
   them. */
void hr2di_shared_gather(hr2di_transport *t, hr2di_transport_part part, int sends);

#endif
