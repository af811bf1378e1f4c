/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refinement with links on several threads, patch by patch. */
#ifndef HR2D_SRC_REFINE_ROWS_H
#define HR2D_SRC_REFINE_ROWS_H

#include "refine/projector.h"

/* The number of threads that hr2di_rows_project() would have: 1 if threads may not call the
   oracle or the policy, if there is a budget of bytes, or if there are few patches. */
size_t hr2di_rows_threads(const hr2di_projector *p);

/* Does what hr2di_projector_all() does, with the same links and elements in the same order. */
hr2d_status hr2di_rows_project(hr2di_projector *p);

#endif
