/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hr2d_solve() with what no public option says. */
#ifndef HR2D_SRC_SOLVE_SOLVE_HOW_H
#define HR2D_SRC_SOLVE_SOLVE_HOW_H

#include "solve/equation.h"

hr2d_status hr2di_solve(hr2d_linkset *links, const hr2di_equation_how *how,
                        const hr2d_solve_options *options, hr2d_solution **solution);

#endif
