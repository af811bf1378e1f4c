/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hr2d_solve() with what no public option says. */
#ifndef HR2D_SRC_SOLVE_SOLVE_HOW_H
#define HR2D_SRC_SOLVE_SOLVE_HOW_H

#include "solve/equation.h"

hr2d_status hr2di_solve(hr2d_linkset *links, const hr2di_equation_how *how,
                        const hr2d_solve_options *options, hr2d_solution **solution);

/* Solves an equation that has its light, and is kept; from a former solution of it, or NULL. It
   asks the callback of its watch. */
hr2d_status hr2di_solve_again(hr2di_equation *eq, const hr2d_solution *start,
                              hr2d_solution **solution);

#endif
