/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shafts, by separating lines: two convex sets are apart if an edge of one separates
   them.  What is in front of an element is what is in front of its patch, whose ends are
   not rounded. */
#include "clusters/shaft.h"

#include <math.h>

static double largest(hr2d_point p) {
  return fmax(fabs(p.x), fabs(p.y));
}

/* The point of p→q on a line between them; an end of the segment on that line if it is
   that. */
static hr2d_point foot(hr2d_point p, hr2d_point q, hr2d_point on_a, hr2d_point on_b) {
  if (hr2di_orient_sign(p, q, on_a) == 0) return on_a;
  if (hr2di_orient_sign(p, q, on_b) == 0) return on_b;
  const double t = hr2di_line_crossing(on_a, on_b, p, q);
  if (t > 0.5) return (hr2d_point){q.x + (1 - t) * (p.x - q.x), q.y + (1 - t) * (p.y - q.y)};
  return (hr2d_point){p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
}

/* Points on one line that are a rounding apart are one. */
static void snap(hr2di_incident_point *p, hr2di_incident_point to) {
  const double near = HR2DI_TOUCH * largest(to.at);
  if (!(p->on & to.on) || fabs(p->at.x - to.at.x) > near || fabs(p->at.y - to.at.y) > near)
    return;
  p->at = to.at;
  p->on |= to.on;
}

/* What is in front of a line of the obstacle, whose ends lie as `at` says; 0 if nothing. */
static int clip(hr2di_obstacle *o, const hr2di_axis *line, unsigned bit, const int at[2]) {
  if (at[0] <= 0 && at[1] <= 0) return 0;
  const hr2d_point a = o->end[0].at, b = o->end[1].at;
  for (int k = 0; k < 2; k++) {
    if (at[k] > 0) continue;
    o->end[k].on |= bit;
    if (at[k] == 0) continue;
    o->end[k].at = k ? foot(b, a, line->a, line->b) : foot(a, b, line->a, line->b);
    o->end[k].on = bit;
    o->whole &= ~(1u << k);
  }
  return !hr2di_point_same(o->end[0].at, o->end[1].at);
}

/* The part of a segment in front of a line. */
static int clip_segment(hr2di_incident_point *p, hr2di_incident_point *q,
                        const hr2di_axis *line, unsigned bit) {
  const int at[2] = {hr2di_axis_front(line, p->at), hr2di_axis_front(line, q->at)};
  if (at[0] > 0 && at[1] > 0) return 1;
  hr2di_obstacle o = {.end = {*p, *q}, .whole = 3};
  const unsigned own = p->on & q->on;
  if (!clip(&o, line, bit, at)) return 0;
  *p = o.end[0];
  *q = o.end[1];
  p->on |= own;
  q->on |= own;
  return 1;
}

static hr2di_half_plane left_of(hr2d_point a, hr2d_point b) {
  const double nx = a.y - b.y, ny = b.x - a.x;
  /* Coordinates lie in [-2,2]: rounding errors are below 2^-50 of |nx| + |ny|, and what
     lies on a line is within 2^-49 of it. */
  return (hr2di_half_plane){nx, ny, -(nx * a.x + ny * a.y), 0x1p-47 * (fabs(nx) + fabs(ny))};
}

/* From p on one of i and j to q on the other.  Where they touch there is no side to be beyond
   of.  Where p and q are on one line, one of them is a foot and off by 2^-49 at most, and that
   line is off by 2^-49·(|pr| + |qr|)/|pq| at r. */
static hr2di_half_plane side_between(const hr2di_pair_lines *frame, hr2di_incident_point p,
                                     hr2di_incident_point q) {
  if (hr2di_incident_same(frame, p, q)) return (hr2di_half_plane){0, 0, 0, 0};
  hr2di_half_plane side = left_of(p.at, q.at);
  if (p.on & q.on) side.margin += 0x1p-45;
  return side;
}

/* fmin() and fmax() would be calls. */
static inline double lesser(double p, double q) {
  return p < q ? p : q;
}

static inline double greater(double p, double q) {
  return p > q ? p : q;
}

int hr2di_shaft_init(hr2di_shaft *s, hr2di_facing facing, hr2d_segment i, hr2d_segment j,
                     hr2d_segment line_i, hr2d_segment line_j) {
  if (facing == HR2DI_FACING_NONE) return 0;
  s->frame = (hr2di_pair_lines){hr2di_axis_of(line_i), hr2di_axis_of(line_j)};
  s->a = (hr2di_incident_point){i.a, HR2DI_ON_I};
  s->b = (hr2di_incident_point){i.b, HR2DI_ON_I};
  s->c = (hr2di_incident_point){j.a, HR2DI_ON_J};
  s->d = (hr2di_incident_point){j.b, HR2DI_ON_J};
  if (!clip_segment(&s->a, &s->b, &s->frame.j, HR2DI_ON_J) ||
      !clip_segment(&s->c, &s->d, &s->frame.i, HR2DI_ON_I))
    return 0;
  const hr2d_point a = s->a.at, b = s->b.at, c = s->c.at, d = s->d.at;
  s->x0 = lesser(lesser(a.x, b.x), lesser(c.x, d.x));
  s->x1 = greater(greater(a.x, b.x), greater(c.x, d.x));
  s->y0 = lesser(lesser(a.y, b.y), lesser(c.y, d.y));
  s->y1 = greater(greater(a.y, b.y), greater(c.y, d.y));
  s->side[0] = left_of(line_i.a, line_i.b);
  s->side[1] = left_of(line_j.a, line_j.b);
  s->side[2] = side_between(&s->frame, s->b, s->c);
  s->side[3] = side_between(&s->frame, s->d, s->a);
  return 1;
}

int hr2di_shaft_meets_box(const hr2di_shaft *shaft, double x0, double x1, double y0,
                          double y1) {
  if (x0 > shaft->x1 || x1 < shaft->x0 || y0 > shaft->y1 || y1 < shaft->y0) return 0;
  /* The sides between i and j keep out the most. */
  for (int k = 3; k >= 0; k--) {
    const hr2di_half_plane *s = &shaft->side[k];
    const double max = s->nx * (s->nx > 0 ? x1 : x0) + s->ny * (s->ny > 0 ? y1 : y0);
    if (max + s->offset < -s->margin) return 0;
  }
  return 1;
}

int hr2di_shaft_has_in_front(const hr2di_shaft *shaft, double x0, double x1, double y0,
                             double y1) {
  for (int k = 0; k < 2; k++) {
    const hr2di_half_plane *s = &shaft->side[k];
    const double min = s->nx * (s->nx > 0 ? x0 : x1) + s->ny * (s->ny > 0 ? y0 : y1);
    if (min + s->offset <= s->margin) return 0;
  }
  return 1;
}

static inline double value_at(const hr2di_half_plane *h, hr2d_point p) {
  return (h->nx * p.x + h->ny * p.y) + h->offset;
}

/* Both ends lie beyond the same edge of the box around the shaft. */
static inline int beyond_box(const hr2di_shaft *s, hr2d_segment w) {
  return (w.a.x > s->x1 && w.b.x > s->x1) || (w.a.x < s->x0 && w.b.x < s->x0) ||
         (w.a.y > s->y1 && w.b.y > s->y1) || (w.a.y < s->y0 && w.b.y < s->y0);
}

/* Where the ends of a wall lie to the half planes; 0 if both are beyond one for sure. */
static inline int evaluate(const hr2di_shaft *s, hr2d_segment w, double value[4][2]) {
  for (int k = 3; k >= 0; k--) {
    const hr2di_half_plane *h = &s->side[k];
    value[k][0] = value_at(h, w.a);
    value[k][1] = value_at(h, w.b);
    if ((value[k][0] < -h->margin) & (value[k][1] < -h->margin)) return 0;
  }
  return 1;
}

/* 1 and −1 where a value is certain, else 0. */
static inline int certain(double value, double margin) {
  return (value > margin) - (value < -margin);
}

static int is_near(hr2di_incident_point p, hr2di_incident_point corner) {
  const double near = 16 * HR2DI_TOUCH * largest(corner.at);
  return corner.on == HR2DI_ON_BOTH && fabs(p.at.x - corner.at.x) <= near &&
         fabs(p.at.y - corner.at.y) <= near;
}

/* In a wedge of a few roundings an end may lie on both lines but for a rounding, and far from
   where they meet: there it is between them, and blocks what its coordinates say. */
static void part(const hr2di_shaft *s, hr2di_incident_point *p) {
  if (p->on != HR2DI_ON_BOTH || is_near(*p, s->a) || is_near(*p, s->b) || is_near(*p, s->c) ||
      is_near(*p, s->d))
    return;
  if (hr2di_orient_sign(s->frame.i.a, s->frame.i.b, p->at) > 0 &&
      hr2di_orient_sign(s->frame.j.a, s->frame.j.b, p->at) > 0)
    p->on = 0;
}

static inline int clip_wall(const hr2di_shaft *s, double value[4][2], hr2di_obstacle *o) {
  const double at_i = lesser(value[0][0], value[0][1]), at_j = lesser(value[1][0], value[1][1]);
  if (at_i > s->side[0].margin && at_j > s->side[1].margin) return 1;
  for (int k = 0; k < 2; k++) {
    const hr2di_axis *line = k ? &s->frame.j : &s->frame.i;
    int at[2];
    for (int e = 0; e < 2; e++) {
      at[e] = o->whole & (1u << e) ? certain(value[k][e], s->side[k].margin) : 0;
      if (at[e] == 0) at[e] = hr2di_axis_front(line, o->end[e].at);
    }
    if ((at[0] <= 0 || at[1] <= 0) && !clip(o, line, 1u << k, at)) return 0;
  }
  for (int e = 0; e < 2; e++) {
    if (!o->end[e].on) continue;
    snap(&o->end[e], s->a);
    snap(&o->end[e], s->b);
    snap(&o->end[e], s->c);
    snap(&o->end[e], s->d);
    part(s, &o->end[e]);
  }
  return !hr2di_point_same(o->end[0].at, o->end[1].at);
}

/* Which ends of the obstacle are beyond the side k, p→q, of the shaft, or on it.  Where i
   and j touch, the side is a point. */
static inline unsigned beyond_side(const hr2di_shaft *s, const hr2di_obstacle *o, int k,
                                   double value[4][2], hr2di_incident_point p,
                                   hr2di_incident_point q) {
  const hr2di_half_plane *h = &s->side[k];
  const int point = h->margin == 0;
  unsigned beyond = 0;
  for (unsigned e = 0; e < 2; e++) {
    int sign = o->whole & (1u << e) ? certain(value[k][e], h->margin) : 0;
    if (point)
      sign = !hr2di_incident_same(&s->frame, o->end[e], p);
    else if (sign == 0)
      sign = hr2di_orient_incident(&s->frame, p, q, o->end[e]);
    beyond |= (unsigned)(sign <= 0) << e;
  }
  return beyond;
}

hr2di_in_way hr2di_shaft_test(const hr2di_shaft *s, hr2d_segment w, hr2di_obstacle *o) {
  double value[4][2];
  if (beyond_box(s, w) || !evaluate(s, w, value)) return HR2DI_ASIDE;
  *o = (hr2di_obstacle){.end = {{w.a, 0}, {w.b, 0}}, .whole = 3};
  if (!clip_wall(s, value, o)) return HR2DI_ASIDE;
  const unsigned right = beyond_side(s, o, 2, value, s->b, s->c);
  if (right == 3 && s->side[2].margin > 0) return HR2DI_ASIDE;
  const unsigned left = beyond_side(s, o, 3, value, s->d, s->a);
  if (left == 3 && s->side[3].margin > 0) return HR2DI_ASIDE;
  o->right = right;
  o->left = left;
  /* An end within the shaft is in the way, and does not span it. */
  for (unsigned e = 0; e < 2; e++)
    if (!o->end[e].on && !((right | left) & (1u << e))) return HR2DI_INSIDE;
  const hr2di_incident_point p = o->end[0], q = o->end[1];
  const int a = hr2di_orient_incident(&s->frame, p, q, s->a),
            b = hr2di_orient_incident(&s->frame, p, q, s->b);
  const int c = hr2di_orient_incident(&s->frame, p, q, s->c),
            d = hr2di_orient_incident(&s->frame, p, q, s->d);
  if ((a >= 0 && b >= 0 && c >= 0 && d >= 0) || (a <= 0 && b <= 0 && c <= 0 && d <= 0))
    return HR2DI_ASIDE;
  const int between =
      (a >= 0 && b >= 0 && c <= 0 && d <= 0) || (a <= 0 && b <= 0 && c >= 0 && d >= 0);
  return between && ((right & 1 && left & 2) || (right & 2 && left & 1)) ? HR2DI_ACROSS
                                                                         : HR2DI_INSIDE;
}
