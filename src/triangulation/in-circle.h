/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a point is surely inside a circle.  It decides how good triangles are, not what is
   true: doubt counts as outside. */
#ifndef HR2D_SRC_TRIANGULATION_IN_CIRCLE_H
#define HR2D_SRC_TRIANGULATION_IN_CIRCLE_H

#include <hr2d/geometry.h>
#include <math.h>

/* hr2di_in_circle() for four points that are nearly on one line. */
int hr2di_in_circle_thin(hr2d_point a, hr2d_point b, hr2d_point c, hr2d_point d);

/* d is inside the circle through a, b, c, which are counterclockwise.  The rounding error of
   the determinant is below 11·2^-53 of the sum of its terms without signs (Shewchuk 1997); that
   of an underflow below 2^-800 for coordinates below 2^200. */
static inline int hr2di_in_circle(hr2d_point a, hr2d_point b, hr2d_point c, hr2d_point d) {
  const double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y;
  const double cx = c.x - d.x, cy = c.y - d.y;
  const double aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
  const double p = bx * cy, q = by * cx, r = cx * ay, s = cy * ax, t = ax * by, u = ay * bx;
  const double bc = p - q, ca = r - s, ab = t - u;
  const double det = aa * bc + bb * ca + cc * ab;
  const double all =
      aa * (fabs(p) + fabs(q)) + bb * (fabs(r) + fabs(s)) + cc * (fabs(t) + fabs(u));
  const double doubt = 0x1p-49 * all + 0x1p-600;
  if (det > doubt) return 1;
  if (det < -doubt || aa * fabs(bc) + bb * fabs(ca) + cc * fabs(ab) > 0x1p-20 * all) return 0;
  return hr2di_in_circle_thin(a, b, c, d);
}

#endif
