/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sides, crossings and facing, decided by exact signs. */
#include "geometry/predicates.h"

#include "geometry/determinant.h"
#include "geometry/orient-exact.h"
#include "geometry/orient-sign.h"
#include "geometry/vector.h"

hr2di_scaled hr2di_orient_scaled(hr2d_point a, hr2d_point b, hr2d_point c) {
  hr2di_vector u, w;
  if (hr2di_point_plain(a) && hr2di_point_plain(b) && hr2di_point_plain(c)) {
    u = hr2di_vector_difference(b, a);
    w = hr2di_vector_difference(c, a);
  } else if (hr2di_points_near_in_scale((const hr2d_point[]){a, b, c}, 3)) {
    u = hr2di_vector_difference_scaled(b, a);
    w = hr2di_vector_difference_scaled(c, a);
  } else {
    return hr2di_orient_exact(a, b, c);
  }
  return (hr2di_scaled){hr2di_det(&u, &w), u.e + w.e};
}

double hr2di_orient(hr2d_point a, hr2d_point b, hr2d_point c) {
  const hr2di_scaled det = hr2di_orient_scaled(a, b, c);
  return det.e == 0 ? det.m : ldexp(det.m, det.e);
}

double hr2di_line_crossing(hr2d_point a, hr2d_point b, hr2d_point p, hr2d_point q) {
  const hr2di_scaled at_p = hr2di_orient_scaled(a, b, p), at_q = hr2di_orient_scaled(a, b, q);
  if (at_p.m == 0) return at_q.m == 0 ? NAN : 0;
  if (at_q.m == 0) return 1;
  const int e_p = at_p.e + ilogb(at_p.m), e_q = at_q.e + ilogb(at_q.m);
  const int e = e_p > e_q ? e_p : e_q;
  const double u = ldexp(at_p.m, at_p.e - e), v = ldexp(at_q.m, at_q.e - e);
  return u / (u - v);
}

hr2d_point hr2di_line_crossing_at(hr2d_segment s, hr2d_point p, hr2d_point q) {
  return hr2di_point_at(s, hr2di_line_crossing(p, q, s.a, s.b));
}

int hr2d_orientation(hr2d_point a, hr2d_point b, hr2d_point c) {
  const double det = hr2di_orient_scaled(a, b, c).m;
  return (det > 0) - (det < 0);
}

/* A rounded difference has the sign of the exact difference.  So if one of the two products of
   the determinant is 0, the signs of the factors of the other decide.  This is the case for
   lines along an axis and for c = a; c = b is tested by itself. */
int hr2di_orient_sign_exact(hr2d_point a, hr2d_point b, hr2d_point c) {
  const double ux = b.x - a.x, uy = b.y - a.y, wx = c.x - a.x, wy = c.y - a.y;
  if (ux == 0 || wy == 0) return -hr2di_sign_of(uy) * hr2di_sign_of(wx);
  if (uy == 0 || wx == 0) return hr2di_sign_of(ux) * hr2di_sign_of(wy);
  if (hr2di_point_same(c, b)) return 0;
  return hr2d_orientation(a, b, c);
}

hr2di_facing hr2di_facing_of(const hr2d_segment *i, const hr2d_segment *j) {
  const int c_of_i = hr2di_orient_sign(i->a, i->b, j->a),
            d_of_i = hr2di_orient_sign(i->a, i->b, j->b);
  if (c_of_i <= 0 && d_of_i <= 0) return HR2DI_FACING_NONE;
  const int a_of_j = hr2di_orient_sign(j->a, j->b, i->a),
            b_of_j = hr2di_orient_sign(j->a, j->b, i->b);
  if (a_of_j <= 0 && b_of_j <= 0) return HR2DI_FACING_NONE;
  const int full = c_of_i >= 0 && d_of_i >= 0 && a_of_j >= 0 && b_of_j >= 0;
  return full ? HR2DI_FACING_FULL : HR2DI_FACING_PART;
}
