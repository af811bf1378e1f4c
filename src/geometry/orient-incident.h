/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points about a pair of segments, and the turns they make.

   Feet of walls, clipped ends, midpoints and rounded T-junctions lie on the line of i or
   of j but for rounding, and among points on one line rounding would decide.  So each
   point knows on which of the two lines it lies; two on a line and a third in front of it
   turn as their order on the line says, and three on a line do not turn. */
#ifndef HR2D_SRC_GEOMETRY_ORIENT_INCIDENT_H
#define HR2D_SRC_GEOMETRY_ORIENT_INCIDENT_H

#include <hr2d/geometry.h>

#include "geometry/orient-sign.h"

enum { HR2DI_ON_I = 1, HR2DI_ON_J = 2, HR2DI_ON_BOTH = 3 };

typedef struct hr2di_incident_point {
  hr2d_point at;
  unsigned on; /* lines on which it lies; it is in front of the other */
} hr2di_incident_point;

/* A line, with its front on the left, and the coordinate that grows along it. */
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

/* How q lies to p along a line: 1 ahead, −1 behind. */
static inline int hr2di_axis_order(const hr2di_axis *axis, hr2d_point p, hr2d_point q) {
  return hr2di_sign_of(axis->direction * (axis->by_x ? q.x - p.x : q.y - p.y));
}

/* Both lie where the two lines meet. */
static inline int hr2di_incident_corners(hr2di_incident_point p, hr2di_incident_point q) {
  return (p.on & q.on) == HR2DI_ON_BOTH;
}

/* The turn of points of which two lie on one line. */
int hr2di_orient_incident_on_line(const hr2di_pair_lines *frame, const hr2di_incident_point *p,
                                  const hr2di_incident_point *q, const hr2di_incident_point *r);

/* 1 if p, q, r turn left, −1 right, 0 if they lie on one line. */
static inline int hr2di_orient_incident(const hr2di_pair_lines *frame, hr2di_incident_point p,
                                        hr2di_incident_point q, hr2di_incident_point r) {
  if ((p.on & q.on) | (q.on & r.on) | (r.on & p.on))
    return hr2di_orient_incident_on_line(frame, &p, &q, &r);
  return hr2di_orient_sign(p.at, q.at, r.at);
}

/* One place, but for rounding across a line. */
static inline int hr2di_incident_same(const hr2di_pair_lines *frame, hr2di_incident_point p,
                                      hr2di_incident_point q) {
  if (hr2di_point_same(p.at, q.at) || hr2di_incident_corners(p, q)) return 1;
  const unsigned both = p.on & q.on;
  if (both & HR2DI_ON_I) return hr2di_axis_order(&frame->i, p.at, q.at) == 0;
  return both & HR2DI_ON_J ? hr2di_axis_order(&frame->j, p.at, q.at) == 0 : 0;
}

/* For three points on one line: whether p lies ahead of `from` on the way to `to` (1), at
   it (0), or behind it (−1). */
static inline int hr2di_incident_ahead(const hr2di_pair_lines *frame, hr2di_incident_point from,
                                       hr2di_incident_point to, hr2di_incident_point p) {
  const unsigned all = from.on & to.on & p.on;
  const hr2di_axis axis = all & HR2DI_ON_I   ? frame->i
                          : all & HR2DI_ON_J ? frame->j
                                             : hr2di_axis_of((hr2d_segment){from.at, to.at});
  return hr2di_axis_order(&axis, from.at, to.at) * hr2di_axis_order(&axis, from.at, p.at);
}

#endif
