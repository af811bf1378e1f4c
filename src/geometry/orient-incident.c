/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Turns of points that lie on the line of i or of j. */
#include "geometry/orient-incident.h"

/* Two of the three lie on one line. */
static int turn_on_line(const hr2di_axis *axis, unsigned bit, hr2di_mark p, hr2di_mark q,
                        hr2di_mark r) {
  if (!(p.on & bit)) return hr2di_order(axis, q.at, r.at);
  if (!(q.on & bit)) return hr2di_order(axis, r.at, p.at);
  return hr2di_order(axis, p.at, q.at);
}

int hr2di_turn_marked(const hr2di_frame *frame, const hr2di_mark *p, const hr2di_mark *q,
                      const hr2di_mark *r) {
  const unsigned pairs = (p->on & q->on) | (q->on & r->on) | (r->on & p->on);
  if (p->on & q->on & r->on || hr2di_corners(*p, *q) || hr2di_corners(*q, *r) ||
      hr2di_corners(*r, *p))
    return 0;
  return pairs & HR2DI_ON_I ? turn_on_line(&frame->i, HR2DI_ON_I, *p, *q, *r)
                            : turn_on_line(&frame->j, HR2DI_ON_J, *p, *q, *r);
}
