/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a singularity is from a segment, and how well polynomials approximate beside it. */
#ifndef HR2D_SRC_GEOMETRY_BERNSTEIN_ELLIPSE_H
#define HR2D_SRC_GEOMETRY_BERNSTEIN_ELLIPSE_H

#include <hr2d/geometry.h>

/* How far v is from a segment in terms of its length: (|va| + |vb|)/|ab|, the sum of the half
   axes of the ellipse with foci a and b through v.  A function with a singularity at v is
   approximated on ab by polynomials of degree n to within ρ^−n, ρ = m + √(m²−1). */
double hr2di_ellipse(hr2d_segment s, hr2d_point v);

/* The least of it over the points of a segment. */
double hr2di_ellipse_least(hr2d_segment s, hr2d_segment of);

/* Pairs at least so far apart, both ways, are distant. */
#define HR2DI_ELLIPSE_DISTANT 1.8

/* The ellipse at which ρ^−2p is an error, at most HR2DI_ELLIPSE_DISTANT: as far as need be. */
double hr2di_ellipse_for(double error, unsigned order);

#endif
