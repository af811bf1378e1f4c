/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Traces the beams from the patch of a row of which several shares have slots. */
#ifndef HR2D_SRC_REFINE_TRACE_ROW_H
#define HR2D_SRC_REFINE_TRACE_ROW_H

#include "refine/projector.h"

/* Looks round from the patch of a row that is cut, if a pair wants it; the share with the first
   slot also does so for pairs of others, and counts it.  Returns HR2D_OK, or the status that
   stops the refinement. */
hr2d_status hr2di_trace_row(hr2di_projector *p, size_t row);

#endif
