/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An expansion through the triangles of the plane, out of the one at the point through its
   three sides.  Its borders are rays to vertices.  The point and the vertices are doubles, so
   that all signs are exact. */
#include "field/visibility-polygon.h"

#include <math.h>

#include "field/locate.h"
#include "geometry/orient-sign.h"
#include "geometry/vector.h"

/* Farther away than this the scene is a point. */
#define FAR 0x1p+60

/* Whether q is on the left of the ray from the point to p: 1; on its right: −1. */
static int turn(const hr2di_visibility_polygon *v, hr2d_point p, hr2d_point q) {
  return hr2di_orient_sign(v->x, p, q);
}

/* From 0 to π.  Only roundings make it negative. */
static double angle_of(hr2d_point right, hr2d_point left) {
  const double cross = hr2di_point_cross(right, left), dot = hr2di_point_dot(right, left);
  if (cross > 0) return atan2(cross, dot);
  return dot < 0 ? acos(-1) : 0;
}

static hr2d_status show(hr2di_visibility_polygon *v, hr2di_polygon_arc *s) {
  s->angle = angle_of(s->right, s->left);
  const hr2d_status status = hr2di_watch_work(v->watch, 1);
  return status ? status : v->take(v->ctx, s);
}

/* Where a ray meets a patch that shows its front. */
static double fraction(const hr2di_visibility_polygon *v, hr2d_segment patch, hr2d_point ray) {
  const double at_a = -hr2di_point_cross(ray, hr2di_point_minus(patch.a, v->x));
  const double at_b = hr2di_point_cross(ray, hr2di_point_minus(patch.b, v->x));
  /* What has the wrong sign is but a rounding. */
  if (!(at_a > 0)) return 0;
  if (!(at_b > 0)) return 1;
  return at_a / (at_a + at_b);
}

/* The part of a patch from one place to another; *_end: that is the end of the patch. */
static hr2d_status show_part(hr2di_visibility_polygon *v, hr2di_wall_side side, uint32_t patch,
                             hr2d_point right, hr2d_point left, int starts, int ends) {
  hr2di_polygon_arc s = {.patch = patch,
                         .what = ~(int32_t)side,
                         .right = hr2di_point_minus(right, v->x),
                         .left = hr2di_point_minus(left, v->x)};
  if (patch != HR2DI_NOBODY) {
    const hr2d_segment at = v->scene->patch[patch].scaled;
    s.from = starts ? 0 : fraction(v, at, s.right);
    s.to = ends ? 1 : fraction(v, at, s.left);
    if (s.to < s.from) s.to = s.from;
  }
  return show(v, &s);
}

/* A ray from a point to another one. */
typedef struct ray {
  const hr2di_visibility_polygon *v;
  hr2d_point to;
} ray;

static int is_on_left(const void *of, hr2d_point end) {
  const ray *r = of;
  return turn(r->v, r->to, end) > 0;
}

/* Shows the parts along a side between two vertices.  The side starts on the right. */
static hr2d_status show_parts(hr2di_visibility_polygon *v, hr2di_wall_side side, uint32_t right,
                              uint32_t left) {
  const hr2di_triangulation *in = &v->scene->plane.triangulation;
  const hr2di_wall_edge *edge = &in->edge[side >> 1];
  const hr2di_side_part *part = v->scene->parts.part;
  const hr2di_parts among = v->scene->parts.of_side[side].parts;
  const uint32_t start = side & 1 ? edge->to : edge->from,
                 end = side & 1 ? edge->from : edge->to;
  const hr2d_point last = in->at[left];
  hr2d_point since = in->at[right];
  hr2d_status status = HR2D_OK;
  const ray first = {v, since};
  uint32_t m = right == start
                   ? among.first
                   : hr2di_side_parts_find(&v->scene->parts, among, is_on_left, &first);
  int starts = right == start;
  for (; m < among.last && !status; m++) {
    const hr2di_side_part *p = &part[m];
    const int inside =
        m + 1 < among.last && turn(v, since, p->at.b) > 0 && turn(v, last, p->at.b) < 0;
    const hr2d_segment *whole =
        p->patch == HR2DI_NOBODY ? &p->at : &v->scene->patch[p->patch].scaled;
    if (!inside && m + 1 < among.last && turn(v, last, p->at.b) < 0) continue;
    status = show_part(v, side, p->patch, since, inside ? p->at.b : last,
                       starts && hr2di_point_same(p->at.a, whole->a),
                       (inside || left == end) && hr2di_point_same(p->at.b, whole->b));
    if (!inside) break;
    since = p->at.b;
    starts = 1;
  }
  return status;
}

/* The angle between two vertices ends at something. */
static hr2d_status end_at(void *ctx, int32_t what, const void *on_right, void *on_left) {
  hr2di_visibility_polygon *v = ctx;
  const uint32_t right = *(const uint32_t *)on_right, left = *(const uint32_t *)on_left;
  const hr2d_point *at = v->scene->plane.triangulation.at;
  hr2di_polygon_arc s = {.patch = HR2DI_ROUND_BACK,
                         .what = what,
                         .right = hr2di_point_minus(at[right], v->x),
                         .left = hr2di_point_minus(at[left], v->x)};
  if (what == HR2DI_SKY) s.patch = HR2DI_ROUND_SKY;
  if (what != HR2DI_SKY && v->scene->parts.wanted[~what])
    return show_parts(v, (hr2di_wall_side)~what, right, left);
  return show(v, &s);
}

static int side_of(void *ctx, void *right, void *left, uint32_t vertex, void *split) {
  const hr2di_visibility_polygon *v = ctx;
  const hr2d_point *at = v->scene->plane.triangulation.at;
  *(uint32_t *)split = vertex;
  if (turn(v, at[*(const uint32_t *)right], at[vertex]) <= 0) return -1;
  return turn(v, at[*(const uint32_t *)left], at[vertex]) < 0 ? 0 : 1;
}

/* Walks the angle between two vertices, from half-edge h or at what it ends. */
static hr2d_status walk_from(hr2di_visibility_polygon *v, int32_t h, uint32_t right,
                             uint32_t left) {
  hr2di_triangular_expansion *x = &v->between;
  x->in = &v->scene->plane.triangulation;
  x->watch = v->watch;
  x->alloc = v->alloc;
  x->border = sizeof(uint32_t);
  x->side = side_of;
  x->end = end_at;
  x->ctx = v;
  return hr2di_triangular_expansion_walk(x, h, &right, &left);
}

/* In triangle `at`. */
static hr2d_status view_from(hr2di_visibility_polygon *v, int32_t at) {
  const hr2di_triangulation *in = &v->scene->plane.triangulation;
  const hr2di_triangle t = in->triangle[at];
  hr2d_status status = HR2D_OK;
  v->between.outside = hr2di_triangle_is_outside(in, &t);
  for (int k = 0; k < 3 && !status; k++)
    status = walk_from(v, t.across[k], t.corner[k], t.corner[(k + 1) % 3]);
  return status;
}

/* The next half-edge of the border, to the left as the box sees it. */
static int32_t next_border(const hr2di_triangulation *t, int32_t h) {
  do h = (h & 3) == 2 ? h - 2 : h + 1;
  while (t->triangle[h >> 2].across[h & 3] != HR2DI_SKY &&
         (h = t->triangle[h >> 2].across[h & 3]) >= 0);
  return h;
}

/* Beyond a side of the box, x sees the box through this side and perhaps through one or two
   more; the rest is sky.  All of the sky is shown as stretches of less than a half circle. */
static hr2d_status search_in(hr2di_visibility_polygon *v, int32_t border) {
  const hr2di_triangulation *in = &v->scene->plane.triangulation;
  hr2d_status status = HR2D_OK;
  v->between.outside = 1;
  for (int k = 0; k < 4 && !status; k++, border = next_border(in, border)) {
    const hr2di_triangle *t = &in->triangle[border >> 2];
    const uint32_t from = t->corner[border & 3], to = t->corner[((border & 3) + 1) % 3];
    /* From outside the border runs to the right. */
    if (hr2di_orient_sign(in->at[from], in->at[to], v->x) < 0)
      status = walk_from(v, border, to, from);
  }
  return status;
}

/* The directions from x that do not meet the box, in parts. */
static hr2d_status see_sky_around(hr2di_visibility_polygon *v) {
  const hr2di_triangulation *in = &v->scene->plane.triangulation;
  const hr2d_point *corner = &in->at[in->vertices - 4];
  hr2d_point right = corner[0], left = corner[0];
  for (int k = 1; k < 4; k++) {
    if (turn(v, right, corner[k]) < 0) right = corner[k];
    if (turn(v, left, corner[k]) > 0) left = corner[k];
  }
  const hr2d_point r = hr2di_point_minus(right, v->x), l = hr2di_point_minus(left, v->x);
  /* A direction away from the box: less than a half circle from each of its sides. */
  const double sr = 1 / hypot(r.x, r.y), sl = 1 / hypot(l.x, l.y);
  const hr2d_point away = {-(sr * r.x + sl * l.x), -(sr * r.y + sl * l.y)};
  hr2di_polygon_arc one = {
      .patch = HR2DI_ROUND_SKY, .what = HR2DI_SKY, .right = l, .left = away};
  hr2di_polygon_arc two = {
      .patch = HR2DI_ROUND_SKY, .what = HR2DI_SKY, .right = away, .left = r};
  const hr2d_status status = show(v, &one);
  return status ? status : show(v, &two);
}

static hr2d_status see_only_sky(hr2di_visibility_polygon *v) {
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < 2 && !status; k++) {
    const double x = k == 0 ? 1 : -1;
    hr2di_polygon_arc s = {
        .patch = HR2DI_ROUND_SKY, .what = HR2DI_SKY, .right = {x, 0}, .left = {-x, 0}};
    status = show(v, &s);
  }
  return status;
}

/* One of the walls that meet at x: what comes near to x along the line sees its end there in
   all directions from the line's back to the wall. */
static hr2d_status show_beside(hr2di_visibility_polygon *v, const hr2di_touch *t, int left,
                               hr2d_point along) {
  const hr2d_point back = {-t->ahead.x, -t->ahead.y};
  hr2di_polygon_arc s = {.patch = t->beside[left],
                         .right = left ? along : back,
                         .left = left ? back : along,
                         .angle = t->angle};
  if (s.patch != HR2DI_NOBODY) {
    const hr2d_segment at = v->scene->patch[s.patch].scaled;
    const hr2d_point d = hr2di_point_minus(at.b, at.a), e = hr2di_point_minus(v->x, at.a);
    s.from = s.to = fmin(fmax(hr2di_point_dot(d, e) / hr2di_point_dot(d, d), 0), 1);
  }
  return s.angle > 0 ? v->take(v->ctx, &s) : HR2D_OK;
}

hr2d_status hr2di_beams_between(hr2di_visibility_polygon *v, int32_t first, int32_t *last) {
  const hr2di_triangulation *in = &v->scene->plane.triangulation;
  int32_t h = first;
  hr2d_status status = HR2D_OK;
  v->x = in->at[in->triangle[h >> 2].corner[h & 3]];
  v->between.outside = 0;
  while (h >= 0 && !status) {
    const hr2di_triangle *t = &in->triangle[h >> 2];
    const int to_left = hr2di_corner_after(h & 3), back = hr2di_corner_before(h & 3);
    *last = 4 * (h >> 2) + back;
    status = walk_from(v, t->across[to_left], t->corner[to_left], t->corner[back]);
    h = t->across[back];
  }
  return status;
}

/* From the vertex where walls meet, through the triangles between two of them. */
static hr2d_status find_ahead(hr2di_visibility_polygon *v, const hr2di_touch *touch) {
  const hr2di_triangulation *in = &v->scene->plane.triangulation;
  const int32_t h = touch->first;
  const uint32_t right = in->triangle[h >> 2].corner[hr2di_corner_after(h & 3)];
  int32_t last = h;
  hr2d_status status = show_beside(v, touch, 0, hr2di_point_minus(in->at[right], v->x));
  if (!status) status = hr2di_beams_between(v, h, &last);
  if (status) return status;
  const uint32_t left = in->triangle[last >> 2].corner[last & 3];
  return show_beside(v, touch, 1, hr2di_point_minus(in->at[left], v->x));
}

/* Whether x is a corner of the box, where it sees the plane only from a little farther out. */
static int is_corner(const hr2di_triangulation *in, hr2d_point x) {
  for (size_t k = in->vertices - 4; k < in->vertices; k++)
    if (hr2di_point_same(in->at[k], x)) return 1;
  return 0;
}

hr2d_status hr2di_beams_all_round(hr2di_visibility_polygon *v, hr2d_point x, int *touches) {
  const hr2di_triangulation *in = &v->scene->plane.triangulation;
  int32_t border;
  hr2di_touch touch;
  *touches = 0;
  v->x = x;
  if (in->triangles == 0 || !(fmax(fabs(x.x), fabs(x.y)) < FAR)) return see_only_sky(v);
  if (is_corner(in, x)) v->x.x += x.x < in->at[0].x ? -0x1p-50 : 0x1p-50;
  int32_t at = hr2di_locate(in, v->x, &v->near, &border);
  *touches = at != HR2DI_BEYOND && hr2di_offset_viewpoint(v->scene, at, v->x, &touch);
  if (*touches) {
    v->x = touch.x;
    if (touch.first >= 0) return find_ahead(v, &touch);
    at = hr2di_locate(in, v->x, &v->near, &border);
  }
  if (at != HR2DI_BEYOND) return view_from(v, at);
  const hr2d_status status = search_in(v, border);
  return status ? status : see_sky_around(v);
}

void hr2di_visibility_polygon_clear(hr2di_visibility_polygon *v) {
  hr2di_triangular_expansion_clear(&v->between);
}
