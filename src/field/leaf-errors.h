/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far B_h of a solution is from B on each of its leaves. */
#ifndef HR2D_SRC_FIELD_LEAF_ERRORS_H
#define HR2D_SRC_FIELD_LEAF_ERRORS_H

#include "field/leaves.h"

/* Sets *error, elements × bands: on leaves a bound of |B_h − B|, where the values that are
   gathered have a bound `sup`, relative to the largest value of the band; on other elements
   the largest of their leaves; 0 on images, whose patches have it.  `leaves` has all leaves.
   The caller frees *error.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_leaf_errors(const hr2di_leaves *leaves, const hr2d_solution *solution,
                              double sup, hr2di_watch *watch, double **error);

#endif
