/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether the radiosity equation of a scene has a solution at all. */
#ifndef HR2D_SRC_SOLVE_EXISTENCE_H
#define HR2D_SRC_SOLVE_EXISTENCE_H

#include "links/linkset-impl.h"

/* For E and ρ of a scene as in equation.h.  Returns HR2D_OK, HR2D_ENOMEM, HR2D_ENO_SOLUTION or
   the status of the watch, and leaves a message on failure. HR2D_ENO_SOLUTION: some patches
   exchange light only with each other, absorb none of it, and emit. */
hr2d_status hr2di_existence_check(hr2d_linkset *links, const hr2d_scene *scene,
                                  hr2di_watch *watch);

#endif
