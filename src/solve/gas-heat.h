/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gases whose heat is given: how hot what they get makes them. */
#ifndef HR2D_SRC_SOLVE_GAS_HEAT_H
#define HR2D_SRC_SOLVE_GAS_HEAT_H

#include "solve/transport.h"

/* Sets t->gas_exchange, t->gas_return and t->gas_kept of a closed scene, from t->gas and
   t->gas_of.  Returns HR2D_OK, HR2D_ENOMEM, the status of the watch, or HR2D_ENO_SOLUTION with
   a message if a gas of given heat exchanges no light. */
hr2d_status hr2di_gas_heat_set(hr2di_transport *t, hr2di_message *message);

#endif
