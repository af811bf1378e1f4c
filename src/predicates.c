/* SPDX-License-Identifier: GPL-3.0-or-later */
/* On which side, and whether at all: decisions from exact signs. */
#include "predicates.h"

#include "determinant.h"

static hr2di_wide orient(hr2d_point a, hr2d_point b, hr2d_point c) {
  hr2di_vector u, w;
  if (hr2di_plain(a) && hr2di_plain(b) && hr2di_plain(c)) {
    u = hr2di_difference(b, a);
    w = hr2di_difference(c, a);
  } else {
    u = hr2di_scaled_difference(b, a);
    w = hr2di_scaled_difference(c, a);
  }
  return (hr2di_wide){hr2di_det(&u, &w), u.e + w.e};
}

double hr2di_orient(hr2d_point a, hr2d_point b, hr2d_point c) {
  const hr2di_wide det = orient(a, b, c);
  return det.e == 0 ? det.m : ldexp(det.m, det.e);
}

int hr2d_orientation(hr2d_point a, hr2d_point b, hr2d_point c) {
  const double det = orient(a, b, c).m;
  return (det > 0) - (det < 0);
}

hr2di_facing hr2di_face(const hr2d_segment *i, const hr2d_segment *j) {
  const double c_of_i = orient(i->a, i->b, j->a).m, d_of_i = orient(i->a, i->b, j->b).m;
  if (c_of_i <= 0 && d_of_i <= 0) return HR2DI_FACING_NONE;
  const double a_of_j = orient(j->a, j->b, i->a).m, b_of_j = orient(j->a, j->b, i->b).m;
  if (a_of_j <= 0 && b_of_j <= 0) return HR2DI_FACING_NONE;
  const int full = c_of_i >= 0 && d_of_i >= 0 && a_of_j >= 0 && b_of_j >= 0;
  return full ? HR2DI_FACING_FULL : HR2DI_FACING_PART;
}
