/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orientation of points that lie on the line of i or of j. */
#include "geometry/orient-incident.h"

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
