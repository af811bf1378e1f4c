/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines that separate two convex chains: whether there are any, and their measure.

   As a point x runs along i from a to b, its view through the corridor lies between two
   vertices, one of each chain, at which the chains are seen.  They change where the
   line of an edge meets i.  Between two changes, at x0 and x1, the lines are those from
   x0→x1 to the segment between the two vertices, so that the measure is a sum of
   unoccluded exchange areas.  At such a change the view is the same by either vertex:
   an error of δ in its place changes the sum by O(δ²). */
#include "occlusion/corridor.h"

#include <string.h>

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "geometry/predicates.h"

/* With fewer points, what is done is part of what callers declare. */
enum { FEW = 16 };

hr2d_status hr2di_chain_init(hr2di_chain *chain, const hr2d_allocator *alloc,
                             hr2di_incident_point from, hr2di_incident_point to) {
  if (hr2di_alloc_reserve(alloc, &chain->point, &chain->capacity, 2, sizeof from))
    return HR2D_ENOMEM;
  chain->point[0] = from;
  chain->point[1] = to;
  chain->count = 2;
  return HR2D_OK;
}

/* Puts p in place of the points [first, last). */
static hr2d_status splice(hr2di_chain *chain, const hr2d_allocator *alloc, size_t first,
                          size_t last, hr2di_incident_point p) {
  if (first == last && hr2di_alloc_reserve(alloc, &chain->point, &chain->capacity,
                                           chain->count + 1, sizeof *chain->point))
    return HR2D_ENOMEM;
  hr2di_incident_point *point = chain->point;
  memmove(point + first + 1, point + last, (chain->count - last) * sizeof *point);
  point[first] = p;
  chain->count -= last - first;
  chain->count++;
  return HR2D_OK;
}

static hr2di_incident_point knowing(hr2di_incident_point p, unsigned known) {
  p.on &= known;
  return p;
}

/* Whether p lengthens a chain that is a segment, there and back, or a point: no edge of it
   sees a point on its own line.  That is so where i and j touch, or one ends on the line
   of the other. */
static int lengthens(const hr2di_pair_lines *frame, const hr2di_chain *chain,
                     hr2di_incident_point p) {
  const hr2di_incident_point *at = chain->point;
  if (hr2di_incident_same(frame, at[0], p) || hr2di_incident_same(frame, at[1], p)) return 0;
  if (chain->count == 2 && hr2di_incident_same(frame, at[0], at[1])) return 1;
  const int flat =
      chain->count == 2 ||
      (chain->count == 3 && hr2di_orient_incident(frame, at[0], at[1], at[2]) == 0);
  if (!flat || hr2di_orient_incident(frame, at[0], at[1], p) != 0) return 0;
  /* beyond the tip, or before the start of a segment that has none yet */
  return hr2di_incident_ahead(frame, at[1], at[0], p) < 0 ||
         (chain->count == 2 && hr2di_incident_ahead(frame, at[0], at[1], p) < 0);
}

/* Whether an edge has p on its outer side. */
static int sees(const hr2di_pair_lines *frame, const hr2di_chain *chain, size_t edge,
                hr2di_incident_point p, unsigned known) {
  const hr2di_incident_point *at = chain->point + edge;
  return chain->hand * hr2di_orient_incident(frame, knowing(at[0], known),
                                             knowing(at[1], known), knowing(p, known)) >
         0;
}

/* The edges that see p are contiguous; p replaces what is between their outer ends. */
static hr2d_status add_point(hr2di_chain *chain, const hr2d_allocator *alloc,
                             const hr2di_pair_lines *frame, unsigned known,
                             hr2di_incident_point p, int *grown) {
  const size_t edges = chain->count - 1;
  size_t first = 0, last;
  const hr2d_status status = edges < FEW ? HR2D_OK : hr2di_watch_work(chain->watch, edges / 4);
  if (status) return status;
  while (first < edges && !sees(frame, chain, first, p, known)) first++;
  if (first == edges) {
    if (!lengthens(frame, chain, p)) return HR2D_OK;
    *grown = 1;
    return splice(chain, alloc, 1, edges, p);
  }
  last = first + 1;
  while (last < edges && sees(frame, chain, last, p, known)) last++;
  *grown = 1;
  return splice(chain, alloc, first + 1, last, p);
}

hr2d_status hr2di_chain_add(hr2di_chain *chain, const hr2d_allocator *alloc,
                            const hr2di_pair_lines *frame, unsigned known,
                            const hr2di_incident_point *point, size_t count, int *grown) {
  hr2d_status status = hr2di_watch_work(chain->watch, count);
  *grown = 0;
  for (size_t k = 0; k < count && !status; k++)
    status = add_point(chain, alloc, frame, known, point[k], grown);
  return status;
}

int hr2di_chain_sound(const hr2di_pair_lines *frame, const hr2di_chain *chain) {
  size_t marked = 0;
  for (size_t k = 1; k + 1 < chain->count; k++) marked += chain->point[k].on != 0;
  if (marked == 0 || chain->count < 4) return 1;
  for (size_t edge = 0; edge + 1 < chain->count; edge++) {
    if (hr2di_watch_work(chain->watch, 1 + chain->count / 4)) return 1;
    for (size_t k = 0; k < chain->count; k++)
      if (sees(frame, chain, edge, chain->point[k], HR2DI_ON_BOTH)) return 0;
  }
  return 1;
}

/* The search of bridge() with what points know of the lines they lie on, or, `known` = 0,
   without.  −1 where it does not end. */
static int search(const hr2di_pair_lines *frame, const hr2di_chain *low,
                  const hr2di_chain *high, unsigned known, size_t *from, size_t *to) {
  const int hand = high->hand;
  hr2di_incident_point f = low->point[*from], t = high->point[*to];
  f.on &= known;
  t.on &= known;
  for (size_t turns = low->count + high->count + 2; turns > 0; turns--) {
    int moved = 0;
    const size_t points = low->count + high->count;
    if (points >= FEW && hr2di_watch_work(low->watch, points / 4)) return 0;
    if (hr2di_incident_same(frame, f, t)) return 0;
    for (size_t k = 0; k < high->count; k++) {
      const hr2di_incident_point p = {high->point[k].at, high->point[k].on & known};
      const int side = hand * hr2di_orient_incident(frame, f, t, p);
      if (side < 0 || (side == 0 && hr2di_incident_ahead(frame, t, f, p) <= 0)) continue;
      if (side == 0 && hr2di_incident_ahead(frame, f, t, p) <= 0) return 0;
      moved |= side;
      t = p;
      *to = k;
    }
    for (size_t k = 0; k < low->count; k++) {
      const hr2di_incident_point p = {low->point[k].at, low->point[k].on & known};
      const int side = -hand * hr2di_orient_incident(frame, f, t, p);
      if (side < 0 || (side == 0 && hr2di_incident_ahead(frame, f, t, p) <= 0)) continue;
      if (side == 0 && hr2di_incident_ahead(frame, t, f, p) <= 0) return 0;
      moved |= side;
      f = p;
      *from = k;
    }
    if (!moved) return 1;
  }
  return -1;
}

/* The line that has `low` and `high` on their sides and touches each, from vertex *from
   of `low` to vertex *to of `high`, the nearest to each other.  Starting with the given
   vertices each chain in turn moves the line, and always turns it the same way, so that
   it is found after at most as many turns as there are vertices, or there is none.

   Unless two points on the line of i or j are a rounding apart and a third is in line with
   them: what they know of that line and where they are may then make the search go round
   in a circle.  Where they are never does. */
static int bridge(const hr2di_pair_lines *frame, const hr2di_chain *low,
                  const hr2di_chain *high, size_t *from, size_t *to) {
  const size_t start[] = {*from, *to};
  int found = search(frame, low, high, HR2DI_ON_BOTH, from, to);
  if (found >= 0) return found;
  *from = start[0];
  *to = start[1];
  return search(frame, low, high, 0, from, to) > 0;
}

static hr2di_corridor widest(const hr2di_chain *right, const hr2di_chain *left) {
  return (hr2di_corridor){0, right->count - 1, 0, left->count - 1};
}

static int find_first(const hr2di_pair_lines *frame, const hr2di_chain *right,
                      const hr2di_chain *left, hr2di_corridor *c) {
  return bridge(frame, left, right, &c->left_first, &c->right_last);
}

/* After find_first().  Where i and j touch within a rounding, their ends there are one place,
   and have no order: the last line may touch one that comes before that of the first line. */
static int find_last(const hr2di_pair_lines *frame, const hr2di_chain *right,
                     const hr2di_chain *left, hr2di_corridor *c) {
  if (!bridge(frame, right, left, &c->right_first, &c->left_last)) return 0;
  if (c->right_first > c->right_last) c->right_first = c->right_last;
  if (c->left_last < c->left_first) c->left_last = c->left_first;
  return 1;
}

int hr2di_corridor_open(const hr2di_pair_lines *frame, const hr2di_chain *right,
                        const hr2di_chain *left) {
  hr2di_corridor c = widest(right, left);
  return find_first(frame, right, left, &c);
}

int hr2di_corridor_find(const hr2di_pair_lines *frame, const hr2di_chain *right,
                        const hr2di_chain *left, hr2di_corridor *c) {
  *c = widest(right, left);
  return find_first(frame, right, left, c) && find_last(frame, right, left, c);
}

/* orient(p,q,r), rounded; 0 where that leaves few digits. */
static double cross(hr2d_point p, hr2d_point q, hr2d_point r) {
  const double u = (q.x - p.x) * (r.y - p.y), v = (q.y - p.y) * (r.x - p.x);
  const double det = u - v;
  return fabs(det) > 0x1p-30 * (fabs(u) + fabs(v)) + 0x1p-900 ? det : 0;
}

/* Where a point on the line of i lies, as a fraction of i. */
static double fraction_at(hr2d_segment i, hr2d_point p) {
  const double dx = i.b.x - i.a.x, dy = i.b.y - i.a.y;
  return fabs(dx) >= fabs(dy) ? (p.x - i.a.x) / dx : (p.y - i.a.y) / dy;
}

static int is_flat(hr2d_point p, hr2d_point q, hr2d_segment i) {
  const double ux = q.x - p.x, uy = q.y - p.y, vx = i.b.x - i.a.x, vy = i.b.y - i.a.y;
  return fabs(ux * vy - uy * vx) < 0x1p-5 * (fabs(ux) + fabs(uy)) * (fabs(vx) + fabs(vy));
}

/* Where the line of an edge meets i, as a fraction of i and not before `least`.  A flat edge
   with an end on i, but for a rounding h, is taken to meet it there, which at an angle φ costs
   hφ; to the point where it does, h/φ further, nothing would be seen past that end. */
static double crossing(hr2di_incident_point from, hr2di_incident_point to, hr2d_segment i,
                       double least) {
  const hr2d_point p = from.at, q = to.at;
  if (from.on & to.on & HR2DI_ON_I || hr2di_point_same(p, i.a) || hr2di_point_same(q, i.a))
    return least;
  if (hr2di_point_same(p, i.b) || hr2di_point_same(q, i.b)) return 1;
  double t;
  if ((from.on | to.on) & HR2DI_ON_I && is_flat(p, q, i)) {
    t = fraction_at(i, from.on & HR2DI_ON_I ? p : q);
  } else {
    const double a = cross(p, q, i.a), b = cross(p, q, i.b);
    t = a != 0 && b != 0 ? a / (a - b) : hr2di_line_crossing(p, q, i.a, i.b);
  }
  return t > least ? fmin(t, 1) : least;
}

static hr2d_point point_at(hr2d_segment i, double t) {
  const double u = t > 0.5 ? t - 1 : t;
  const hr2d_point from = t > 0.5 ? i.b : i.a;
  return (hr2d_point){from.x + u * (i.b.x - i.a.x), from.y + u * (i.b.y - i.a.y)};
}

int hr2di_corridor_area(const hr2di_pair_lines *frame, const hr2di_chain *right,
                        const hr2di_chain *left, hr2d_segment i, double *area) {
  hr2di_corridor c = widest(right, left);
  double sum = 0, t = 0;
  *area = 0;
  if (!find_first(frame, right, left, &c)) return 0;
  /* If there is a first line there is a last one.  But where a rounding of a wall is longer
     than i and j, its ends on their lines may lie so that only one is found. */
  if (!find_last(frame, right, left, &c)) return 1;
  const size_t r_last = c.right_first, l_last = c.left_last;
  size_t r = c.right_last, l = c.left_first;
  hr2d_point x = i.a;
  while (!hr2di_watch_work(right->watch, 2)) {
    const hr2di_incident_point *at = &right->point[r], *to = &left->point[l];
    const double t_right = r > r_last ? crossing(at[-1], at[0], i, t) : 1;
    const double t_left = l < l_last ? crossing(to[0], to[1], i, t) : 1;
    const double next = fmin(t_right, t_left);
    if (next > t) {
      const hr2d_segment part = {x, point_at(i, next)}, view = {at->at, to->at};
      sum += hr2d_exchange_area(&part, &view);
      t = next;
      x = part.b;
    }
    if (r > r_last && t_right <= next)
      r--;
    else if (l < l_last && t_left <= next)
      l++;
    else
      break;
  }
  *area = sum;
  return 1;
}
