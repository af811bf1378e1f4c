/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernel G of equation (1), without ever forming r³.

   Let h_y be the distance of y from the line of i, and h_x the distance of x from the line
   of j.  Then cosθx = h_y/r and cosθy = h_x/r.  The distances are computed from the end points
   of the segments, so it does no harm if a point is rounded off its own segment.

   Errors in units of 2^-53: a determinant has 2, a length 3, hence a cosine 2 + 3 + 3 and 2
   divisions, and G 10 + 10 + 3 and 2 operations. */
#include <hr2d/geometry.h>
#include <math.h>

#include "geometry/determinant.h"
#include "geometry/predicates.h"

/* cosθ = orient(abp)/(|ab| r); 0 if p is not in front of the segment. */
static hr2di_scaled cosine(const hr2d_segment *s, hr2d_point p, hr2di_scaled r) {
  const hr2di_vector ab = hr2di_vector_difference_scaled(s->b, s->a);
  const hr2di_scaled det = hr2di_orient_scaled(s->a, s->b, p);
  if (det.m <= 0) return (hr2di_scaled){0, 0};
  return hr2di_scaled_div(
      hr2di_scaled_div(hr2di_scaled_of(det.m, det.e), hr2di_vector_length_scaled(&ab)), r);
}

double hr2d_kernel(const hr2d_segment *i, hr2d_point x, const hr2d_segment *j, hr2d_point y) {
  if (!i || !j) return NAN;
  if (!hr2di_point_finite(i->a) || !hr2di_point_finite(i->b) || !hr2di_point_finite(j->a) ||
      !hr2di_point_finite(j->b) || !hr2di_point_finite(x) || !hr2di_point_finite(y))
    return NAN;
  const hr2di_vector xy = hr2di_vector_difference_scaled(y, x);
  const hr2di_scaled r = hr2di_vector_length_scaled(&xy);
  if (r.m == 0) return hr2di_facing_of(i, j) == HR2DI_FACING_NONE ? 0 : INFINITY;
  const hr2di_scaled cosines = hr2di_scaled_mul(cosine(i, y, r), cosine(j, x, r));
  const hr2di_scaled twice_r = {r.m, r.e + 1};
  return hr2di_scaled_value(hr2di_scaled_div(cosines, twice_r));
}
