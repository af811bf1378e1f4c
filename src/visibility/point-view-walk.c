/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view where something can be in the way: the expansion of the angle in front of the patch.

   Stretches follow each other from the right horizon to the left one, each from the last one's
   left ray: their sum is 1, whatever was rounded.

   The point is a rounding away from its own wall, and the walls themselves may have been moved
   by some.  So the first triangle is the one in front of the wall's side, and the ends of that
   edge are at the horizons, whatever side of the patch's line they are on.  Edges of the same
   wall, which roundings bend by less than their size, are not seen: what is beside them goes on
   to the horizon. */
#include "geometry/vector.h"
#include "scene/scene-impl.h"
#include "visibility/point-view-impl.h"

/* The side of a vertex that does not turn left against the right border.  Between two horizons
   the edge that is crossed has its ends at these, and a vertex that is in front of the edge but
   not of the horizon is so by roundings, on either side. */
static int side_of_behind(const hr2di_viewpoint *e, const hr2di_ray *right,
                          const hr2di_ray *left, const hr2di_ray_filter *f) {
  const int between = right->horizon && left->horizon;
  return between && f->to.x * e->axis.x + f->to.y * e->axis.y < 0 ? 1 : -1;
}

/* Most vertices are far beside the angle, and the first glance says so. */
static int side_of(void *ctx, void *right, void *left, uint32_t vertex, void *split) {
  const hr2di_point_viewer *w = ctx;
  const hr2di_viewpoint *e = &w->viewpoint;
  const hr2d_point place = w->scene->plane.triangulation.at[vertex];
  const hr2di_ray_filter ray_filter = hr2di_ray_filter_at(e, place);
  int of_right = hr2di_ray_filter_turn(e, right, &ray_filter), of_left = 0;
  if (of_right < 0) return side_of_behind(e, right, left, &ray_filter);
  if (of_right > 0) of_left = hr2di_ray_filter_turn(e, left, &ray_filter);
  if (of_left > 0) return 1;
  hr2di_ray_aim(e, place, vertex, split);
  if (of_right == 0) of_right = hr2di_ray_turn(e, right, split);
  if (of_right <= 0) return side_of_behind(e, right, left, &ray_filter);
  if (of_left == 0) of_left = hr2di_ray_turn(e, left, split);
  if (of_left >= 0) return 1;
  hr2di_ray_measure(e, split);
  return 0;
}

/* Goes on to see something from where it saw something else last.  Backs are told apart only
   where they are shown. */
static hr2d_status see(hr2di_point_viewer *w, uint32_t patch, hr2di_wall_side side,
                       const hr2di_ray *left, int starts, int ends) {
  hr2di_visible_arc *s = &w->seeing;
  hr2d_status status = HR2D_OK;
  const int other_back = w->show && patch == HR2DI_SEEN_NOBODY && side != s->side;
  if (patch != s->patch || other_back) {
    status = hr2di_view_add(w, s);
    s->right = s->left;
    s->patch = patch;
    s->side = side;
    s->starts = starts;
  }
  s->left = *left;
  s->ends = ends;
  return status;
}

/* Whether the end of a part that lies between two rays on the right of it and on the left. */
static int is_between(const hr2di_viewpoint *e, const hr2di_ray *right, const hr2di_ray *left,
                      const hr2di_ray *v) {
  return hr2di_ray_turn(e, right, v) > 0 && hr2di_ray_turn(e, left, v) < 0;
}

/* A ray from an eye. */
typedef struct sighted {
  const hr2di_viewpoint *viewpoint;
  const hr2di_ray *ray;
} sighted;

static int is_on_left(const void *of, hr2d_point place) {
  const sighted *b = of;
  const hr2di_ray end = hr2di_ray_to(b->viewpoint, place);
  return hr2di_ray_turn(b->viewpoint, b->ray, &end) > 0;
}

/* Sees the parts along a side from `right` to `left`.  The side starts on the right. */
static hr2d_status see_parts(hr2di_point_viewer *w, hr2di_wall_side side,
                             const hr2di_ray *right, const hr2di_ray *left) {
  const hr2di_wall_edge *edge = &w->scene->plane.triangulation.edge[side >> 1];
  const hr2di_side_part *part = w->scene->parts.part;
  const hr2di_parts among = w->scene->parts.of_side[side].parts;
  const uint32_t start = side & 1 ? edge->to : edge->from,
                 end = side & 1 ? edge->from : edge->to;
  const int from_start = right->vertex == start;
  const sighted first = {&w->viewpoint, right};
  hr2di_ray since = *right;
  hr2d_status status = HR2D_OK;
  uint32_t m = from_start ? among.first
                          : hr2di_side_parts_find(&w->scene->parts, among, is_on_left, &first);
  int starts = from_start;
  for (; m < among.last && !status; m++) {
    const uint32_t patch = part[m].patch;
    const int last = m + 1 == among.last;
    hr2di_ray until = hr2di_ray_to(&w->viewpoint, part[m].at.b);
    const int inside = !last && is_between(&w->viewpoint, &since, left, &until);
    if (!inside && !last && hr2di_ray_turn(&w->viewpoint, left, &until) < 0) continue;
    if (inside) hr2di_ray_measure(&w->viewpoint, &until);
    const hr2d_segment *s =
        patch == HR2DI_NOBODY ? &part[m].at : &w->scene->patch[patch].scaled;
    const int ends = (inside || left->vertex == end) && hr2di_point_same(part[m].at.b, s->b);
    status = see(w, patch, side, inside ? &until : left,
                 starts && hr2di_point_same(part[m].at.a, s->a), ends);
    if (!status) status = hr2di_watch_work(w->watch, 1);
    if (!inside) break;
    since = until;
    starts = 1;
  }
  return status;
}

static hr2d_status end_at(void *ctx, int32_t what, const void *right, void *on_left) {
  hr2di_point_viewer *w = ctx;
  const hr2di_ray *left = on_left;
  if (what == HR2DI_SKY) return see(w, HR2DI_SEEN_SKY, 0, left, 0, 0);
  const hr2di_wall_side side = (hr2di_wall_side)~what;
  if (side >> 1 >= w->own[0] && side >> 1 < w->own[1]) {
    if (w->seeing.patch != HR2DI_SEEN_NOTHING) w->seeing.left = *left;
    return HR2D_OK;
  }
  return w->scene->parts.wanted[side] ? see_parts(w, side, right, left)
                                      : see(w, HR2DI_SEEN_NOBODY, side, left, 0, 0);
}

/* The part of the patch at the point; NULL if it has none.  A point where two parts meet is
   in that towards the middle of the patch. */
static const hr2di_side_part *part_at(const hr2di_point_viewer *w) {
  const hr2di_side_part *part = w->scene->parts.part;
  const hr2di_parts of = w->scene->parts.of_patch[w->viewpoint.patch];
  uint32_t low = of.first, high = of.last;
  while (high - low > 1) {
    const uint32_t middle = low + (high - low) / 2;
    const hr2di_ray start = hr2di_ray_to(&w->viewpoint, part[middle].at.a);
    const double along = hr2di_vector_dot(&start.to, &w->viewpoint.axis);
    if (along < 0 || (along == 0 && w->viewpoint.t <= .5))
      low = middle;
    else
      high = middle;
  }
  return of.first == of.last ? NULL : &part[low];
}

/* A patch that is a rounding behind another one, or that is but dust, sees only backs. */
hr2d_status hr2di_view_walk(hr2di_point_viewer *w, const hr2di_ray border[2]) {
  const hr2d_scene *scene = w->scene;
  const hr2di_triangulation *in = &scene->plane.triangulation;
  const hr2di_side_part *part = part_at(w);
  const int hidden = !part || part->patch != w->viewpoint.patch || part->side == HR2DI_HIDDEN;
  const uint32_t side = hidden ? 0 : part->side;
  const hr2di_wall_edge *edge = &in->edge[side >> 1];
  const uint32_t *of_wall = scene->plane.pieces.of_wall;
  const uint32_t wall = scene->walls.of_segment[w->viewpoint.patch];
  const hr2di_ray right =
      border ? border[0] : hr2di_ray_horizon(1, side & 1 ? edge->from : edge->to);
  const hr2di_ray left =
      border ? border[1] : hr2di_ray_horizon(-1, side & 1 ? edge->to : edge->from);
  w->own[0] = in->edge_of[of_wall[wall]];
  w->own[1] = in->edge_of[of_wall[wall + 1]];
  w->seeing = (hr2di_visible_arc){.patch = HR2DI_SEEN_NOTHING, .right = right, .left = right};
  w->between.in = in;
  w->between.watch = w->watch;
  w->between.alloc = w->alloc;
  w->between.border = sizeof(hr2di_ray);
  w->between.side = side_of;
  w->between.end = end_at;
  w->between.ctx = w;
  const hr2d_status status =
      hidden ? see(w, HR2DI_SEEN_NOBODY, HR2DI_HIDDEN, &left, 0, 0)
             : hr2di_triangular_expansion_walk(&w->between, edge->half_edge[side & 1], &right,
                                               &left);
  return status ? status : hr2di_view_add(w, &w->seeing);
}
