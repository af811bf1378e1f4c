/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What images of a period that are cut off may make of the power that comes in and that leaves.
 */
#ifndef HR2D_SRC_SOLVE_POWER_CUT_OFF_H
#define HR2D_SRC_SOLVE_POWER_CUT_OFF_H

#include "solve/equation.h"

/* Sets `off`, per band, in the unit of E and scene lengths, of a solved equation of a scene of
   which something is cut off.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_power_cut_off(hr2di_equation *s, double *off);

#endif
