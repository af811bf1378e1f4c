/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view where nothing stands between patches that see each other: all of their fronts, and
   the backs between them, which may hide each other. */
#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/orient-sign.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"
#include "visibility/point-view-impl.h"

static double extent(const hr2di_vector *v) {
  return fmax(fabs(v->x), fabs(v->y));
}

/* (q−p)×(x−p), which is linear in t, by its sign; where that is 0 and the patch touches the
   point, the sign towards the middle of the point's own patch. */
static int side_close(const hr2di_viewpoint *e, const hr2di_ray *p, const hr2di_ray *q) {
  const double at_a = hr2di_orient(p->at, q->at, e->a);
  const double at_b = hr2di_orient(p->at, q->at, e->b);
  const int side = hr2di_sign_of(at_a * (1 - e->t) + at_b * e->t);
  if (side ||
      (extent(&p->to) > 0 && extent(&q->to) > 0 && hr2di_vector_dot(&p->to, &q->to) > 0))
    return side;
  return hr2di_sign_of(e->t <= .5 ? at_b - at_a : at_a - at_b);
}

/* Which side of a patch the point sees: 1 the front, -1 the back, 0 neither. */
static int side_seen(const hr2di_viewpoint *e, const hr2di_ray *p, const hr2di_ray *q) {
  const double det = hr2di_det(&p->to, &q->to);
  if (fabs(det) > 0x1p-100 * extent(&p->to) * extent(&q->to)) return hr2di_sign_of(det);
  return side_close(e, p, q);
}

/* Whether the back is the front of a patch beside it in number, as those of patches with two
   sides are. */
static int has_twin(const hr2d_scene *scene, size_t k) {
  const hr2d_segment s = scene->patch[k].scaled;
  for (size_t m = k > 0 ? k - 1 : 0; m <= k + 1 && m < scene->patches; m++) {
    const hr2d_segment t = scene->patch[m].scaled;
    if (hr2di_point_same(s.a, t.b) && hr2di_point_same(s.b, t.a)) return 1;
  }
  return 0;
}

/* Adds a patch with rays to its ends; *backs is set if it shows its back. */
static hr2d_status add(hr2di_point_viewer *w, size_t k, const hr2di_ray *p, const hr2di_ray *q,
                       int *backs) {
  const int p_above = p->height > 0, q_above = q->height > 0;
  if (!p_above && !q_above) return HR2D_OK;
  const int side = side_seen(&w->viewpoint, p, q);
  if (side == 0 || (side < 0 && has_twin(w->scene, k))) return HR2D_OK;
  const int starts = side > 0 ? p_above : q_above, ends = side > 0 ? q_above : p_above;
  hr2di_visible_arc s = {.patch = (uint32_t)k, .starts = starts, .ends = ends};
  s.right = starts ? side > 0 ? *p : *q : hr2di_ray_horizon(1, HR2DI_VIEW_NO_VERTEX);
  s.left = ends ? side > 0 ? *q : *p : hr2di_ray_horizon(-1, HR2DI_VIEW_NO_VERTEX);
  if (hr2di_alloc_reserve(&w->alloc, &w->span, &w->span_room, w->spans + 1, sizeof *w->span))
    return HR2D_ENOMEM;
  w->span[w->spans][0] = s.right.sine;
  w->span[w->spans++][1] = s.left.sine;
  *backs |= side < 0;
  return side > 0 ? hr2di_view_add(w, &s) : HR2D_OK;
}

static int from_the_right(const void *left, const void *right) {
  const double *l = left, *r = right;
  if (l[0] != r[0]) return l[0] > r[0] ? -1 : 1;
  return (l[1] < r[1]) - (l[1] > r[1]);
}

/* What something covers, less what fronts do: as no front is hidden, that is all of them. */
static hr2d_status add_backs(hr2di_point_viewer *w) {
  hr2di_sum sum = {0, 0};
  const hr2d_status status =
      hr2di_sort(w->span, w->spans, sizeof *w->span, from_the_right, w->watch);
  double end = 1;
  for (size_t k = 0; k < w->spans; k++) {
    const double start = fmin(w->span[k][0], end);
    end = fmin(w->span[k][1], end);
    hr2di_sum_add(&sum, (start - end) / 2);
  }
  for (size_t k = 0; k < w->intervals; k++) hr2di_sum_add(&sum, -w->interval[k].sine);
  hr2di_sum_add(&w->back, fmax(hr2di_sum_total(&sum), 0));
  return status;
}

hr2d_status hr2di_view_all(hr2di_point_viewer *w) {
  const hr2d_scene *scene = w->scene;
  hr2di_ray p, q = {.vertex = HR2DI_VIEW_NO_VERTEX};
  hr2d_status status = HR2D_OK;
  int backs = 0;
  w->spans = 0;
  for (size_t k = 0; k < scene->patches && !status; k++) {
    const hr2d_segment s = scene->patch[k].scaled;
    if (k % 16 == 0) status = hr2di_watch_work(w->watch, 32);
    if (status) break;
    if (k > 0 && hr2di_point_same(s.a, scene->patch[k - 1].scaled.b)) {
      p = q;
    } else {
      p = hr2di_ray_to(&w->viewpoint, s.a);
      hr2di_ray_measure(&w->viewpoint, &p);
    }
    q = hr2di_ray_to(&w->viewpoint, s.b);
    hr2di_ray_measure(&w->viewpoint, &q);
    status = add(w, k, &p, &q, &backs);
  }
  return status || !backs ? status : add_backs(w);
}
