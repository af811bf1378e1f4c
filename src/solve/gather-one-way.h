/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What one element of a pair receives over the block of the link, in one band: half of
   hr2di_gather_both() each, with its bits. */
#ifndef HR2D_SRC_SOLVE_GATHER_ONE_WAY_H
#define HR2D_SRC_SOLVE_GATHER_ONE_WAY_H

#include <stddef.h>

/* to_l += Σ_m C_lm from_m, where rows of C are side by side. */
void hr2di_gather_rows(const double *c, size_t order, const double *from, double *to);

/* to_m += Σ_l C_lm from_l */
void hr2di_gather_columns(const double *c, size_t order, const double *from, double *to);

#endif
