/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of Legendre moments of G V from their definition, by nested adaptive quadrature
   (GSL) over positions on i and, at each position, over the directions in which j is
   visible. */
#ifndef HR2D_TESTS_INDEPENDENT_BRUTE_BLOCK_H
#define HR2D_TESTS_INDEPENDENT_BRUTE_BLOCK_H

#include <hr2d/geometry.h>
#include <stddef.h>

typedef struct brute_view brute_view;

/* What i sees of j around the occluders. */
brute_view *brute_view_open(const hr2d_segment *i, const hr2d_segment *j,
                            const hr2d_segment *occluder, size_t count);
void brute_view_close(brute_view *view);

/* ∫∫ G V φ_l(x) φ_m(y) dy dx with φ_l(ξ) = √(2l+1) P_l(ξ), ξ from −1 at the start of a segment
   to 1 at its end. */
double brute_block(brute_view *view, unsigned l, unsigned m);

#endif
