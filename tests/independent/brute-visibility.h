/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas around occluders, computed in three ways from the definition: each finds
   the part of j that a point of i sees, anew on every piece of i between two events. */
#ifndef HR2D_TESTS_INDEPENDENT_BRUTE_VISIBILITY_H
#define HR2D_TESTS_INDEPENDENT_BRUTE_VISIBILITY_H

#include <hr2d/geometry.h>
#include <stddef.h>

#include "support/pair-classes.h"

/* The outer integral by adaptive quadrature (GSL); the inner one is half a difference of
   sines.  `error` receives GSL's estimate; may be NULL. */
double brute_quadrature(const hr2d_segment *i, const hr2d_segment *j,
                        const hr2d_segment *occluder, size_t count, double *error);

/* The outer integral in closed form, ∫sinθ dx = |x₀v| − |x₁v|, in long doubles: good to
   about 1e-17 of the longest distance, and fast. */
double brute_strings(const hr2d_segment *i, const hr2d_segment *j, const hr2d_segment *occluder,
                     size_t count);

/* From `lines` random lines through i, each tested against each occluder: no event, no
   interval.  `sigma` receives the standard error. */
double brute_lines(const hr2d_segment *i, const hr2d_segment *j, const hr2d_segment *occluder,
                   size_t count, randoms *r, int lines, double *sigma);

#endif
