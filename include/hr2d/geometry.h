/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file geometry.h
 * @brief Segments of the plane and what is exchanged between two of them.
 *
 * A segment a→b is oriented: its front is the left of the direction of travel.
 * For a facing pair i = a→b, j = c→d the points a, b, c, d run counter-clockwise.
 * All functions here are thread-safe and allocate nothing.
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
 * Exact for all finite coordinates that differ by less than 2^900 in scale.
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
 * The relative error is at most 4e-15 (measured against MPFR over the classes
 * named in tests/check_exchange_area.c) wherever AF is a normal double, and
 * hr2d_exchange_area(i, j) == hr2d_exchange_area(j, i) bit for bit.
 * Constant cost: four square roots for a pair in general position.
 */
HR2D_API double hr2d_exchange_area(const hr2d_segment *i, const hr2d_segment *j);

/**
 * The kernel G(x,y) = cosθx cosθy / (2 r) of equation (1), without visibility,
 * per scene length.
 *
 * @param i,x  a segment and a point on it
 * @param j,y  another segment and a point on it
 * @return G ≥ 0; 0 where one point is not in front of the other segment;
 *         infinity where x and y coincide on facing segments
 */
HR2D_API double hr2d_kernel(const hr2d_segment *i, hr2d_point x, const hr2d_segment *j,
                            hr2d_point y);

#ifdef __cplusplus
}
#endif
#endif
