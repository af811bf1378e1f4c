/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact determinants, used where corrected ones lose digits, by Shewchuk's expansions: sums of
   doubles that do not overlap. */
#include "geometry/determinant.h"

static double sum_tail(double x, double y, double s) {
  return hr2di_tail_of_difference(x, -y, s);
}

/* Adds x to an expansion: n doubles that do not overlap, smallest first, none of
   them 0 (Shewchuk's grow-expansion with zero elimination). */
static int grow(double *expansion, int n, double x) {
  int kept = 0;
  for (int k = 0; k < n; k++) {
    const double s = x + expansion[k], tail = sum_tail(x, expansion[k], s);
    if (tail != 0) expansion[kept++] = tail;
    x = s;
  }
  if (x != 0) expansion[kept++] = x;
  return kept;
}

static double exact_det(const hr2di_vector *u, const hr2di_vector *v) {
  const double left[2][2] = {{u->x, u->tx}, {-u->y, -u->ty}};
  const double right[2][2] = {{v->y, v->ty}, {v->x, v->tx}};
  double expansion[16], sum = 0;
  int n = 0;
  for (int term = 0; term < 2; term++)
    for (int k = 0; k < 4; k++) {
      const double x = left[term][k & 1], y = right[term][k >> 1], p = x * y;
      if (p == 0) continue;
      n = grow(expansion, n, hr2di_tail_of_product(x, y, p));
      n = grow(expansion, n, p);
    }
  for (int k = 0; k < n; k++) sum += expansion[k];
  return sum;
}

double hr2di_det(const hr2di_vector *u, const hr2di_vector *v) {
  int sure = 1;
  const double det = hr2di_det_corrected(u, v, &sure);
  return sure ? det : exact_det(u, v);
}

/* If they are, a difference is a multiple of 2^-852 times the largest coordinate.  Scaled to
   2^499, each of its parts is a multiple of 2^-355, so products and their tails stay above
   2^-710. */
int hr2di_points_near_in_scale(const hr2d_point *points, int count) {
  double min = INFINITY, max = 0;
  for (int k = 0; k < 2 * count; k++) {
    const double x = fabs(k & 1 ? points[k / 2].y : points[k / 2].x);
    if (x > max) max = x;
    if (x > 0 && x < min) min = x;
  }
  return min >= max * 0x1p-800;
}

hr2di_vector hr2di_vector_difference_scaled(hr2d_point to, hr2d_point from) {
  hr2di_vector v = hr2di_vector_difference(to, from);
  if (!isfinite(v.x) || !isfinite(v.y)) {
    v = hr2di_vector_difference((hr2d_point){0.5 * to.x, 0.5 * to.y},
                                (hr2d_point){0.5 * from.x, 0.5 * from.y});
    v.e = 1;
  }
  const double size = fmax(fabs(v.x), fabs(v.y));
  if (size == 0) return v;
  int exponent = 0;
  (void)frexp(size, &exponent);
  const int shift = 500 - exponent;
  return (hr2di_vector){ldexp(v.x, shift), ldexp(v.y, shift), ldexp(v.tx, shift),
                        ldexp(v.ty, shift), v.e - shift};
}
