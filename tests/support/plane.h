/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points and segments in plain doubles, as textbooks compute with them. */
#ifndef HR2D_TESTS_SUPPORT_PLANE_H
#define HR2D_TESTS_SUPPORT_PLANE_H

#include <hr2d/geometry.h>
#include <math.h>

static inline int plane_same(hr2d_point p, hr2d_point q) {
  return p.x == q.x && p.y == q.y;
}

static inline double plane_distance(hr2d_point p, hr2d_point q) {
  return hypot(q.x - p.x, q.y - p.y);
}

static inline double plane_length(hr2d_segment s) {
  return plane_distance(s.a, s.b);
}

/* a + t (b − a) */
static inline hr2d_point plane_along(hr2d_segment s, double t) {
  return (hr2d_point){s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
}

/* ½ (a + b) */
static inline hr2d_point plane_middle(hr2d_segment s) {
  return (hr2d_point){0.5 * (s.a.x + s.b.x), 0.5 * (s.a.y + s.b.y)};
}

static inline hr2d_point plane_polar(hr2d_point from, double length, double angle) {
  return (hr2d_point){from.x + length * cos(angle), from.y + length * sin(angle)};
}

/* (b − a) × (p − a): positive if p lies to the left of the line through a and b. */
static inline double plane_det(hr2d_point a, hr2d_point b, hr2d_point p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/* Whether the open segments w and xy cross. */
static inline int plane_crosses(hr2d_segment w, hr2d_point x, hr2d_point y) {
  return plane_det(x, y, w.a) * plane_det(x, y, w.b) < 0 &&
         plane_det(w.a, w.b, x) * plane_det(w.a, w.b, y) < 0;
}

/* The part of s to the left of `by`; a point if there is none. */
static inline hr2d_segment plane_clipped(hr2d_segment s, hr2d_segment by) {
  const double ha = plane_det(by.a, by.b, s.a), hb = plane_det(by.a, by.b, s.b);
  const hr2d_point at = plane_along(s, ha / (ha - hb));
  if (ha <= 0 && hb <= 0) return (hr2d_segment){s.a, s.a};
  return (hr2d_segment){ha < 0 ? at : s.a, hb < 0 ? at : s.b};
}

#endif
