/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The beams from a point: its view as the walk finds it, in scene coordinates. */
#include <hr2d/visibility.h>

#include "scene/with-plane.h"
#include "visibility/point-view-impl.h"

typedef struct visit {
  const hr2di_point_viewer *viewer;
  double unit;
  hr2d_beam_fn show;
  void *ctx;
} visit;

/* In the frame of the patch, whose front is on the left of its axis. */
static hr2d_point direction(const hr2di_viewpoint *e, const hr2di_ray *ray) {
  const double x = e->axis.x / e->length, y = e->axis.y / e->length;
  return (hr2d_point){ray->sine * x - ray->cosine * y, ray->sine * y + ray->cosine * x};
}

static hr2d_point along(hr2d_segment s, double t, double unit) {
  const hr2d_point base = t <= .5 ? s.a : s.b;
  const double from_base = t <= .5 ? t : t - 1;
  return (hr2d_point){unit * (base.x + from_base * (s.b.x - s.a.x)),
                      unit * (base.y + from_base * (s.b.y - s.a.y))};
}

/* The part of a back between the rays of a stretch; the side starts on the right. */
static hr2d_segment find_back(const visit *v, const hr2di_visible_arc *s) {
  const hr2di_point_viewer *w = v->viewer;
  const hr2di_viewpoint *e = &w->viewpoint;
  if (s->side == HR2DI_HIDDEN) {
    const hr2d_point at = along(w->scene->patch[e->patch].scaled, e->t, v->unit);
    return (hr2d_segment){at, at};
  }
  const hr2di_triangulation *in = &w->scene->plane.triangulation;
  const hr2di_wall_edge *edge = &in->edge[s->side >> 1];
  const uint32_t start = s->side & 1 ? edge->to : edge->from,
                 end = s->side & 1 ? edge->from : edge->to;
  const hr2d_segment at = {in->at[start], in->at[end]};
  hr2di_ray a = hr2di_ray_to(e, at.a), b = hr2di_ray_to(e, at.b);
  hr2di_ray_measure(e, &a);
  hr2di_ray_measure(e, &b);
  const double from = s->right.vertex == start ? 0 : hr2di_ray_fraction(&s->right, &a, &b);
  const double to = s->left.vertex == end ? 1 : hr2di_ray_fraction(&s->left, &a, &b);
  return (hr2d_segment){along(at, from, v->unit), along(at, to, v->unit)};
}

static hr2d_status show_stretch(void *ctx, const hr2di_visible_arc *s,
                                const hr2di_visible_interval *g) {
  const visit *v = ctx;
  const hr2di_viewpoint *e = &v->viewer->viewpoint;
  hr2d_beam beam = {.struct_size = sizeof beam,
                    .seen = HR2D_SEEN_SKY,
                    .factor = g->sine,
                    .right = direction(e, &s->right),
                    .left = direction(e, &s->left)};
  if (s->patch == HR2DI_SEEN_NOBODY) {
    beam.seen = HR2D_SEEN_BACK;
    beam.end = find_back(v, s);
  } else if (s->patch != HR2DI_SEEN_SKY) {
    const hr2d_segment at = v->viewer->scene->patch[s->patch].given;
    const int past = hr2di_symmetry_is_end(&v->viewer->scene->symmetry, s->patch);
    beam.seen = past ? HR2D_SEEN_PAST : HR2D_SEEN_FRONT;
    beam.patch = past ? 0 : s->patch;
    beam.from = past ? 0 : g->from;
    beam.to = past ? 0 : g->to;
    beam.end = (hr2d_segment){along(at, g->from, 1), along(at, g->to, 1)};
  }
  return v->show(v->ctx, &beam);
}

static hr2d_status trace(const hr2d_scene *scene, size_t patch, double t, visit *v,
                         hr2di_watch *watch) {
  hr2di_point_viewer *viewer = NULL;
  hr2di_view_from seen;
  hr2d_status status = hr2di_point_viewer_create(scene, &scene->alloc, watch, &viewer);
  if (status) return status;
  v->viewer = viewer;
  viewer->show = show_stretch;
  viewer->ctx = v;
  status = hr2di_view_at(viewer, patch, t, &seen);
  hr2di_point_viewer_destroy(viewer);
  return status;
}

/* Without the effect of occlusion nobody walks in the plane of a scene, which may have none. */
static hr2d_status view_unobstructed(const hr2d_scene *scene, size_t patch, double t, visit *v,
                                     hr2di_watch *watch) {
  hr2di_with_plane w;
  hr2d_status status = hr2di_with_plane_init(&w, scene, &scene->alloc, watch);
  w.scene.effect[HR2D_EFFECT_OCCLUSION].on = 1;
  if (!status) status = w.scene.unclear.is ? HR2D_ESCENE : trace(&w.scene, patch, t, v, watch);
  hr2di_with_plane_clear(&w);
  return status;
}

hr2d_status hr2d_beams_visit(const hr2d_scene *scene, size_t patch, double t, hr2d_beam_fn show,
                             void *ctx) {
  if (!scene || !show) return HR2D_EINVAL;
  if (!scene->committed) return HR2D_ESTATE;
  if (patch >= hr2di_scene_cell(scene) || !(t >= 0 && t <= 1)) return HR2D_EINVAL;
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "factors");
  visit v = {.unit = hr2d_scene_unit(scene), .show = show, .ctx = ctx};
  return scene->effect[HR2D_EFFECT_OCCLUSION].on
             ? trace(scene, patch, t, &v, &watch)
             : view_unobstructed(scene, patch, t, &v, &watch);
}
