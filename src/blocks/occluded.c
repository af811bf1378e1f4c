/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of pairs with walls in the way.

   A screen is the part of a wall that is in front of both elements.  From x it hides the part
   of j between the projections of its ends.  The points that bound the visible parts change
   only where x lies on a line through two ends of screens or of j.  Such lines cut i into
   cells.  In a cell the visible parts are smooth functions of x, except near their bounding
   points, near an x whose projection runs to infinity, and near the line of j.  Neighbouring
   cells with the same bounding points are joined. */
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "blocks/block.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* Fractions: parts of j narrower than this are dropped; cuts of i closer than this count as
   one. */
#define SLIVER 1e-14

/* Sine of the angle to i below which a point counts as on the line of i. */
#define FOOT 1e-15

/* Points 0 and 1 are the ends of the part of j in front of i; ends of screens follow. */
enum { START = 0, END = 1, FIRST = 2 };

typedef struct bound {
  double at;
  uint32_t point;
} bound;

/* The part of j that a screen hides. */
struct hr2di_shadow {
  bound low, high;
};
typedef struct hr2di_shadow shadow;

/* The visible parts by their bounding points. */
typedef struct signature {
  size_t parts;
  uint32_t low[HR2DI_PARTS], high[HR2DI_PARTS];
} signature;

typedef struct view {
  const hr2di_integrator *work;
  const hr2di_pair_frame *f;
  size_t points, screens;
  signature seen; /* of the cell under way */
} view;

/* How far a point is in front of the line of j. */
static double height(const hr2di_pair_frame *f, hr2d_point p) {
  return hr2di_point_cross(f->along_j, hr2di_point_minus(p, f->j.a)) / f->length_j;
}

/* Whether a point is on the line of i, within rounding.  Such a point is seen in the direction
   of i or in the opposite one: towards the start of j or towards its end. */
static int is_foot(const hr2di_pair_frame *f, hr2d_point p) {
  const hr2d_point from = hr2di_point_minus(p, f->i.a);
  const double size = fabs(from.x) + fabs(from.y) + f->length_i;
  return hr2di_point_cross(f->along_i, from) <= FOOT * f->length_i * size;
}

/* The place on the line of j where x sees a point, limited to the part of j in front of i. */
static bound project(const view *v, double s, uint32_t point) {
  const hr2di_pair_frame *f = v->f;
  const bound start = {f->front_j.from, START}, end = {f->front_j.to, END};
  if (point < FIRST) return point == START ? start : end;
  const hr2d_point x = hr2di_block_along(f->i.a, f->along_i, s), p = v->work->point[point];
  const hr2d_point direction = hr2di_point_minus(p, x);
  if (is_foot(f, p))
    return f->along_i.x * direction.x + f->along_i.y * direction.y > 0 ? start : end;
  if (hr2di_point_cross(hr2di_point_minus(v->work->point[START], x), direction) <= 0)
    return start;
  if (hr2di_point_cross(hr2di_point_minus(v->work->point[END], x), direction) >= 0) return end;
  const double t = hr2di_point_cross(hr2di_point_minus(f->j.a, x), direction) /
                   hr2di_point_cross(direction, f->along_j);
  return (bound){fmin(fmax(t, start.at), end.at), point};
}

static int by_low(const void *a, const void *b) {
  const shadow *p = a, *q = b;
  if (p->low.at != q->low.at) return p->low.at < q->low.at ? -1 : 1;
  return (p->low.point > q->low.point) - (p->low.point < q->low.point);
}

/* Appends the part of j between two bounds. */
static void append(signature *seen, bound low, bound high) {
  if (!(high.at - low.at > SLIVER) || seen->parts == HR2DI_PARTS) return;
  seen->low[seen->parts] = low.point;
  seen->high[seen->parts++] = high.point;
}

/* The parts of j between the shadows, as the point at s sees them. */
static hr2d_status look(const view *v, double s, signature *seen) {
  const hr2di_span front = v->f->front_j;
  shadow *shade = v->work->shadow;
  hr2di_watch *const watch = v->work->watch;
  hr2d_status status = hr2di_watch_work(watch, 1 + v->screens / 2);
  for (size_t k = 0; k < v->screens; k++) {
    const uint32_t *end = v->work->screen[k].end;
    const bound p = project(v, s, end[0]), q = project(v, s, end[1]);
    shade[k] = p.at <= q.at ? (shadow){p, q} : (shadow){q, p};
  }
  if (!status) status = hr2di_sort(shade, v->screens, sizeof *shade, by_low, watch);
  bound open = {front.from, START};
  seen->parts = 0;
  for (size_t k = 0; k < v->screens; k++) {
    append(seen, open, shade[k].low);
    if (shade[k].high.at > open.at) open = shade[k].high;
  }
  append(seen, open, (bound){front.to, END});
  return status;
}

static int alike(const signature *a, const signature *b) {
  const size_t bytes = a->parts * sizeof *a->low;
  return a->parts == b->parts && memcmp(a->low, b->low, bytes) == 0 &&
         memcmp(a->high, b->high, bytes) == 0;
}

static size_t see(const void *ctx, double s, hr2di_span *part) {
  const view *v = ctx;
  for (size_t k = 0; k < v->seen.parts; k++)
    part[k] = (hr2di_span){project(v, s, v->seen.low[k]).at, project(v, s, v->seen.high[k]).at};
  return v->seen.parts;
}

/* Returns the number of a point; adds the point if it is new. */
static uint32_t number(hr2di_integrator *w, size_t *points, hr2d_point p) {
  for (size_t k = FIRST; k < *points; k++)
    if (w->point[k].x == p.x && w->point[k].y == p.y) return (uint32_t)k;
  w->point[*points] = p;
  return (uint32_t)(*points)++;
}

/* Makes the screens, and all points that may bound a visible part. */
static hr2d_status make_screens(hr2di_integrator *w, const hr2di_shaft *shaft, view *v) {
  const hr2di_pair_frame *f = v->f;
  const size_t max = w->found.count;
  if (hr2di_alloc_reserve(&w->alloc, &w->screen, &w->screen_capacity, max, sizeof *w->screen) ||
      hr2di_alloc_reserve(&w->alloc, &w->point, &w->point_capacity, FIRST + 2 * max,
                          sizeof *w->point) ||
      hr2di_alloc_reserve(&w->alloc, &w->shadow, &w->shadow_capacity, max, sizeof *w->shadow))
    return HR2D_ENOMEM;
  w->point[START] = hr2di_block_along(f->j.a, f->along_j, f->front_j.from);
  w->point[END] = hr2di_block_along(f->j.a, f->along_j, f->front_j.to);
  v->points = FIRST;
  for (size_t k = 0; k < max; k++) {
    hr2di_obstacle o;
    const hr2d_segment wall = w->visibility->walls->wall[w->found.wall[k]].at;
    if (hr2di_shaft_test(shaft, wall, &o) == HR2DI_ASIDE) continue;
    const hr2d_status status = hr2di_watch_work(w->watch, 2 + v->points / 32);
    if (status) return status;
    w->screen[v->screens].end[0] = number(w, &v->points, o.end[0].at);
    w->screen[v->screens++].end[1] = number(w, &v->points, o.end[1].at);
  }
  return HR2D_OK;
}

static int rising(const void *a, const void *b) {
  const double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* Cuts i where it meets the lines through two points, at least one of them a screen's end. */
static hr2d_status make_cuts(hr2di_integrator *w, const view *v, size_t *cuts) {
  const hr2di_pair_frame *f = v->f;
  const size_t max = v->points * v->points + 2;
  if (hr2di_alloc_reserve(&w->alloc, &w->cut, &w->cut_capacity, max, sizeof *w->cut))
    return HR2D_ENOMEM;
  *cuts = 0;
  w->cut[(*cuts)++] = f->front_i.from;
  w->cut[(*cuts)++] = f->front_i.to;
  hr2d_status status = HR2D_OK;
  for (size_t k = FIRST; k < v->points && !status; k++) {
    status = hr2di_watch_work(w->watch, 1 + k / 8);
    for (size_t m = 0; m < k; m++) {
      const hr2d_point line = hr2di_point_minus(w->point[m], w->point[k]);
      const double at_a = hr2di_point_cross(line, hr2di_point_minus(f->i.a, w->point[k]));
      const double at_b = hr2di_point_cross(line, hr2di_point_minus(f->i.b, w->point[k]));
      const double s = at_a / (at_a - at_b);
      if (s > f->front_i.from && s < f->front_i.to) w->cut[(*cuts)++] = s;
    }
  }
  return status ? status : hr2di_sort(w->cut, *cuts, sizeof *w->cut, rising, w->watch);
}

/* The points where the integrand over the cell may be singular; returns their number, at most
   six for each visible part. */
static size_t find_singular(const view *v, hr2d_point *singular) {
  const hr2di_pair_frame *f = v->f;
  const double slope = f->above_j[1] - f->above_j[0];
  size_t count = 0;
  for (size_t k = 0; k < v->seen.parts; k++) {
    const uint32_t end[] = {v->seen.low[k], v->seen.high[k]};
    for (size_t m = 0; m < 2; m++) {
      const hr2d_point p = v->work->point[end[m]];
      singular[count++] = p;
      if (end[m] < FIRST || slope == 0) continue;
      singular[count++] =
          hr2di_block_along(f->i.a, f->along_i, (height(f, p) - f->above_j[0]) / slope);
      singular[count++] = hr2di_block_along(f->i.a, f->along_i, -f->above_j[0] / slope);
    }
  }
  return count;
}

static void add_cell(hr2di_integrator *w, view *v, hr2di_span cell, double *block) {
  hr2d_point singular[6 * HR2DI_PARTS];
  if (v->seen.parts == 0) return;
  const size_t count = find_singular(v, singular);
  const hr2di_strip strip = {cell, singular, count, see, v};
  hr2di_block_add_strip(w, v->f, &strip, block);
}

hr2d_status hr2di_block_occluded(hr2di_integrator *w, const hr2di_pair_frame *f,
                                 const hr2di_shaft *shaft, double *block) {
  view v = {.work = w, .f = f};
  size_t cuts = 0;
  hr2d_status status = make_screens(w, shaft, &v);
  if (!status) status = make_cuts(w, &v, &cuts);
  if (status) return status;
  double from = w->cut[0], last = from;
  for (size_t k = 1; k < cuts && !status; k++) {
    const double to = w->cut[k];
    signature seen;
    if (to - last <= SLIVER && k + 1 < cuts) continue;
    status = look(&v, 0.5 * (last + to), &seen);
    if (status) break;
    if (!alike(&seen, &v.seen)) {
      add_cell(w, &v, (hr2di_span){from, last}, block);
      from = last;
      v.seen = seen;
    }
    last = to;
  }
  if (!status) add_cell(w, &v, (hr2di_span){from, last}, block);
  return status ? status : hr2di_watch_status(w->watch);
}
