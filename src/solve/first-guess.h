/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where iterations begin. */
#ifndef HR2D_SRC_SOLVE_FIRST_GUESS_H
#define HR2D_SRC_SOLVE_FIRST_GUESS_H

#include "solve/equation.h"

/* Sets y from options.start, or in gas of a given temperature from a level of B; else it stays
   0. HR2D_OK or the status of the watch. */
hr2d_status hr2di_first_guess(hr2di_equation *equation);

#endif
