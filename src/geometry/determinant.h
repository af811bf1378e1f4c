/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Determinants of exact differences of points, to a few units in the last place.

   A difference of two doubles is exactly the sum of two doubles, and so is a product;
   a 2×2 determinant of differences is exactly the sum of at most sixteen doubles. */
#ifndef HR2D_SRC_GEOMETRY_DETERMINANT_H
#define HR2D_SRC_GEOMETRY_DETERMINANT_H

#include <float.h>
#include <hr2d/geometry.h>
#include <math.h>

#include "base/scaled-double.h"

#ifdef __FAST_MATH__
#error exact arithmetic needs IEEE 754 rounding: compile without -ffast-math or -Ofast
#endif

/* With 1, as on s390x, only float is computed in a longer type, which is double. */
#if defined FLT_EVAL_METHOD && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1
#error "exact differences and products need arithmetic that rounds to double"
#endif

/* The vector (x + tx, y + ty)·2^e, exactly; x and y are its rounding. */
typedef struct hr2di_vector {
  double x, y;
  double tx, ty;
  int e;
} hr2di_vector;

/* Coordinates that are 0 or between these bounds need no scaling: a difference is
   a multiple of 2^-152, a determinant a multiple of 2^-304 and below 2^204, and the
   product of two determinants neither under- nor overflows. */
#define HR2DI_PLAIN_MIN 0x1p-100
#define HR2DI_PLAIN_MAX 0x1p+100

static inline int hr2di_point_plain(hr2d_point a) {
  const double x = fabs(a.x), y = fabs(a.y);
  return (x <= HR2DI_PLAIN_MAX) & (y <= HR2DI_PLAIN_MAX) & ((x >= HR2DI_PLAIN_MIN) | (x == 0)) &
         ((y >= HR2DI_PLAIN_MIN) | (y == 0));
}

static inline int hr2di_point_finite(hr2d_point a) {
  return isfinite(a.x) && isfinite(a.y);
}

/* Whether all coordinates that are not 0 are within a factor of 2^800 of each other.  If so,
   scaled differences lose no bit, and the signs of their determinants are exact. */
int hr2di_points_near_in_scale(const hr2d_point *points, int count);

/* The rounding error of s = x − y (Knuth). */
static inline double hr2di_tail_of_difference(double x, double y, double s) {
  const double virtual_y = x - s, virtual_x = s + virtual_y;
  return (x - virtual_x) + (virtual_y - y);
}

#ifdef FP_FAST_FMA
static inline double hr2di_tail_of_product(double x, double y, double p) {
  return fma(x, y, -p);
}
#else
/* The upper 26 bits (Veltkamp); x below 2^996. */
static inline double hr2di_tail_upper(double x) {
  const double t = 0x1.0000002p+27 * x;
  return t - (t - x);
}

/* The rounding error of p = x·y (Dekker), exact where no part underflows; the
   same bits as from a fused multiply-add. */
static inline double hr2di_tail_of_product(double x, double y, double p) {
  const double xh = hr2di_tail_upper(x), xl = x - xh, yh = hr2di_tail_upper(y), yl = y - yh;
  return xl * yl - (((p - xh * yh) - xl * yh) - xh * yl);
}
#endif

/* to − from, unscaled. */
static inline hr2di_vector hr2di_vector_difference(hr2d_point to, hr2d_point from) {
  hr2di_vector v = {.x = to.x - from.x, .y = to.y - from.y};
  v.tx = hr2di_tail_of_difference(to.x, from.x, v.x);
  v.ty = hr2di_tail_of_difference(to.y, from.y, v.y);
  return v;
}

/* to − from for any finite points; its larger component is in [2^499, 2^500).  Exact unless
   last bits of the points are smaller than the difference by a factor above 2^1000. */
hr2di_vector hr2di_vector_difference_scaled(hr2d_point to, hr2d_point from);

/* u × v without the exponents of the vectors.  The sign is exact and the relative error below
   2·2^-53.  det(−u,v) = det(u,−v) = −det(u,v) bit for bit. */
double hr2di_det(const hr2di_vector *u, const hr2di_vector *v);

/* u × v, corrected by its rounding errors of first order.  The terms that are left out and the
   rounding of the corrections stay below 16·2^-106·size, size = |u.x v.y| + |u.y v.x|.  *sure
   is cleared if that is more than 2^-55 of the determinant.  Has no branches; if u or v changes
   its sign, the result does, too, bit for bit. */
static inline double hr2di_det_corrected(const hr2di_vector *u, const hr2di_vector *v,
                                         int *sure) {
  const double p = u->x * v->y, q = u->y * v->x, plain = p - q;
  const double rounding =
      hr2di_tail_of_difference(p, q, plain) +
      (hr2di_tail_of_product(u->x, v->y, p) - hr2di_tail_of_product(u->y, v->x, q));
  const double tails = (u->x * v->ty + u->tx * v->y) - (u->y * v->tx + u->ty * v->x);
  const double det = plain + (rounding + tails);
  *sure &= fabs(det) >= 0x1p-47 * (fabs(p) + fabs(q));
  return det;
}

/* hr2di_det() with the exponents. */
static inline hr2di_scaled hr2di_det_scaled(const hr2di_vector *u, const hr2di_vector *v) {
  return hr2di_scaled_of(hr2di_det(u, v), u->e + v->e);
}

/* u · v; the error is small beside |u||v|. */
static inline double hr2di_vector_dot(const hr2di_vector *u, const hr2di_vector *v) {
  return u->x * v->x + u->y * v->y;
}

static inline double hr2di_vector_length(const hr2di_vector *v) {
  return sqrt(v->x * v->x + v->y * v->y);
}

static inline hr2di_scaled hr2di_vector_dot_scaled(const hr2di_vector *u,
                                                   const hr2di_vector *v) {
  return hr2di_scaled_of(hr2di_vector_dot(u, v), u->e + v->e);
}

static inline hr2di_scaled hr2di_vector_length_scaled(const hr2di_vector *v) {
  return hr2di_scaled_of(hr2di_vector_length(v), v->e);
}

#endif
