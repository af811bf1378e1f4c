/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "triangulation/in-circle.h"

#include "geometry/predicates.h"

/* Here the areas are differences of nearly equal products.  With exact rounding of the areas,
   by hr2di_orient(), the error is below 8·2^-53 of what is summed up. */
int hr2di_in_circle_thin(hr2d_point a, hr2d_point b, hr2d_point c, hr2d_point d) {
  const double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y;
  const double cx = c.x - d.x, cy = c.y - d.y;
  const double p = (ax * ax + ay * ay) * hr2di_orient(d, b, c),
               q = (bx * bx + by * by) * hr2di_orient(d, c, a),
               r = (cx * cx + cy * cy) * hr2di_orient(d, a, b);
  return p + q + r > 0x1p-49 * (fabs(p) + fabs(q) + fabs(r)) + 0x1p-600;
}
