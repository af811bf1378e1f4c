/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves scenes with patches of given flux in several bands. */
#ifndef HR2D_SRC_ACCURACY_HEAT_SOLVE_H
#define HR2D_SRC_ACCURACY_HEAT_SOLVE_H

#include <hr2d/accuracy.h>

/* hr2d_solve_to() of an unsettled scene, see frozen-temperatures.h.  The solution owns one of
 * frozen temperatures. */
hr2d_status hr2di_heat_solve(const hr2d_scene *scene, const hr2d_target *target,
                             hr2d_solution **solution, hr2d_account *account);

#endif
