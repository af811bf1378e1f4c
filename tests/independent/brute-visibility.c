/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In the frame of i, i lies on the axis and everything else above it.  A point x of i sees j
   between two slopes (cotangents of directions), and each occluder hides an interval of
   slopes: an occluder in front of i and of j that meets a ray between their points lies
   between these points.  The ends of the intervals change their order only where a line
   through two ends meets i. */
#include "independent/brute-visibility.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdlib.h>

#include "independent/pair-frame.h"
#include "support/plane.h"

typedef struct interval {
  real low, high; /* slopes, (along − x)/height */
  const frame_point *at_low, *at_high;
} interval;

typedef struct view {
  real from, to;    /* the part of i in front of j */
  frame_point *end; /* j's two, then two per occluder */
  size_t ends;
  real *event;
  size_t events;
  interval *hidden; /* work space, one per occluder */
  interval *gap;    /* one more than that */
} view;

/* 0 if i and j do not face each other. */
static int open_view(view *v, const hr2d_segment *i, const hr2d_segment *j,
                     const hr2d_segment *occluder, size_t count) {
  *v = (view){.ends = 0};
  if (!frame_front(i, j, &v->from, &v->to)) return 0;
  v->end = malloc((2 * count + 2) * sizeof *v->end);
  v->hidden = malloc((count + 1) * sizeof *v->hidden);
  v->gap = malloc((count + 1) * sizeof *v->gap);
  frame_point *end = v->end;
  end[0] = frame_of(i, j, j->a);
  end[1] = frame_of(i, j, j->b);
  end[0].above = end[1].above = 1; /* on j's own line: not to be clipped there */
  if (!frame_clip(&end[0], &end[1], 1)) return 0;
  v->ends = 2;
  for (size_t k = 0; k < count; k++) {
    end[v->ends] = frame_of(i, j, occluder[k].a);
    end[v->ends + 1] = frame_of(i, j, occluder[k].b);
    if (frame_clip(&end[v->ends], &end[v->ends + 1], 1)) v->ends += 2;
  }
  v->event = malloc((v->ends * (v->ends + 1) / 2 + 2) * sizeof *v->event);
  v->events = frame_events(end, v->ends, v->from, v->to, 0, v->event);
  return 1;
}

static void close_view(view *v) {
  free(v->end);
  free(v->event);
  free(v->hidden);
  free(v->gap);
}

static interval seen_from(real x, const frame_point *p, const frame_point *q) {
  const real s = (p->along - x) / p->height, t = (q->along - x) / q->height;
  return s < t ? (interval){s, t, p, q} : (interval){t, s, q, p};
}

static int by_low(const void *left, const void *right) {
  const interval *l = left, *r = right;
  return (l->low > r->low) - (l->low < r->low);
}

/* What x sees of j: fills v->gap and returns how many gaps there are. */
static size_t find_gaps(view *v, real x) {
  const interval j = seen_from(x, &v->end[0], &v->end[1]);
  size_t hidden = 0, gaps = 0;
  for (size_t k = 2; k < v->ends; k += 2)
    v->hidden[hidden++] = seen_from(x, &v->end[k], &v->end[k + 1]);
  qsort(v->hidden, hidden, sizeof *v->hidden, by_low);
  interval gap = {.low = j.low, .at_low = j.at_low};
  for (size_t k = 0; k < hidden && v->hidden[k].low < j.high; k++) {
    const interval h = v->hidden[k];
    if (h.low > gap.low) {
      gap.high = h.low;
      gap.at_high = h.at_low;
      v->gap[gaps++] = gap;
    }
    if (h.high > gap.low) gap = (interval){.low = h.high, .at_low = h.at_high};
  }
  gap.high = j.high;
  gap.at_high = j.at_high;
  if (gap.low < j.high) v->gap[gaps++] = gap;
  return gaps;
}

/* ∫ sinθ dx from x0 to x1, where θ is the direction to v: |x₀v| − |x₁v|. */
static real strings(const frame_point *v, real x0, real x1) {
  const real from = v->along - x0, to = v->along - x1;
  return (x1 - x0) * (from + to) / (hypotl(from, v->height) + hypotl(to, v->height));
}

double brute_strings(const hr2d_segment *i, const hr2d_segment *j, const hr2d_segment *occluder,
                     size_t count) {
  view v;
  real sum = 0;
  if (open_view(&v, i, j, occluder, count))
    for (size_t e = 1; e < v.events; e++) {
      const real x0 = v.event[e - 1], x1 = v.event[e];
      if (!(x1 > x0)) continue;
      const size_t gaps = find_gaps(&v, x0 + (x1 - x0) / 2);
      for (size_t g = 0; g < gaps; g++)
        sum += (strings(v.gap[g].at_high, x0, x1) - strings(v.gap[g].at_low, x0, x1)) / 2;
    }
  close_view(&v);
  return (double)sum;
}

typedef struct piece {
  view *v;
  real from, to;
} piece;

/* sin t − sin s for the slopes' angles: the sine of a difference keeps small gaps. */
static real sine_difference(const interval *gap, real x) {
  const frame_point *p = gap->at_low, *q = gap->at_high;
  const real px = p->along - x, qx = q->along - x;
  const real lp = hypotl(px, p->height), lq = hypotl(qx, q->height);
  const real cross = qx * p->height - px * q->height, dot = px * qx + p->height * q->height;
  const real half = atan2l(cross, dot) / 2, cx = px / lp + qx / lq;
  const real cy = p->height / lp + q->height / lq;
  return 2 * sinl(half) * cy / hypotl(cx, cy);
}

/* ∫ G V dy, times the length of the piece. */
static double inner(double t, void *params) {
  piece *p = params;
  const real x = p->from + (p->to - p->from) * (real)t;
  const size_t gaps = find_gaps(p->v, x);
  real sum = 0;
  for (size_t g = 0; g < gaps; g++) sum += sine_difference(&p->v->gap[g], x) / 2;
  return (double)(sum * (p->to - p->from));
}

double brute_quadrature(const hr2d_segment *i, const hr2d_segment *j,
                        const hr2d_segment *occluder, size_t count, double *error) {
  enum { LIMIT = 100 };
  view v;
  real sum = 0;
  if (error) *error = 0;
  if (open_view(&v, i, j, occluder, count)) {
    /* What GSL says of rounding is in its estimate, too. */
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(LIMIT);
    for (size_t e = 1; e < v.events; e++) {
      piece p = {&v, v.event[e - 1], v.event[e]};
      gsl_function f = {inner, &p};
      double value = 0, estimate = 0;
      if (!(p.to > p.from)) continue;
      gsl_integration_qag(&f, 0, 1, 0, 1e-13, LIMIT, GSL_INTEG_GAUSS21, space, &value,
                          &estimate);
      sum += value;
      if (error) *error += estimate;
    }
    gsl_integration_workspace_free(space);
    gsl_set_error_handler(handler);
  }
  close_view(&v);
  return (double)sum;
}

double brute_lines(const hr2d_segment *i, const hr2d_segment *j, const hr2d_segment *occluder,
                   size_t count, randoms *r, int lines, double *sigma) {
  const double ix = i->b.x - i->a.x, iy = i->b.y - i->a.y, length = hypot(ix, iy);
  const double jx = j->b.x - j->a.x, jy = j->b.y - j->a.y;
  int through = 0;
  for (int k = 0; k < lines; k++) {
    /* dx dsinθ / 2 is the measure of lines: sinθ is uniform in (−1,1). */
    const double t = random_unit(r), s = random_between(r, -1, 1), c = sqrt(1 - s * s);
    hr2d_point x = {i->a.x + t * ix, i->a.y + t * iy};
    const double ux = (s * ix - c * iy) / length, uy = (s * iy + c * ix) / length;
    const double facing = ux * jy - uy * jx;
    const double at = (ux * (x.y - j->a.y) - uy * (x.x - j->a.x)) / facing;
    const double far = (jx * (x.y - j->a.y) - jy * (x.x - j->a.x)) / facing;
    if (!(facing > 0) || !(at > 0 && at < 1) || !(far > 0)) continue;
    /* Occluders along i or j hide nothing, whatever the rounding of x and y; the margin
       keeps them out. */
    const double margin = 1e-9 * far;
    const hr2d_point y = {j->a.x + at * jx - margin * ux, j->a.y + at * jy - margin * uy};
    x = (hr2d_point){x.x + margin * ux, x.y + margin * uy};
    size_t w = 0;
    while (w < count && !plane_crosses(occluder[w], x, y)) w++;
    through += w == count;
  }
  const double part = (double)through / lines;
  *sigma = length * sqrt((part + 1.0 / lines) * (1 - part) / lines);
  return length * part;
}
