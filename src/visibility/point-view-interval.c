/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A visible interval: the part of a patch that a point sees between two rays, and its form
 * factor. */
#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "visibility/point-view-impl.h"

/* The part of a patch between two rays. */
static void find_part(const hr2di_point_viewer *w, const hr2di_visible_arc *s, double *from,
                      double *to) {
  const hr2d_segment at = w->scene->patch[s->patch].scaled;
  *from = 0;
  *to = 1;
  if (s->starts && s->ends) return;
  hr2di_ray a = hr2di_ray_to(&w->viewpoint, at.a);
  hr2di_ray b = hr2di_ray_to(&w->viewpoint, at.b);
  hr2di_ray_measure(&w->viewpoint, &a);
  hr2di_ray_measure(&w->viewpoint, &b);
  if (!s->starts) *from = hr2di_ray_fraction(&s->right, &a, &b);
  if (!s->ends) *to = hr2di_ray_fraction(&s->left, &a, &b);
  /* Close to a patch a wide angle may take less of it than fractions can tell. */
  if (*from < *to) return;
  *to = *from + DBL_EPSILON;
  if (*to > 1) {
    *to = 1;
    *from = 1 - DBL_EPSILON;
  }
}

static hr2d_status add_arc(hr2di_point_viewer *w, const hr2di_visible_arc *s) {
  if (!w->scene->sky.pieces && !hr2di_symmetry_cuts(&w->scene->symmetry)) return HR2D_OK;
  if (hr2di_alloc_reserve(&w->alloc, &w->arc, &w->arc_room, w->arcs + 1, sizeof *w->arc))
    return HR2D_ENOMEM;
  w->arc[w->arcs][0] = s->left.sine;
  w->arc[w->arcs++][1] = s->right.sine;
  return HR2D_OK;
}

hr2d_status hr2di_view_add(hr2di_point_viewer *w, const hr2di_visible_arc *s) {
  if (s->patch == HR2DI_SEEN_NOTHING) return HR2D_OK;
  if (s->patch == HR2DI_SEEN_SKY && !w->show) return add_arc(w, s);
  hr2di_visible_interval g = {.patch = s->patch,
                              .sine = fmin(hr2di_ray_half_sine(&s->right, &s->left), 1)};
  if (!(g.sine > 0)) return HR2D_OK;
  if (s->patch < HR2DI_SEEN_NOTHING && !w->sines_only) find_part(w, s, &g.from, &g.to);
  if (w->show) return w->show(w->ctx, s, &g);
  if (s->patch == HR2DI_SEEN_NOBODY) {
    hr2di_sum_add(&w->back, g.sine);
    return HR2D_OK;
  }
  if (hr2di_alloc_reserve(&w->alloc, &w->interval, &w->interval_room, w->intervals + 1,
                          sizeof *w->interval))
    return HR2D_ENOMEM;
  w->interval[w->intervals++] = g;
  return HR2D_OK;
}
