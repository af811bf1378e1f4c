/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of Legendre moments of G V over all visible lines, in long double: events are all
   lines through two ends, and between two of them a double exponential rule runs over
   directions. */
#ifndef HR2D_TESTS_INDEPENDENT_LINES_BLOCK_H
#define HR2D_TESTS_INDEPENDENT_LINES_BLOCK_H

#include <hr2d/geometry.h>
#include <stddef.h>

/* block_lm = ∫∫ G V φ_l(x) φ_m(y) dy dx, order × order numbers; `steps` of the rule to a unit,
   of which 16 are enough. */
void lines_block(const hr2d_segment *i, const hr2d_segment *j, const hr2d_segment *occluder,
                 size_t count, size_t order, unsigned steps, long double *block);

#endif
