/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points around a pair of segments i and j, and how three of them turn: left, right or not.

   Points where walls meet the line of i or of j, clipped ends, midpoints and rounded
   T-junctions lie on that line only up to rounding, and rounding would decide how points on
   one line turn.  So each point records on which of the two lines it lies.  If two points lie
   on a line and the third in front of it, the order of the two on the line decides the turn.
   Three points on one line do not turn. */
#ifndef HR2D_SRC_GEOMETRY_ORIENT_INCIDENT_H
#define HR2D_SRC_GEOMETRY_ORIENT_INCIDENT_H

#include <hr2d/geometry.h>

#include "geometry/orient-sign.h"

enum { HR2DI_ON_I = 1, HR2DI_ON_J = 2, HR2DI_ON_BOTH = 3 };

typedef struct hr2di_incident_point {
  hr2d_point at;
  unsigned on; /* HR2DI_ON_…: the lines on which it lies; it is in front of the others */
} hr2di_incident_point;

/* A line with its front on the left, and the coordinate (x if by_x) that orders its points:
   it grows along the line if `direction` is 1 and falls if it is −1. */
typedef struct hr2di_axis {
  hr2d_point a, b;
  int by_x;
  double direction;
} hr2di_axis;

typedef struct hr2di_pair_lines {
  hr2di_axis i, j;
} hr2di_pair_lines;

static inline hr2di_axis hr2di_axis_of(hr2d_segment s) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  const int by_x = fabs(dx) >= fabs(dy);
  return (hr2di_axis){s.a, s.b, by_x, (by_x ? dx : dy) > 0 ? 1 : -1};
}

/* Where q lies from p along a line: 1 ahead, −1 behind, 0 at p. */
static inline int hr2di_axis_order(const hr2di_axis *axis, hr2d_point p, hr2d_point q) {
  return hr2di_sign_of(axis->direction * (axis->by_x ? q.x - p.x : q.y - p.y));
}

/* hr2di_axis_front() for a point near the line. */
int hr2di_axis_front_of_near(const hr2di_axis *line, hr2d_point p);

/* 1 if p is in front of a line, −1 if behind, 0 if on it within a few units in the last place.
   Coordinates lie in [-2,2], so that what lies on a line is within 2^-49 of it, and the
   rounding error of `value` is below 2^-50 of |dx| + |dy|. */
static inline int hr2di_axis_front(const hr2di_axis *line, hr2d_point p) {
  const double dx = line->b.x - line->a.x, dy = line->b.y - line->a.y;
  const double value = dx * (p.y - line->a.y) - dy * (p.x - line->a.x);
  const double margin = 0x1p-47 * (fabs(dx) + fabs(dy));
  return value > margin ? 1 : value < -margin ? -1 : hr2di_axis_front_of_near(line, p);
}

/* Whether both points lie where the two lines meet. */
static inline int hr2di_incident_corners(hr2di_incident_point p, hr2di_incident_point q) {
  return (p.on & q.on) == HR2DI_ON_BOTH;
}

/* hr2di_orient_incident() if at least two of the points lie on one of the lines. */
int hr2di_orient_incident_on_line(const hr2di_pair_lines *frame, const hr2di_incident_point *p,
                                  const hr2di_incident_point *q, const hr2di_incident_point *r);

/* 1 if p, q, r turn left, −1 right, 0 if they lie on one line. */
static inline int hr2di_orient_incident(const hr2di_pair_lines *frame, hr2di_incident_point p,
                                        hr2di_incident_point q, hr2di_incident_point r) {
  if ((p.on & q.on) | (q.on & r.on) | (r.on & p.on))
    return hr2di_orient_incident_on_line(frame, &p, &q, &r);
  return hr2di_orient_sign(p.at, q.at, r.at);
}

/* Whether two points are one place, up to rounding across a line. */
static inline int hr2di_incident_same(const hr2di_pair_lines *frame, hr2di_incident_point p,
                                      hr2di_incident_point q) {
  if (hr2di_point_same(p.at, q.at) || hr2di_incident_corners(p, q)) return 1;
  const unsigned both = p.on & q.on;
  if (both & HR2DI_ON_I) return hr2di_axis_order(&frame->i, p.at, q.at) == 0;
  return both & HR2DI_ON_J ? hr2di_axis_order(&frame->j, p.at, q.at) == 0 : 0;
}

#endif
