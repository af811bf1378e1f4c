/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a singularity is from a segment, and how well polynomials approximate beside it. */
#ifndef HR2D_SRC_GEOMETRY_BERNSTEIN_ELLIPSE_H
#define HR2D_SRC_GEOMETRY_BERNSTEIN_ELLIPSE_H

#include <hr2d/geometry.h>

/* How far v is from a segment ab, relative to its length: m = (|va| + |vb|)/|ab|.  This is the
   major half axis, in units of |ab|/2, of the ellipse with foci a and b through v; the sum of
   the half axes is ρ = m + √(m²−1).  A function with a singularity at v is approximated on ab
   by polynomials of degree n to within ρ^−n. */
double hr2di_ellipse(hr2d_segment s, hr2d_point v);

/* The least hr2di_ellipse(s, v) over the points v of the segment `of`. */
double hr2di_ellipse_min(hr2d_segment s, hr2d_segment of);

/* A pair is distant if hr2di_ellipse_min() is at least this, from either segment. */
#define HR2DI_ELLIPSE_DISTANT 1.8

/* The m at which ρ^−2p is `error`, p being `order`: a singularity need not be farther away for
   this error.  At most HR2DI_ELLIPSE_DISTANT. */
double hr2di_ellipse_for(double error, unsigned order);

#endif
