/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What leaves see past the ends of a period, from points of a rule on each. */
#ifndef HR2D_SRC_SOLVE_ROW_TAILS_H
#define HR2D_SRC_SOLVE_ROW_TAILS_H

#include "hierarchy/hierarchy-impl.h"

/* Row sums have the ends as fronts: takes the sky and the backs out of the sums of the leaves
   of a patch, and adds the backs to theirs, which may be NULL, as may `front`.  The scene has a
   plane.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_row_tails_move(const hr2d_hierarchy *h, const hr2d_scene *scene, size_t patch,
                                 double *front, double *back, hr2di_watch *watch);

/* Sets, per element, what a check of its series leaves of the form factor of the sky past the
   ends, from each leaf. */
hr2d_status hr2di_row_tails_check(const hr2d_hierarchy *h, int check, double *off,
                                  hr2di_watch *watch);

/* Sets, per element, the form factor of what is past the ends from each leaf, which is exact,
   and what the series of the sky makes of it. */
hr2d_status hr2di_row_tails_seen(const hr2d_hierarchy *h, double *ends, double *sky,
                                 hr2di_watch *watch);

#endif
