/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Halves the longest elements, where there are too many visibility events to look at. */
#ifndef HR2D_SRC_ACCURACY_LONG_LEAVES_H
#define HR2D_SRC_ACCURACY_LONG_LEAVES_H

#include "hierarchy/hierarchy-impl.h"

/* Halves leaves of patches that reflect light, the longest ones, until what kinks inside leaves
   make of errors is an eighth, `times` times.  HR2D_OK; or, with a part of the divisions done,
   HR2D_ENOMEM, HR2D_EMAX_ELEMENTS or the status of the watch. */
hr2d_status hr2di_long_leaves_halve(hr2d_hierarchy *hierarchy, unsigned times,
                                    uint64_t max_elements, hr2di_watch *watch);

#endif
