/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The L¹ error of a pair, ∫∫ |G(x_c,y_c) − G(x,y)| dx dy, by the textbook's order of
   integration: for each y the integral over x between the roots of G = G(x_c,y_c) in closed
   form and in as many digits as cancel, over y adaptively. */
#ifndef HR2D_TESTS_INDEPENDENT_MPFR_L1_H
#define HR2D_TESTS_INDEPENDENT_MPFR_L1_H

#include <hr2d/geometry.h>

/* To a relative tolerance of about `tolerance`, which must be above 1e-13.  NaN if
   G(x_c,y_c) is 0 or if the rule does not reach the tolerance.  GSL's error handler must be
   off. */
double mpfr_l1(const hr2d_segment *i, const hr2d_segment *j, double tolerance);

#endif
