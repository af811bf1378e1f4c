/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows that are too long for one rank: the row of a wall around everything, for instance. */
#ifndef HR2D_PETSC_LONG_ROWS_H
#define HR2D_PETSC_LONG_ROWS_H

#include "hr2dp-impl.h"

/* The pieces of a row; 1 if it is not long. */
static inline uint32_t hr2dpi_long_rows_pieces(const hr2dp *p, size_t row) {
  return p->units.piece[row + 1] - p->units.piece[row];
}

/* Cuts the rows that are a large part of what a rank should have; `part` has two kinds of work,
   as parts of all, of each row.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2dpi_long_rows_cut(hr2dp *p, const double *part);

/* An hr2d_claim_fn with an hr2dp: the pairs of a row whose piece is of this rank. */
hr2d_status hr2dpi_long_rows_claim(void *ctx, const hr2d_batch *batch, unsigned char *claimed);

/* Each rank with a piece of a row looks round from its patch.  Counts the work of pairs of
   whole patches in long rows twice: p->long_rows[0] is what this rank does, and [1], on rank 0,
   what one process does.  HR2D_OK or as hr2d_refine_count(); not collective. */
hr2d_status hr2dpi_long_rows_count(hr2dp *p, const hr2d_refine_options *refine);

#endif
