/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas, orientations and kernels in arithmetic of as many digits as the
   input needs, by the textbook formulas and not by those of the library. */
#ifndef HR2D_TESTS_INDEPENDENT_MPFR_EXCHANGE_H
#define HR2D_TESTS_INDEPENDENT_MPFR_EXCHANGE_H

#include <hr2d/geometry.h>
#include <mpfr.h>

/* AF by crossed strings, after clipping each segment at the other's horizon.
   Sets the precision of `area`; the relative error is below 2^-90. */
void mpfr_exchange_area(mpfr_t area, const hr2d_segment *i, const hr2d_segment *j);

/* orient(abc), exactly; sets the precision of `det`. */
void mpfr_orient(mpfr_t det, hr2d_point a, hr2d_point b, hr2d_point c);

/* |ab| to 2^-120 of itself; sets the precision of `d`. */
void mpfr_distance(mpfr_t d, hr2d_point a, hr2d_point b);

/* G by its definition, from normals and the vector between the points; sets the
   precision of `kernel`.  The points must not coincide. */
void mpfr_kernel(mpfr_t kernel, const hr2d_segment *i, hr2d_point x, const hr2d_segment *j,
                 hr2d_point y);

/* G = h_y h_x/(2r³) with h the distances from the lines of the segments: the same where x and y
   lie on them.  x and y must not coincide. */
void mpfr_kernel_of_lines(mpfr_t kernel, const hr2d_segment *i, hr2d_point x,
                          const hr2d_segment *j, hr2d_point y);

/* |value − reference|/reference, for a reference other than 0. */
double mpfr_relative_error(double value, const mpfr_t reference);

/* The error as the headers state bounds.  Below DBL_MIN it is relative to DBL_MIN, and one
   step of the subnormal numbers is free.  A reference beyond the range of doubles requires
   infinity.  Infinite for NaN, and for any other value where the reference is 0. */
double mpfr_double_error(double value, const mpfr_t reference);

#endif
