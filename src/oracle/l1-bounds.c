/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bounds on the L¹ error from the derivatives of G at the centres. */
#include <math.h>

#include "oracle/l1.h"

/* The mean of |p s + q t| over the square |s|, |t| ≤ 1, p, q ≥ 0. */
static double mean_of_linear(double p, double q) {
  const double more = p > q ? p : q, less = p > q ? q : p;
  return more > 0 ? 0.5 * more + less * less / (6 * more) : 0;
}

/* D = G/Gc − 1 = (1+x)(1+y)/r³ − 1, where x and y are the relative changes of the distances
   from the other's line; 1/r³ = 1 − 3l + e, where l is the change of r along the line of the
   centres.  For a point moved by m, |e| ≤ ½(3m² + 9l²) + 10m³/(1−m)⁶, as the derivatives of
   r⁻³ along a line are 3(5c²−1)m²/r⁵ and (45c − 105c³)m³/r⁶ with c a cosine.  The rest of D
   beside the linear part x + y − 3l is bounded by the means of its terms.  Each mean over a
   grid of midpoints is at most the mean over the rectangle, as all terms are convex. */
hr2di_l1_range hr2di_l1_bounds(const hr2d_segment *i, const hr2d_segment *j) {
  const hr2di_l1_range unknown = {0, INFINITY};
  const double ux = i->b.x - i->a.x, uy = i->b.y - i->a.y;
  const double vx = j->b.x - j->a.x, vy = j->b.y - j->a.y;
  const double rx = 0.5 * ((i->a.x - j->b.x) + (i->b.x - j->a.x));
  const double ry = 0.5 * ((i->a.y - j->b.y) + (i->b.y - j->a.y));
  const double r2 = rx * rx + ry * ry, u2 = ux * ux + uy * uy, v2 = vx * vx + vy * vy;
  /* twice the areas of the triangles of one segment and the other's centre */
  const double hx = uy * rx - ux * ry, hy = vx * ry - vy * rx;
  if (!(hx > 0 && hy > 0 && hx * hx > 1e-6 * u2 * r2 && hy * hy > 1e-6 * v2 * r2))
    return unknown;
  const double inverse = 1 / r2, size2 = 0.25 * (u2 + v2) * inverse;
  if (!(size2 < 0.02 && u2 > 1e-60 && v2 > 1e-60 && r2 < 1e60)) return unknown;
  const double turn = 0.5 * (ux * vy - uy * vx), slope_x = turn / hy, slope_y = turn / hx;
  const double along_x = 0.5 * (ux * rx + uy * ry) * inverse;
  const double along_y = 0.5 * (vx * rx + vy * ry) * inverse;
  const double p = fabs(slope_x), q = fabs(slope_y), k = fabs(along_x), l = fabs(along_y);
  const double linear =
      mean_of_linear(fabs(slope_x + 3 * along_x), fabs(slope_y + 3 * along_y));
  if (!(p < 0.5 && q < 0.5)) return unknown;
  const double m = sqrt(2 * size2), near = 1 - m, near2 = near * near;
  const double e =
      0.5 * size2 + 1.5 * (k * k + l * l) + 10. / 3 * m * size2 / (near2 * near2 * near2);
  const double rest = 0.25 * p * q + k * p + l * q + 0.75 * (k * q + l * p) +
                      0.75 * (k + l) * p * q + e * (1 + p) * (1 + q);
  const double all = hx * hy * inverse * 0.5 / sqrt(r2);
  const double slack = 1e-11 * (p + q + m) + rest, low = linear * (1 - 1e-10) - slack;
  return (hr2di_l1_range){low > 0 ? all * low : 0, all * (linear * (1 + 1e-10) + slack)};
}
