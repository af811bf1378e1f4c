/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What touches a point, and the point beside it that looks in its place.

   The sides of walls at a point divide a small circle around it into sectors.  At a vertex of
   the triangulation these are found by a turn around it; on the inside of a wall edge there are
   two half circles. */
#include <math.h>

#include "field/locate.h"
#include "geometry/vector.h"

/* Angles that differ by less are equal. */
#define SAME_ANGLE 1e-9

/* Triangles around a point that have a side which is as near as walls must be. */
enum { NEAR_TRIANGLES = 16 };

/* Between the side of a wall on its right and another one on its left. */
typedef struct sector {
  int fronts;
  uint32_t patch; /* the least of the patches on its two sides, or HR2DI_NOBODY */
  double angle;
  hr2d_point right;   /* a unit vector */
  int32_t first;      /* the half-edge along its right side, from the vertex; HR2DI_SKY: none */
  uint32_t beside[2]; /* the patches on its right and on its left, or HR2DI_NOBODY */
} sector;

static uint32_t second_patch(const sector *s) {
  return s->beside[0] == s->patch ? s->beside[1] : s->beside[0];
}

/* The order is strict, as a turn may begin at any of the sectors. */
static int better(const sector *one, const sector *other) {
  if (one->fronts != other->fronts) return one->fronts > other->fronts;
  if (fabs(one->angle - other->angle) > SAME_ANGLE) return one->angle > other->angle;
  if (one->patch != other->patch) return one->patch < other->patch;
  if (second_patch(one) != second_patch(other)) return second_patch(one) < second_patch(other);
  if (one->right.x != other->right.x) return one->right.x < other->right.x;
  return one->right.y < other->right.y;
}

static double distance(hr2d_point p, hr2d_point q) {
  return hypot(p.x - q.x, p.y - q.y);
}

static hr2d_point unit(hr2d_point from, hr2d_point to) {
  const double length = distance(from, to);
  return (hr2d_point){(to.x - from.x) / length, (to.y - from.y) / length};
}

/* How far a place on the edge is along it, from 0 to 1. */
static double place_on(hr2d_segment s, hr2d_point x) {
  const hr2d_point d = hr2di_point_minus(s.b, s.a), e = hr2di_point_minus(x, s.a);
  return fmin(fmax(hr2di_point_dot(d, e) / hr2di_point_dot(d, d), 0), 1);
}

uint32_t hr2di_patch_beside(const hr2d_scene *scene, hr2di_wall_side side, hr2d_point x) {
  const hr2di_side_parts *parts = &scene->parts;
  if (!parts->wanted[side]) return HR2DI_NOBODY;
  const hr2di_parts of = parts->of_side[side].parts;
  uint32_t patch = HR2DI_NOBODY;
  double min = HUGE_VAL;
  for (uint32_t k = of.first; k < of.last; k++) {
    const hr2d_segment s = parts->part[k].at;
    const double t = place_on(s, x);
    const hr2d_point at = {s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
    if (!(distance(at, x) < min)) continue;
    min = distance(at, x);
    patch = parts->part[k].patch;
  }
  return patch;
}

static void add_side(const hr2d_scene *scene, hr2di_wall_side side, hr2d_point x, int left,
                     sector *s) {
  const uint32_t patch = hr2di_patch_beside(scene, side, x);
  s->beside[left] = patch;
  s->fronts += patch != HR2DI_NOBODY;
  if (patch < s->patch) s->patch = patch;
}

static double angle_between(hr2d_point u, hr2d_point v) {
  return atan2(hr2di_point_cross(u, v), hr2di_point_dot(u, v));
}

/* A turn to the left around a vertex, from one side of a wall to the next. */
typedef struct turn {
  const hr2d_scene *scene;
  const hr2di_triangulation *in;
  hr2d_point centre;
  int32_t first; /* a half-edge that leaves the vertex along a wall, its triangle on the left */
  sector now, best;
} turn;

static void end_sector(turn *t) {
  if (better(&t->now, &t->best)) t->best = t->now;
}

/* A half-edge from the vertex that is the side of a wall begins a sector. */
static void begin_sector(turn *t, int32_t h) {
  const hr2di_triangle *at = &t->in->triangle[h >> 2];
  t->now = (sector){.patch = HR2DI_NOBODY, .first = h, .beside = {HR2DI_NOBODY, HR2DI_NOBODY}};
  t->now.right = unit(t->centre, t->in->at[at->corner[((h & 3) + 1) % 3]]);
  add_side(t->scene, (hr2di_wall_side)~at->across[h & 3], t->centre, 0, &t->now);
}

/* Passes the triangle of h, a half-edge from the vertex; returns the next one.  The side of the
   triangle behind is the half-edge to the vertex. */
static int32_t pass(turn *t, int32_t h) {
  const int32_t last = (h & 3) == 0 ? h + 2 : h - 1;
  const hr2di_triangle *at = &t->in->triangle[h >> 2];
  const hr2d_point right = t->in->at[at->corner[((h & 3) + 1) % 3]],
                   left = t->in->at[at->corner[last & 3]];
  t->now.angle +=
      angle_between(hr2di_point_minus(right, t->centre), hr2di_point_minus(left, t->centre));
  const int32_t across = at->across[last & 3];
  if (across >= 0 || across == HR2DI_SKY) return across;
  add_side(t->scene, (hr2di_wall_side)~across, t->centre, 1, &t->now);
  end_sector(t);
  return t->in->edge[(uint32_t)~across >> 1].half_edge[1 - (~across & 1)];
}

/* A side of a wall that leaves the vertex of half-edge h; HR2DI_SKY if it has no walls. */
static int32_t find_wall(turn *t, int32_t h) {
  const int32_t start = h;
  do {
    const int32_t across = t->in->triangle[h >> 2].across[h & 3];
    if (across < 0) return across == HR2DI_SKY ? HR2DI_SKY : h;
    h = (across & 3) == 2 ? across - 2 : across + 1;
  } while (h != start);
  return HR2DI_SKY;
}

/* The best sector at the vertex from which half-edge h leaves; 0 if it has no walls. */
static int trace_round(turn *t, int32_t h) {
  const int32_t first = find_wall(t, h);
  if (first == HR2DI_SKY) return 0;
  t->best =
      (sector){.fronts = -1, .patch = HR2DI_NOBODY, .beside = {HR2DI_NOBODY, HR2DI_NOBODY}};
  int32_t at = first;
  do {
    if (t->in->triangle[at >> 2].across[at & 3] < 0) begin_sector(t, at);
    at = pass(t, at);
  } while (at != first && at != HR2DI_SKY);
  return 1;
}

/* Both half circles beside a wall edge. */
static void view_beside(turn *t, int32_t side) {
  const hr2di_wall_edge *edge = &t->in->edge[(uint32_t)side >> 1];
  const hr2d_point from = t->in->at[edge->from], to = t->in->at[edge->to];
  sector half[2];
  for (uint32_t k = 0; k < 2; k++) {
    half[k] = (sector){.patch = HR2DI_NOBODY,
                       .angle = acos(-1),
                       .first = HR2DI_SKY,
                       .beside = {HR2DI_NOBODY, HR2DI_NOBODY}};
    half[k].right = k == 0 ? unit(from, to) : unit(to, from);
    add_side(t->scene, ((uint32_t)side & ~1u) | k, t->centre, 0, &half[k]);
  }
  t->best = better(&half[1], &half[0]) ? half[1] : half[0];
}

/* The direction that halves the best sector. */
static hr2d_point ahead(const turn *t) {
  const double c = cos(t->best.angle / 2), s = sin(t->best.angle / 2);
  const hr2d_point right = t->best.right;
  return (hr2d_point){c * right.x - s * right.y, s * right.x + c * right.y};
}

/* Looks at a triangle: at a vertex or a wall of it that touches x. */
static int try_triangle(turn *t, int32_t at, hr2d_point x) {
  const hr2di_triangle *in = &t->in->triangle[at];
  for (int k = 0; k < 3; k++) {
    t->centre = t->in->at[in->corner[k]];
    if (distance(t->centre, x) <= HR2DI_FIELD_TOUCH && trace_round(t, 4 * at + k)) return 1;
  }
  for (int k = 0; k < 3; k++) {
    if (in->across[k] >= 0 || in->across[k] == HR2DI_SKY) continue;
    const hr2d_segment s = {t->in->at[in->corner[k]], t->in->at[in->corner[(k + 1) % 3]]};
    const double along = place_on(s, x);
    t->centre = (hr2d_point){s.a.x + along * (s.b.x - s.a.x), s.a.y + along * (s.b.y - s.a.y)};
    if (distance(t->centre, x) > HR2DI_FIELD_TOUCH) continue;
    view_beside(t, ~in->across[k]);
    return 1;
  }
  return 0;
}

static int is_in(const int32_t *list, int count, int32_t item) {
  for (int k = 0; k < count; k++)
    if (list[k] == item) return 1;
  return 0;
}

static hr2di_touch touch_of(const turn *t) {
  const hr2d_point d = ahead(t);
  hr2di_touch touch = {.x = t->centre, .ahead = d, .first = t->best.first};
  touch.angle = acos(-1) - t->best.angle / 2;
  for (int k = 0; k < 2; k++) touch.beside[k] = t->best.beside[k];
  if (touch.first == HR2DI_SKY) {
    touch.x.x += HR2DI_FIELD_BESIDE * d.x;
    touch.x.y += HR2DI_FIELD_BESIDE * d.y;
  }
  return touch;
}

int hr2di_offset_viewpoint(const hr2d_scene *scene, int32_t at, hr2d_point x,
                           hr2di_touch *touch) {
  turn t = {.scene = scene, .in = &scene->plane.triangulation};
  int32_t list[NEAR_TRIANGLES] = {at};
  for (int done = 0, count = 1; done < count; done++) {
    if (try_triangle(&t, list[done], x)) {
      *touch = touch_of(&t);
      return 1;
    }
    const hr2di_triangle *in = &t.in->triangle[list[done]];
    for (int k = 0; k < 3; k++) {
      const hr2d_segment s = {t.in->at[in->corner[k]], t.in->at[in->corner[(k + 1) % 3]]};
      const double along = place_on(s, x);
      const hr2d_point foot = {s.a.x + along * (s.b.x - s.a.x),
                               s.a.y + along * (s.b.y - s.a.y)};
      if (in->across[k] >= 0 && count < NEAR_TRIANGLES &&
          distance(foot, x) <= HR2DI_FIELD_TOUCH && !is_in(list, count, in->across[k] >> 2))
        list[count++] = in->across[k] >> 2;
    }
  }
  return 0;
}
