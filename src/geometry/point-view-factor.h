/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The form factor from a point to a segment. */
#ifndef HR2D_SRC_GEOMETRY_POINT_VIEW_FACTOR_H
#define HR2D_SRC_GEOMETRY_POINT_VIEW_FACTOR_H

#include <hr2d/geometry.h>
#include <math.h>

/* ½(sin θ_d − sin θ_c) for a point with this unit normal.  The ends of the segment lie at C and
   D from the point, D on the left of C.  M = C/|C| + D/|D| halves the angle δ between them, so
   this is sin(δ/2) cos θ_M = (C×D)/(|C||D||M|) · n·M/|M| with |M|² = 2(1 + C·D/(|C||D|)):
   nothing cancels.  A segment with an end at the point itself covers everything up to the
   horizon on that side, as it does from a point just before it. */
static inline double hr2di_point_view_factor(hr2d_point normal, hr2d_point c, hr2d_point d) {
  if (c.x == 0 && c.y == 0) c = (hr2d_point){normal.y, -normal.x};
  if (d.x == 0 && d.y == 0) d = (hr2d_point){-normal.y, normal.x};
  const double size_c = sqrt(c.x * c.x + c.y * c.y), size_d = sqrt(d.x * d.x + d.y * d.y);
  const double cos_c = (normal.x * c.x + normal.y * c.y) / size_c;
  const double cos_d = (normal.x * d.x + normal.y * d.y) / size_d;
  return (c.x * d.y - c.y * d.x) * (cos_c + cos_d) /
         (2 * (size_c * size_d + (c.x * d.x + c.y * d.y)));
}

#endif
