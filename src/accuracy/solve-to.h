/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solving a scene of known E and ρ to a target. */
#ifndef HR2D_SRC_ACCURACY_SOLVE_TO_H
#define HR2D_SRC_ACCURACY_SOLVE_TO_H

#include <hr2d/accuracy.h>

#include "estimate/graded-solve.h"

/* hr2d_solve_to() of a committed scene that is not unsettled.  The caller has set *solution to
   NULL and *account, which may be NULL, to 0. */
hr2d_status hr2di_solve_to(const hr2d_scene *scene, const hr2d_target *target,
                           hr2d_solution **solution, hr2d_account *account);

/* The same, with elements that end at all events, whatever light they are for, and with the
   blocks of the account.  `best` receives the trees, the links and the solution, `fineness`
   their resolution; they are unchanged where there is no solution. */
hr2d_status hr2di_solve_for_operator(const hr2d_scene *scene, const hr2d_target *target,
                                     hr2di_graded *best, hr2di_resolution *fineness,
                                     hr2d_account *account);

#endif
