/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry/bernstein-ellipse.h"

#include <math.h>

/* Not 0 unless the points are equal: otherwise ellipses of panels would be NaN, and the panels
   would be halved for ever. */
static double distance(hr2d_point p, hr2d_point q) {
  const double dx = p.x - q.x, dy = p.y - q.y, square = dx * dx + dy * dy;
  return square > 0x1p-900 ? sqrt(square) : hypot(dx, dy);
}

double hr2di_ellipse(hr2d_segment s, hr2d_point v) {
  return (distance(s.a, v) + distance(s.b, v)) / distance(s.a, s.b);
}

/* The sum of the distances from a and b is convex along a line.  It is least where the line
   meets the segment from a to the mirror image of b. */
double hr2di_ellipse_min(hr2d_segment s, hr2d_segment of) {
  const double dx = of.b.x - of.a.x, dy = of.b.y - of.a.y, square = dx * dx + dy * dy;
  const hr2d_point a = {s.a.x - of.a.x, s.a.y - of.a.y};
  const hr2d_point b = {s.b.x - of.a.x, s.b.y - of.a.y};
  const double along_a = (a.x * dx + a.y * dy) / square,
               along_b = (b.x * dx + b.y * dy) / square;
  const double off_a = fabs(a.y * dx - a.x * dy), off_b = fabs(b.y * dx - b.x * dy);
  const double off = off_a + off_b;
  double t = off > 0 ? (along_a * off_b + along_b * off_a) / off : 0.5;
  t = fmin(fmax(t, 0), 1);
  return hr2di_ellipse(s, (hr2d_point){of.a.x + t * dx, of.a.y + t * dy});
}

double hr2di_ellipse_for(double error, unsigned order) {
  const double rho = pow(error, -0.5 / order);
  return fmin(0.5 * (rho + 1 / rho), HR2DI_ELLIPSE_DISTANT);
}
