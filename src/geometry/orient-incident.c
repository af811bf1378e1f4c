/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orientation of points that lie on the line of i or of j. */
#include "geometry/orient-incident.h"

#include "geometry/crossings.h"
#include "geometry/predicates.h"

static double largest(hr2d_point p) {
  return fmax(fabs(p.x), fabs(p.y));
}

int hr2di_axis_front_of_near(const hr2di_axis *line, hr2d_point p) {
  const int side = hr2di_orient_sign(line->a, line->b, p);
  if (side == 0) return 0;
  const double size = fmax(largest(p), fmax(largest(line->a), largest(line->b)));
  const hr2d_segment s = {line->a, line->b};
  return hr2di_crossings_distance(p, &s) <= HR2DI_TOUCH * size ? 0 : side;
}

/* Two of the three points lie on the line of `bit`; their order on it decides. */
static int turn_on_line(const hr2di_axis *axis, unsigned bit, hr2di_incident_point p,
                        hr2di_incident_point q, hr2di_incident_point r) {
  if (!(p.on & bit)) return hr2di_axis_order(axis, q.at, r.at);
  if (!(q.on & bit)) return hr2di_axis_order(axis, r.at, p.at);
  return hr2di_axis_order(axis, p.at, q.at);
}

int hr2di_orient_incident_on_line(const hr2di_pair_lines *frame, const hr2di_incident_point *p,
                                  const hr2di_incident_point *q,
                                  const hr2di_incident_point *r) {
  const unsigned pairs = (p->on & q->on) | (q->on & r->on) | (r->on & p->on);
  if (p->on & q->on & r->on || hr2di_incident_corners(*p, *q) ||
      hr2di_incident_corners(*q, *r) || hr2di_incident_corners(*r, *p))
    return 0;
  return pairs & HR2DI_ON_I ? turn_on_line(&frame->i, HR2DI_ON_I, *p, *q, *r)
                            : turn_on_line(&frame->j, HR2DI_ON_J, *p, *q, *r);
}
