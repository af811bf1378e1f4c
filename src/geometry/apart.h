/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far two segments are apart that do not cross. */
#ifndef HR2D_SRC_GEOMETRY_APART_H
#define HR2D_SRC_GEOMETRY_APART_H

#include "geometry/vector.h"

static inline double hr2di_apart_from_point(hr2d_segment s, hr2d_point v) {
  const hr2d_point u = hr2di_point_minus(s.b, s.a), w = hr2di_point_minus(v, s.a);
  const double square = hr2di_point_dot(u, u);
  const double t = square > 0 ? fmin(fmax(hr2di_point_dot(u, w) / square, 0), 1) : 0;
  return hypot(w.x - t * u.x, w.y - t * u.y);
}

/* An end is nearest. */
static inline double hr2di_apart(hr2d_segment s, hr2d_segment t) {
  return fmin(fmin(hr2di_apart_from_point(s, t.a), hr2di_apart_from_point(s, t.b)),
              fmin(hr2di_apart_from_point(t, s.a), hr2di_apart_from_point(t, s.b)));
}

#endif
