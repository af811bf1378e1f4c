/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view where something can be in the way: the angle in front of the patch, walked through
   the triangles of the plane.

   A triangle is entered by an edge, with a ray past its right end and one past its left end.
   Its third vertex is on the left of the right ray and on the right of the left one, and then
   the point sees it and the angle splits there; or all of the angle passes it on one side.  The
   angle ends at sides of walls.  The right part of a split is walked first, so that stretches
   follow each other from the right horizon to the left one, each from the last one's left ray:
   their sum is 1, whatever was rounded.

   The point is a rounding away from its own wall, and the walls themselves may have been moved
   by some.  So the first triangle is the one in front of the wall's side, and the ends of that
   edge are at the horizons, whatever side of the patch's line they are on.  Edges of the same
   wall, which roundings bend by less than their size, are not seen: what is beside them goes on
   to the horizon. */
#include "base/alloc.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"
#include "visibility/point-view-impl.h"

/* The ray at which an angle ends on the left, and what is on its left: a half-edge to go on
   from, or a side of a wall. */
struct hr2di_view_frame {
  hr2di_ray left;
  int32_t beyond;
};

/* Fixed during a walk. */
typedef struct walk {
  hr2di_viewer *w;
  const hr2di_triangulation *in;
  uint32_t own[2];   /* the edges of the point's wall are [own[0], own[1]) */
  hr2di_ray right;   /* where the angle begins that is walked */
  int32_t beyond[2]; /* a split: what is on the right of the vertex, and on its left */
} walk;

/* On which side of an angle a vertex is, −1 on the right and 1 on the left, or 0 inside; then
 *v is the ray to it.  Most vertices are far beside the angle, and the first ray says so. */
static int side_of(const walk *k, const hr2di_ray *left, uint32_t vertex, hr2di_ray *v) {
  const hr2di_eye *e = &k->w->eye;
  const hr2d_point place = k->in->at[vertex];
  const hr2di_glance glance = hr2di_glance_at(e, place);
  int of_right = hr2di_glance_turn(e, &k->right, &glance), of_left = 0;
  if (of_right < 0) return -1;
  if (of_right > 0) of_left = hr2di_glance_turn(e, left, &glance);
  if (of_left > 0) return 1;
  hr2di_ray_aim(e, place, vertex, v);
  if (of_right == 0) of_right = hr2di_ray_turn(e, &k->right, v);
  if (of_right <= 0) return -1;
  if (of_left == 0) of_left = hr2di_ray_turn(e, left, v);
  return of_left < 0 ? 0 : 1;
}

/* Follows an angle from half-edge h to where it splits, at *v, or ends; returns what it ends
   at.  A straight line enters each triangle once at most, which ends it also where roundings of
   rays would lead it in a circle. */
static int32_t follow(walk *k, const hr2di_ray *left, int32_t h, hr2di_ray *v, int *splits) {
  for (size_t steps = 1; steps <= k->in->triangles; steps++) {
    if (steps % 32 == 0 && hr2di_watch_work(k->w->watch, 16)) break;
    const hr2di_triangle *t = &k->in->triangle[h >> 2];
    const int to_right = hr2di_corner_after(h & 3), to_left = hr2di_corner_before(h & 3);
    const int side = side_of(k, left, t->corner[to_left], v);
    *splits = side == 0;
    k->beyond[0] = t->across[to_right];
    k->beyond[1] = t->across[to_left];
    if (*splits) return 0;
    h = k->beyond[side > 0 ? 0 : 1];
    if (h < 0) return h;
  }
  *splits = 0;
  return HR2DI_SKY;
}

/* Goes on to see something from where it saw something else last.  Backs are told apart only
   where they are shown. */
static hr2d_status see(hr2di_viewer *w, uint32_t patch, hr2di_wall_side side,
                       const hr2di_ray *left, int starts, int ends) {
  hr2di_stretch *s = &w->seeing;
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
static int is_between(const hr2di_eye *e, const hr2di_ray *right, const hr2di_ray *left,
                      const hr2di_ray *v) {
  return hr2di_ray_turn(e, right, v) > 0 && hr2di_ray_turn(e, left, v) < 0;
}

/* The first part along a side whose end is on the left of a ray. */
static uint32_t first_part(const hr2di_eye *e, const hr2di_side_part *part, hr2di_parts among,
                           const hr2di_ray *right) {
  uint32_t low = among.first, high = among.last - 1;
  while (low < high) {
    const uint32_t middle = low + (high - low) / 2;
    const hr2di_ray end = hr2di_ray_to(e, part[middle].at.b);
    if (hr2di_ray_turn(e, right, &end) > 0)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

/* Sees the parts along a side from `right` to `left`.  The side starts on the right. */
static hr2d_status see_parts(walk *k, hr2di_wall_side side, const hr2di_ray *left) {
  hr2di_viewer *w = k->w;
  const hr2di_wall_edge *edge = &k->in->edge[side >> 1];
  const hr2di_side_part *part = w->scene->parts.part;
  const hr2di_parts among = w->scene->parts.of_side[side].parts;
  const uint32_t start = side & 1 ? edge->to : edge->from,
                 end = side & 1 ? edge->from : edge->to;
  const int from_start = k->right.vertex == start;
  hr2di_ray since = k->right;
  hr2d_status status = HR2D_OK;
  uint32_t m = from_start ? among.first : first_part(&w->eye, part, among, &since);
  int starts = from_start;
  for (; m < among.last && !status; m++) {
    const uint32_t patch = part[m].patch;
    const int last = m + 1 == among.last;
    hr2di_ray until = hr2di_ray_to(&w->eye, part[m].at.b);
    const int inside = !last && is_between(&w->eye, &since, left, &until);
    if (!inside && !last && hr2di_ray_turn(&w->eye, left, &until) < 0) continue;
    if (inside) hr2di_ray_measure(&w->eye, &until);
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

/* The angle up to `left` ends at something. */
static hr2d_status end_at(walk *k, int32_t what, const hr2di_ray *left) {
  hr2di_viewer *w = k->w;
  if (what == HR2DI_SKY) return see(w, HR2DI_SEEN_SKY, 0, left, 0, 0);
  const hr2di_wall_side side = (hr2di_wall_side)~what;
  if (side >> 1 >= k->own[0] && side >> 1 < k->own[1]) {
    if (w->seeing.patch != HR2DI_SEEN_NOTHING) w->seeing.left = *left;
    return HR2D_OK;
  }
  return w->scene->parts.wanted[side] ? see_parts(k, side, left)
                                      : see(w, HR2DI_SEEN_NOBODY, side, left, 0, 0);
}

static hr2d_status push(hr2di_viewer *w, const hr2di_ray *left, int32_t beyond) {
  if (hr2di_alloc_reserve(&w->alloc, &w->frame, &w->frame_room, w->frames + 1,
                          sizeof *w->frame))
    return HR2D_ENOMEM;
  w->frame[w->frames++] = (hr2di_view_frame){*left, beyond};
  return HR2D_OK;
}

static hr2d_status walk_from(walk *k, int32_t h) {
  hr2di_viewer *w = k->w;
  hr2d_status status = HR2D_OK;
  while (!status) {
    int splits;
    hr2di_ray v;
    h = follow(k, &w->frame[w->frames - 1].left, h, &v, &splits);
    status = hr2di_watch_work(w->watch, 1);
    if (splits) {
      hr2di_ray_measure(&w->eye, &v);
      if (!status) status = push(w, &v, k->beyond[1]);
      h = k->beyond[0];
    }
    while (h < 0 && !status) {
      const hr2di_view_frame f = w->frame[--w->frames];
      status = end_at(k, h, &f.left);
      if (w->frames == 0) return status;
      k->right = f.left;
      h = f.beyond;
    }
  }
  return status;
}

/* The part of the patch at the point; NULL if it has none.  A point where two parts meet is
   in that towards the middle of the patch. */
static const hr2di_side_part *part_at(const hr2di_viewer *w) {
  const hr2di_side_part *part = w->scene->parts.part;
  const hr2di_parts of = w->scene->parts.of_patch[w->eye.patch];
  uint32_t low = of.first, high = of.last;
  while (high - low > 1) {
    const uint32_t middle = low + (high - low) / 2;
    const hr2di_ray start = hr2di_ray_to(&w->eye, part[middle].at.a);
    const double along = hr2di_vector_dot(&start.to, &w->eye.axis);
    if (along < 0 || (along == 0 && w->eye.t <= .5))
      low = middle;
    else
      high = middle;
  }
  return of.first == of.last ? NULL : &part[low];
}

/* A patch that is a rounding behind another one, or that is but dust, sees only backs. */
hr2d_status hr2di_view_walk(hr2di_viewer *w, const hr2di_ray border[2]) {
  const hr2d_scene *scene = w->scene;
  const hr2di_triangulation *in = &scene->plane.triangulation;
  const hr2di_side_part *part = part_at(w);
  const int hidden = !part || part->patch != w->eye.patch || part->side == HR2DI_HIDDEN;
  const uint32_t side = hidden ? 0 : part->side;
  const hr2di_wall_edge *edge = &in->edge[side >> 1];
  const uint32_t *of_wall = scene->plane.pieces.of_wall;
  const uint32_t wall = scene->walls.of_segment[w->eye.patch];
  walk k = {.w = w,
            .in = in,
            .own = {in->edge_of[of_wall[wall]], in->edge_of[of_wall[wall + 1]]},
            .right =
                border ? border[0] : hr2di_ray_horizon(1, side & 1 ? edge->from : edge->to)};
  const hr2di_ray left =
      border ? border[1] : hr2di_ray_horizon(-1, side & 1 ? edge->to : edge->from);
  w->seeing = (hr2di_stretch){.patch = HR2DI_SEEN_NOTHING, .right = k.right, .left = k.right};
  w->frames = 0;
  hr2d_status status = push(w, &left, 0);
  if (!status)
    status = hidden ? see(w, HR2DI_SEEN_NOBODY, HR2DI_HIDDEN, &left, 0, 0)
                    : walk_from(&k, edge->half_edge[side & 1]);
  return status ? status : hr2di_view_add(w, &w->seeing);
}
