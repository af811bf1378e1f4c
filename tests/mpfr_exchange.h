/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas, orientations and kernels in arithmetic of as many digits as the
   input needs, by the textbook formulas and not by those of the library. */
#ifndef HR2D_TESTS_MPFR_EXCHANGE_H
#define HR2D_TESTS_MPFR_EXCHANGE_H

#include <hr2d/geometry.h>
#include <mpfr.h>

/* AF by crossed strings, after clipping each segment at the other's horizon.
   Sets the precision of `area`; the relative error is below 2^-90. */
void mpfr_exchange_area(mpfr_t area, const hr2d_segment *i, const hr2d_segment *j);

/* orient(abc), exactly; sets the precision of `det`. */
void mpfr_orient(mpfr_t det, hr2d_point a, hr2d_point b, hr2d_point c);

/* G by its definition, from normals and the vector between the points; sets the
   precision of `kernel`.  The points must not coincide. */
void mpfr_kernel(mpfr_t kernel, const hr2d_segment *i, hr2d_point x, const hr2d_segment *j,
                 hr2d_point y);

/* |value − reference|/reference, for a reference other than 0. */
double mpfr_relative_error(double value, const mpfr_t reference);

#endif
