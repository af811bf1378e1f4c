/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "refine/law-touch.h"

#include <math.h>

#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* Coordinates are below 2.  Ends that are so near to a patch were drawn on it. */
#define NEAR 1e-12

/* From a point at this part of a patch from the corner, the other patch is seen to the corner,
   unless a wall stands between them. */
#define BESIDE 0x1p-20
#define SEEN   0x1p-10

/* The fraction of a segment that is nearest to a point, and whether it is there. */
static int touches(hr2d_segment s, hr2d_point p, double *at) {
  const hr2d_point along = hr2di_point_minus(s.b, s.a);
  const double t =
      hr2di_point_dot(hr2di_point_minus(p, s.a), along) / hr2di_point_dot(along, along);
  *at = fmin(fmax(t, 0), 1);
  const hr2d_point d = hr2di_point_minus(p, hr2di_point_at(s, *at));
  return fabs(d.x) < NEAR && fabs(d.y) < NEAR;
}

static int apart(double a, double b, double c, double d) {
  return fmax(a, b) + NEAR < fmin(c, d) || fmax(c, d) + NEAR < fmin(a, b);
}

/* Whether a point of patch p beside fraction t sees patch q around fraction u. */
static hr2d_status look(const hr2di_law_view *view, size_t p, double t, size_t q, double u,
                        int *sees) {
  hr2di_view_from seen;
  if (t < 0 || t > 1) return HR2D_OK;
  const hr2d_status status = hr2di_view_at(view->viewer, p, t, &seen);
  for (size_t k = 0; !status && k < seen.count; k++) {
    const hr2di_visible_interval *i = &seen.interval[k];
    *sees |= i->patch == q && i->from < u + SEEN && i->to > u - SEEN;
  }
  return status;
}

/* An end of one of the two at the other one. */
static hr2d_status meet(const hr2di_law_view *view, size_t p, size_t q, int *sees) {
  const hr2d_segment on_p = view->scene->patch[p].scaled, on_q = view->scene->patch[q].scaled;
  const hr2d_point end[] = {on_p.a, on_p.b, on_q.a, on_q.b};
  hr2d_status status = HR2D_OK;
  if (apart(on_p.a.x, on_p.b.x, on_q.a.x, on_q.b.x) ||
      apart(on_p.a.y, on_p.b.y, on_q.a.y, on_q.b.y))
    return HR2D_OK;
  for (size_t k = 0; k < 4 && !status && !*sees; k++) {
    double t, u;
    if (!touches(on_p, end[k], &t) || !touches(on_q, end[k], &u)) continue;
    status = look(view, p, t - BESIDE, q, u, sees);
    if (!status) status = look(view, p, t + BESIDE, q, u, sees);
  }
  return status;
}

hr2d_status hr2di_law_touching(const hr2di_law_view *view, size_t touching[2]) {
  const hr2d_scene *scene = view->scene;
  hr2d_status status = HR2D_OK;
  int sees = 0;
  touching[0] = touching[1] = 0;
  for (size_t p = 0; p < scene->patches && !status; p++) {
    if (!hr2di_scene_lit(scene, p)) continue;
    status = hr2di_watch_work(view->watch, 1 + scene->patches / 4);
    for (size_t q = p + 1; q < scene->patches && !status && !sees; q++) {
      if (hr2di_scene_lit(scene, q)) status = meet(view, p, q, &sees);
      if (sees) touching[0] = p, touching[1] = q;
    }
  }
  return status;
}
