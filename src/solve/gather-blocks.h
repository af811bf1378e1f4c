/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Products with a block C of order × order coefficients, row by row.
   Fields have order × bands coefficients.  Each band has the bits that it would have alone. */
#ifndef HR2D_SRC_SOLVE_GATHER_BLOCKS_H
#define HR2D_SRC_SOLVE_GATHER_BLOCKS_H

#include <stddef.h>

/* to_l += Σ_m C_lm from_m */
void hr2di_gather_block(const double *block, size_t order, size_t bands, const double *from,
                        double *to);

/* to_m += Σ_l C_lm from_l */
void hr2di_gather_transposed(const double *block, size_t order, size_t bands,
                             const double *from, double *to);

/* down_i += C up_j and down_j += Cᵀ up_i, in one pass over the block. */
void hr2di_gather_both(const double *block, size_t order, size_t bands, const double *up_i,
                       const double *up_j, double *down_i, double *down_j);

#endif
