/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The side of a line on which a point lies: exact, but mostly without exact arithmetic. */
#ifndef HR2D_SRC_GEOMETRY_ORIENT_SIGN_H
#define HR2D_SRC_GEOMETRY_ORIENT_SIGN_H

#include <hr2d/geometry.h>
#include <math.h>

#include "geometry/vector.h"

static inline int hr2di_sign_of(double x) {
  return (x > 0) - (x < 0);
}

/* hr2di_orient_sign() for points that rounding leaves in doubt. */
int hr2di_orient_sign_exact(hr2d_point a, hr2d_point b, hr2d_point c);

/* Same value as hr2d_orientation().  The rounding error of det is below 3·2^-53·(|p| + |q|);
   the error of an underflow is below 2^-1000 for coordinates below 2^500. */
static inline int hr2di_orient_sign(hr2d_point a, hr2d_point b, hr2d_point c) {
  const double ux = b.x - a.x, uy = b.y - a.y, wx = c.x - a.x, wy = c.y - a.y;
  const double p = ux * wy, q = uy * wx;
  const double det = p - q, doubt = 0x1p-50 * (fabs(p) + fabs(q)) + 0x1p-900;
  if (det > doubt) return 1;
  if (det < -doubt) return -1;
  return hr2di_orient_sign_exact(a, b, c);
}

#endif
