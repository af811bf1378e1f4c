/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "independent/pair-frame.h"

#include <math.h>
#include <stdlib.h>

#include "independent/mpfr-exchange.h"
#include "support/order.h"

/* Twice the area of a, b, p. */
static real area_of(hr2d_point a, hr2d_point b, hr2d_point p) {
  mpfr_t det;
  mpfr_init2(det, MPFR_PREC_MIN);
  mpfr_orient(det, a, b, p);
  const real area = mpfr_get_ld(det, MPFR_RNDN);
  mpfr_clear(det);
  return area == 0 ? 0 : area; /* slopes are divided by it: no −0 */
}

frame_point frame_of(const hr2d_segment *i, const hr2d_segment *j, hr2d_point p) {
  const real x = (real)i->b.x - i->a.x, y = (real)i->b.y - i->a.y, length = hypotl(x, y);
  return (frame_point){(x * ((real)p.x - i->a.x) + y * ((real)p.y - i->a.y)) / length,
                       area_of(i->a, i->b, p) / length, area_of(j->a, j->b, p)};
}

frame_point frame_between(frame_point p, frame_point q, real t) {
  return (frame_point){p.along + t * (q.along - p.along), p.height + t * (q.height - p.height),
                       p.above + t * (q.above - p.above)};
}

int frame_clip(frame_point *p, frame_point *q, int both) {
  if (fmaxl(p->height, q->height) <= 0) return 0;
  frame_point *low = p->height < q->height ? p : q;
  if (low->height < 0) {
    *low = frame_between(*p, *q, p->height / (p->height - q->height));
    low->height = 0;
  }
  if (!both) return 1;
  if (fmaxl(p->above, q->above) <= 0) return 0;
  low = p->above < q->above ? p : q;
  if (low->above < 0) {
    *low = frame_between(*p, *q, p->above / (p->above - q->above));
    low->above = 0;
  }
  return fmaxl(p->height, q->height) > 0 && fmaxl(p->above, q->above) > 0;
}

int frame_front(const hr2d_segment *i, const hr2d_segment *j, real *from, real *to) {
  const frame_point a = frame_of(i, j, i->a), b = frame_of(i, j, i->b);
  const real cut = b.along * a.above / (a.above - b.above);
  *from = a.above < 0 ? cut : 0;
  *to = b.above < 0 ? cut : b.along;
  return a.above > 0 || b.above > 0;
}

size_t frame_events(const frame_point *end, size_t ends, real from, real to, int feet,
                    real *place) {
  size_t count = 0;
  for (size_t k = 0; k < ends; k++) {
    const frame_point p = end[k];
    place[count] = p.along;
    count += (feet || p.height == 0) && from < p.along && p.along < to;
    for (size_t m = 0; m < k; m++) {
      const frame_point q = end[m];
      if (p.height == q.height) continue;
      const real x = p.along - p.height * (q.along - p.along) / (q.height - p.height);
      place[count] = x;
      count += from < x && x < to;
    }
  }
  place[count++] = from;
  place[count++] = to;
  qsort(place, count, sizeof *place, order_long_doubles);
  return count;
}
