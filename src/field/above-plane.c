/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "field/above-plane.h"

#include <math.h>

#include "geometry/vector.h"

/* The fraction of a patch at which a ray from x meets it, within the part that is seen. */
static double place_of(const hr2di_polygon_arc *arc, const hr2d_scene *scene, hr2d_point x,
                       hr2d_point ray) {
  if (arc->patch >= HR2DI_ROUND_SKY) return 0;
  const hr2d_segment at = scene->patch[arc->patch].scaled;
  const hr2d_point along = hr2di_point_minus(at.b, at.a);
  const double t =
      hr2di_point_cross(hr2di_point_minus(x, at.a), ray) / hr2di_point_cross(along, ray);
  return fmin(fmax(t, arc->from), arc->to); /* which take NaN for no number */
}

int hr2di_arc_above_plane(hr2di_polygon_arc *arc, const hr2d_scene *scene, hr2d_point x,
                          hr2d_point normal) {
  const double right = hr2di_point_dot(normal, arc->right),
               left = hr2di_point_dot(normal, arc->left);
  if (right >= 0 && left >= 0 && right + left > 0) return 1;
  if (right <= 0 && left <= 0) /* all of the half plane, or nothing of it */
    return hr2di_point_dot(arc->right, arc->left) < 0 &&
           hr2di_point_cross(arc->right, normal) > 0;
  const hr2d_point horizon = {normal.y, -normal.x};
  if (right < 0) {
    arc->right = horizon;
    arc->from = place_of(arc, scene, x, horizon);
  } else {
    arc->left = (hr2d_point){-horizon.x, -horizon.y};
    arc->to = place_of(arc, scene, x, horizon);
  }
  arc->angle =
      atan2(hr2di_point_cross(arc->right, arc->left), hr2di_point_dot(arc->right, arc->left));
  return arc->angle > 0;
}
