/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of a block as they are stored: doubles C_lm, or floats C_lm/C_00, where C_00 is
   the exchange area of the link.  So C_00 has all its digits in both, and exchange areas may be
   less than any float.  Arithmetic is in doubles. */
#ifndef HR2D_SRC_LINKS_BLOCK_NUMBERS_H
#define HR2D_SRC_LINKS_BLOCK_NUMBERS_H

#include <float.h>
#include <stddef.h>

#include "base/wide.h"

/* What roundings of floats do to irradiance, relative to that from the largest radiosity: each
   is FLT_EPSILON/2 of its C_lm at most, Σ_lm √(2l+1) |C_lm| is a few C_00, and signs are
   random. Averages were a tenth of that apart (tests/unit/accuracy/check-single-blocks.c). */
#define HR2DI_SINGLE_ROUNDING (4 * FLT_EPSILON)

/* The bytes of a number. */
static inline size_t hr2di_number_size(int single) {
  return single ? sizeof(float) : sizeof(double);
}

/* C_lm of a link with this exchange area, from number k of its block.  `single` is a constant
   to the compiler where it matters. */
HR2DI_PART double hr2di_number_at(const void *block, size_t k, int single, double area) {
  return single ? area * (double)((const float *)block)[k] : ((const double *)block)[k];
}

#endif
