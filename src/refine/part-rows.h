/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of which a share keeps a part of the links.  All shares with a part refine the row; the
   one with its first piece counts the work for all. */
#ifndef HR2D_SRC_REFINE_PART_ROWS_H
#define HR2D_SRC_REFINE_PART_ROWS_H

#include "refine/projector.h"

/* Begins a row, and ends it when it has no pairs left. */
void hr2di_part_rows_begin(hr2di_projector *p, size_t row);
void hr2di_part_rows_end(hr2di_projector *p);

/* Drops accepted pairs of other shares, with their areas unless these are NULL; `area` may be
   p->kept_area afterwards.  Returns how many are left. */
size_t hr2di_part_rows_keep(hr2di_projector *p, const double **area, size_t count);

/* The tests of visibility that this projector counts. */
uint64_t hr2di_part_rows_tests(const hr2di_projector *p);

#endif
