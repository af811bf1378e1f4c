/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What gas takes of the light of leaves. */
#ifndef HR2D_SRC_SOLVE_GAS_ROWS_H
#define HR2D_SRC_SOLVE_GAS_ROWS_H

#include "solve/transport.h"

/* Sets t->gas, and closure to make K1 + m = 1 on patches that see patches in every direction;
   elsewhere what meets no patch is absorbed in the end, too.  Without `closed` there is no
   closure.  Fields have one band.  *leaves: the number of leaves whose rows were integrated.
   Returns HR2D_OK, HR2D_ENOMEM, the status of the watch, or HR2D_EUNSUPPORTED with a message if
   a patch sees backs, whose emission is not that of gas, or the heat of gas in an open scene is
   given. */
hr2d_status hr2di_gas_rows_set(hr2di_transport *t, int closed, uint64_t *leaves,
                               hr2di_message *message);

#endif
