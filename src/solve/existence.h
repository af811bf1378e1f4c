/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether the radiosity equation of a scene has a solution at all. */
#ifndef HR2D_SRC_SOLVE_EXISTENCE_H
#define HR2D_SRC_SOLVE_EXISTENCE_H

#include "links/linkset-impl.h"

/* HR2D_OK, HR2D_ENOMEM, or HR2D_ENO_SOLUTION with a message: some patches exchange
   light with each other alone, absorb nothing of it, and emit. */
hr2d_status hr2di_existence_check(hr2d_linkset *links);

#endif
