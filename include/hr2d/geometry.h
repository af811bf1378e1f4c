/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file geometry.h
 * @brief Segments of the plane and the exchange between two of them.
 *
 * @defgroup geometry Geometry: exchange areas and predicates
 * Segments of the plane and the exchange between two of them, without occluders.
 *
 * A segment a→b is oriented. Its front is on the left of the direction of travel. If the
 * segments i = a→b and j = c→d face each other, the points a, b, c, d run counter-clockwise.
 *
 * All functions are thread-safe and allocate nothing.
 *
 * Error bounds are relative and hold for all finite coordinates. A value below DBL_MIN has an
 * error relative to DBL_MIN, plus one step of the subnormal numbers. A value above DBL_MAX is
 * returned as infinity. The tests check the bounds against MPFR, on random inputs and on the
 * worst inputs that hill climbing finds (tests/bounds/check-bounds-geometry.c).
 * @{
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

/** An oriented segment. Its front is on its left. */
typedef struct hr2d_segment {
  hr2d_point a; /**< start */
  hr2d_point b; /**< end */
} hr2d_segment;

/**
 * The side of the line a→b on which the point c lies. Exact for all finite coordinates.
 * @param a  a point of the line
 * @param b  another one
 * @param c  the point
 * @retval 1   c is on the left
 * @retval -1  c is on the right
 * @retval 0   c is exactly on the line
 */
HR2D_API int hr2d_orientation(hr2d_point a, hr2d_point b, hr2d_point c);

/**
 * The unoccluded exchange area AF = ∫i∫j G dy dx = A_i F_ij = A_j F_ji of two segments (paper,
 * section 3.1). Each segment is clipped at the horizon of the other.
 * @param i  a segment
 * @param j  a segment in any position; they may touch or cross
 * @return AF in scene lengths, with 0 ≤ AF ≤ min(A_i, A_j) up to rounding; 0 if neither segment
 *         sees the front of the other; NaN if a coordinate is not finite
 *
 * The relative error is at most 4e-15. The value is 0 only if AF is 0 or below the range of a
 * double. hr2d_exchange_area(i, j) == hr2d_exchange_area(j, i), bit for bit. Constant cost:
 * four square roots for a pair in general position.
 */
HR2D_API double hr2d_exchange_area(const hr2d_segment *i, const hr2d_segment *j);

/**
 * The kernel G(x,y) = cosθx cosθy / (2r) of equation (1), without visibility.
 * @param i  a segment
 * @param x  a point on it
 * @param j  another segment
 * @param y  a point on it
 * @return G ≥ 0, per scene length; 0 if one point is not in front of the other segment;
 *         infinity if x and y coincide and the segments face each other; NaN if a coordinate is
 *         not finite
 *
 * The relative error is at most 3e-15 = 26·2^-53 of
 *
 *     G = h_y h_x / (2r³),  h_y = orient(i,y)/A_i,  h_x = orient(j,x)/A_j.
 *
 * h_y and h_x are the distances of the points from the lines of the segments. If x and y lie on
 * these lines, cosθx = h_y/r and cosθy = h_x/r. A point that rounding moves off its own segment
 * does no harm. hr2d_kernel(i, x, j, y) == hr2d_kernel(j, y, i, x), bit for bit.
 */
HR2D_API double hr2d_kernel(const hr2d_segment *i, hr2d_point x, const hr2d_segment *j,
                            hr2d_point y);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
