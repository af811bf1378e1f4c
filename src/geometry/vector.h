/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points as vectors, in plain doubles. */
#ifndef HR2D_SRC_GEOMETRY_VECTOR_H
#define HR2D_SRC_GEOMETRY_VECTOR_H

#include <hr2d/geometry.h>
#include <math.h>

static inline int hr2di_point_same(hr2d_point p, hr2d_point q) {
  return p.x == q.x && p.y == q.y;
}

/* By x, then by y; 0 for the same point. */
static inline int hr2di_point_order(hr2d_point p, hr2d_point q) {
  if (p.x != q.x) return p.x < q.x ? -1 : 1;
  return (p.y > q.y) - (p.y < q.y);
}

/* p − q */
static inline hr2d_point hr2di_point_minus(hr2d_point p, hr2d_point q) {
  return (hr2d_point){p.x - q.x, p.y - q.y};
}

static inline double hr2di_point_dot(hr2d_point u, hr2d_point v) {
  return u.x * v.x + u.y * v.y;
}

static inline double hr2di_point_cross(hr2d_point u, hr2d_point v) {
  return u.x * v.y - u.y * v.x;
}

/* v with the length 1, however short or long it is; (0, 0) stays. */
static inline hr2d_point hr2di_point_unit(hr2d_point v) {
  const double larger = fmax(fabs(v.x), fabs(v.y));
  if (!(larger > 0)) return v;
  const hr2d_point u = {v.x / larger, v.y / larger};
  const double length = sqrt(hr2di_point_dot(u, u));
  return (hr2d_point){u.x / length, u.y / length};
}

/* The point at the fraction t of a segment, from the end that is nearer: exactly on a line
   along an axis. */
static inline hr2d_point hr2di_point_at(hr2d_segment s, double t) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y, u = 1 - t;
  return t > 0.5 ? (hr2d_point){s.b.x - u * dx, s.b.y - u * dy}
                 : (hr2d_point){s.a.x + t * dx, s.a.y + t * dy};
}

/* A coordinate of p, or its negative, that grows from s.a to s.b: it orders points on the line
   of s. */
static inline double hr2di_point_along(hr2d_segment s, hr2d_point p) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  if (fabs(dx) >= fabs(dy)) return dx > 0 ? p.x : -p.x;
  return dy > 0 ? p.y : -p.y;
}

/* Whether p is between the ends of t along the line of s; without rounding. */
static inline int hr2di_point_between(hr2d_segment s, hr2d_segment t, hr2d_point p) {
  const double a = hr2di_point_along(s, t.a), b = hr2di_point_along(s, t.b);
  const double at = hr2di_point_along(s, p);
  return fmin(a, b) < at && at < fmax(a, b);
}

#endif
