/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches that touch and see each other there: max(A, B)/r does not fall in the corner, and the
   integral of 1/r² has no value. */
#ifndef HR2D_SRC_REFINE_LAW_TOUCH_H
#define HR2D_SRC_REFINE_LAW_TOUCH_H

#include "refine/law-view.h"

/* Sets touching[0] < touching[1] to the first two, or both to 0 if there are none.  HR2D_OK,
   HR2D_ENOMEM or the status of the watch.  Cost O(n²), and a view for each end that touches. */
hr2d_status hr2di_law_touching(const hr2di_law_view *view, size_t touching[2]);

#endif
