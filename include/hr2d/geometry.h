/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file geometry.h
 * @brief Segments of the plane and what is exchanged between two of them.
 *
 * A segment a→b is oriented: its front is the left of the direction of travel.
 * For a facing pair i = a→b, j = c→d the points a, b, c, d run counter-clockwise.
 * All functions here are thread-safe and allocate nothing.
 *
 * Bounds of errors are relative and hold for all finite coordinates.  What is below DBL_MIN has
 * the error of DBL_MIN, and one step of the subnormal numbers; what is beyond DBL_MAX is
 * infinity.  The tests hold the bounds against MPFR on random inputs and on the worst that hill
 * climbing finds (tests/bounds/check-bounds-geometry.c).
 */
#ifndef HR2D_GEOMETRY_H
#define HR2D_GEOMETRY_H

#include <hr2d/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A point of the plane, in scene lengths. */
typedef struct hr2d_point {
  double x; /**< abscissa */
  double y; /**< ordinate */
} hr2d_point;

/** An oriented segment; its front is on its left. */
typedef struct hr2d_segment {
  hr2d_point a; /**< where it starts */
  hr2d_point b; /**< where it ends */
} hr2d_segment;

/**
 * On which side of the line a→b the point c lies.
 * @return 1 for left, -1 for right, 0 for exactly on the line
 * Exact for all finite coordinates.
 */
HR2D_API int hr2d_orientation(hr2d_point a, hr2d_point b, hr2d_point c);

/**
 * The unoccluded exchange area AF = ∫i∫j G dy dx = A_i F_ij = A_j F_ji of two
 * segments (paper, section 3.1), each clipped at the other's horizon.
 *
 * @param i,j  two segments, in any position, also touching or crossing
 * @return AF in scene lengths, 0 ≤ AF ≤ min(A_i, A_j) up to rounding; 0 where
 *         neither sees the other's front; NaN if a coordinate is not finite
 *
 * The relative error is at most 4e-15; the value is 0 only where AF is 0 or below the doubles,
 * and hr2d_exchange_area(i, j) == hr2d_exchange_area(j, i) bit for bit. Constant cost: four
 * square roots for a pair in general position.
 */
HR2D_API double hr2d_exchange_area(const hr2d_segment *i, const hr2d_segment *j);

/**
 * The kernel G(x,y) = cosθx cosθy / (2 r) of equation (1), without visibility,
 * per scene length.
 *
 * @param i,x  a segment and a point on it
 * @param j,y  another segment and a point on it
 * @return G ≥ 0; 0 where one point is not in front of the other segment;
 *         infinity where x and y coincide on facing segments; NaN if a coordinate is not
 *         finite
 *
 * The relative error is at most 3e-15 = 26·2^-53, of
 *     G = h_y h_x / (2 r³),  h_y = orient(i,y)/A_i,  h_x = orient(j,x)/A_j,
 * the distances of the points from the lines of the segments: cosθx = h_y/r and cosθy = h_x/r
 * where x and y lie on them, and rounding a point off its own segment does no harm.
 * hr2d_kernel(i, x, j, y) == hr2d_kernel(j, y, i, x) bit for bit.
 */
HR2D_API double hr2d_kernel(const hr2d_segment *i, hr2d_point x, const hr2d_segment *j,
                            hr2d_point y);

#ifdef __cplusplus
}
#endif
#endif
