/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rounds: all pairs of hulls whose boxes meet are tested, those that meet are joined, and each
   that has become larger gets its hull.  Rounds go on until nothing is joined.

   The longest screens come first, and each round doubles their number.  Where many screens
   cross, few of the longest make hulls of most of the room, and the others have few hulls
   left to meet. */
#include "occlusion/occluder-hulls.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "base/union-find.h"
#include "geometry/crossings.h"
#include "geometry/hull.h"
#include "geometry/vector.h"

enum { FIRST_ROUND = 64 };

static double length_of(const hr2di_clipped_occluder *s) {
  return s->points < 2 ? 0 : hypot(s->at[1].x - s->at[0].x, s->at[1].y - s->at[0].y);
}

/* The longest first. */
static int by_length(const void *left, const void *right) {
  const hr2di_clipped_occluder *l = left, *r = right;
  const double here = length_of(l), there = length_of(r);
  if (here != there) return here > there ? -1 : 1;
  int sign = hr2di_point_order(l->at[0], r->at[0]);
  if (!sign) sign = hr2di_point_order(l->at[1], r->at[1]);
  if (!sign) sign = (l->points > r->points) - (l->points < r->points);
  return sign ? sign : (l->joins > r->joins) - (l->joins < r->joins);
}

static hr2d_segment box_of(const hr2d_point *p, size_t count) {
  hr2d_segment box = {p[0], p[0]};
  for (size_t k = 1; k < count; k++) {
    box.a = (hr2d_point){fmin(box.a.x, p[k].x), fmin(box.a.y, p[k].y)};
    box.b = (hr2d_point){fmax(box.b.x, p[k].x), fmax(box.b.y, p[k].y)};
  }
  return box;
}

/* Adds a hull of some points, at least one. */
static hr2d_status add(hr2di_occluder_hulls *c, const hr2d_point *at, size_t count) {
  if (c->hulls >= UINT32_MAX ||
      hr2di_alloc_reserve(&c->alloc, &c->hull, &c->room, c->hulls + 1, sizeof *c->hull) ||
      hr2di_alloc_reserve(&c->alloc, &c->parent, &c->parent_room, c->hulls + 1,
                          sizeof *c->parent) ||
      hr2di_alloc_reserve(&c->alloc, &c->point, &c->point_room, c->points + count,
                          sizeof *c->point))
    return HR2D_ENOMEM;
  memcpy(c->point + c->points, at, count * sizeof *at);
  c->parent[c->hulls] = (uint32_t)c->hulls;
  c->hull[c->hulls++] = (hr2di_occluder_hull){box_of(at, count), c->points, count};
  c->points += count;
  return HR2D_OK;
}

/* Adds the hull of the right or the left hand. */
static hr2d_status add_hand(hr2di_occluder_hulls *c, hr2d_point p, hr2d_point q) {
  const hr2d_point at[] = {p, q};
  return add(c, at, hr2di_point_same(p, q) ? 1 : 2);
}

/* Joins the sets of two hulls. */
static void join(hr2di_occluder_hulls *c, uint32_t i, uint32_t j) {
  hr2di_union_join(c->parent, i, j);
  c->blocked = hr2di_union_find(c->parent, 0) == hr2di_union_find(c->parent, 1);
}

static hr2d_status add_screen(hr2di_occluder_hulls *c, const hr2di_clipped_occluder *s) {
  const uint32_t number = (uint32_t)c->hulls;
  if (s->points > 0) {
    const hr2d_status status = add(c, s->at, s->points);
    if (status) return status;
    if (s->joins & HR2DI_JOINS_RIGHT) join(c, 0, number);
    if (s->joins & HR2DI_JOINS_LEFT) join(c, 1, number);
  } else if (s->joins == (HR2DI_JOINS_RIGHT | HR2DI_JOINS_LEFT)) {
    join(c, 0, 1);
  }
  return HR2D_OK;
}

/* Whether the line of an edge of p has all of q on its outer side; exact. */
static int parts(const hr2di_occluder_hulls *c, const hr2di_occluder_hull *p,
                 const hr2di_occluder_hull *q) {
  const hr2d_point *from = c->point + p->first, *to = c->point + q->first;
  for (size_t k = 0; k < p->points && p->points > 1; k++) {
    const hr2d_point next = from[k + 1 < p->points ? k + 1 : 0];
    size_t m = 0;
    while (m < q->points && hr2di_orient_sign(from[k], next, to[m]) < 0) m++;
    if (m == q->points) return 1;
  }
  return 0;
}

/* Whether two hulls have a point in common.  Two that no edge parts, and whose boxes meet, do,
   also if all of their points lie on one line. */
static int meet(const hr2di_occluder_hulls *c, const hr2di_occluder_hull *p,
                const hr2di_occluder_hull *q) {
  const hr2d_segment r = p->box, s = q->box;
  if (r.a.x > s.b.x || s.a.x > r.b.x || r.a.y > s.b.y || s.a.y > r.b.y) return 0;
  return !parts(c, p, q) && !parts(c, q, p);
}

typedef struct turn {
  hr2di_occluder_hulls *hulls;
  int joined;
} turn;

/* Ends the sweep when nothing passes. */
static hr2d_status examine(void *ctx, size_t i, size_t j) {
  turn *r = ctx;
  hr2di_occluder_hulls *c = r->hulls;
  const hr2di_occluder_hull *p = &c->hull[i], *q = &c->hull[j];
  if (hr2di_union_find(c->parent, (uint32_t)i) == hr2di_union_find(c->parent, (uint32_t)j))
    return HR2D_OK;
  const hr2d_status status = hr2di_watch_work(c->watch, (p->points + q->points) / 4);
  if (status || !meet(c, p, q)) return status;
  join(c, (uint32_t)i, (uint32_t)j);
  r->joined = 1;
  return c->blocked ? HR2D_ESTATE : HR2D_OK;
}

/* The members of each set in a row, sets by their least members. */
typedef struct grouping {
  uint32_t *start; /* of the set with this root */
  uint32_t *member;
  hr2d_segment *pair; /* room for the points of a set */
} grouping;

static void group(hr2di_occluder_hulls *c, grouping *g) {
  for (uint32_t k = 0; k < c->hulls; k++) g->start[hr2di_union_find(c->parent, k) + 1]++;
  for (size_t k = 0; k < c->hulls; k++) g->start[k + 1] += g->start[k];
  for (uint32_t k = (uint32_t)c->hulls; k-- > 0;)
    g->member[--g->start[hr2di_union_find(c->parent, k) + 1]] = k;
}

/* Puts the corners of a hull in a row, counterclockwise; returns their number. */
static size_t close_up(hr2di_hull *hull) {
  const size_t lower = hull->count[0];
  if (lower == 1) return 1;
  hr2d_point *between = hull->at + lower + 1;
  const size_t count = hull->count[1] - 2;
  for (size_t k = 0; 2 * k + 1 < count; k++) {
    const hr2d_point at = between[k];
    between[k] = between[count - 1 - k];
    between[count - 1 - k] = at;
  }
  memmove(between - 1, between, count * sizeof *between);
  return lower + count;
}

/* Adds the hull of the `count` hulls of `from` in a set. */
static hr2d_status add_hull(hr2di_occluder_hulls *c, const hr2di_occluder_hulls *from,
                            const uint32_t *member, size_t count, hr2d_segment *pair) {
  size_t points = 0;
  hr2di_hull hull;
  for (size_t k = 0; k < count; k++) {
    const hr2di_occluder_hull *p = &from->hull[member[k]];
    for (size_t m = 0; m < p->points; m++, points++) {
      const hr2d_point at = from->point[p->first + m];
      if (points % 2 == 0) pair[points / 2].a = at;
      pair[points / 2].b = at;
    }
  }
  hr2d_status status =
      hr2di_hull_init(&hull, &c->alloc, pair, (points + 1) / 2, sizeof *pair, c->watch);
  if (!status) status = add(c, hull.at, close_up(&hull));
  hr2di_hull_clear(&hull);
  return status;
}

/* Makes the hulls anew, with a hull for each set. */
static hr2d_status regroup(hr2di_occluder_hulls *c) {
  hr2di_occluder_hulls next = {.alloc = c->alloc, .watch = c->watch};
  grouping g = {hr2di_alloc_zero(&c->alloc, c->hulls + 2, sizeof *g.start),
                hr2di_alloc(&c->alloc, c->hulls, sizeof *g.member),
                hr2di_alloc(&c->alloc, c->points + 1, sizeof *g.pair)};
  hr2d_status status = g.start && g.member && g.pair ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = hr2di_watch_work(c->watch, c->hulls / 4);
  if (!status) group(c, &g);
  for (size_t k = 0; k < c->hulls && !status; k++) {
    const uint32_t *member = g.member + g.start[k + 1];
    const size_t last = k + 1 < c->hulls ? g.start[k + 2] : c->hulls;
    const size_t count = last - g.start[k + 1];
    const hr2di_occluder_hull *one = &c->hull[k];
    if (count == 1)
      status = add(&next, c->point + one->first, one->points);
    else if (count > 1)
      status = add_hull(&next, c, member, count, g.pair);
    if (!status) status = hr2di_watch_work(c->watch, 1 + count);
  }
  hr2di_alloc_free(&c->alloc, g.start);
  hr2di_alloc_free(&c->alloc, g.member);
  hr2di_alloc_free(&c->alloc, g.pair);
  hr2di_occluder_hulls_clear(c);
  *c = next;
  return status;
}

/* *joined becomes whether something was. */
static hr2d_status play_round(hr2di_occluder_hulls *c, int *joined) {
  turn r = {c, 0};
  for (size_t k = 0; k < c->hulls; k++) r.joined |= c->parent[k] != k;
  hr2d_status status = c->blocked
                           ? HR2D_OK
                           : hr2di_crossings_sweep(&c->alloc, &c->hull[0].box, c->hulls,
                                                   sizeof *c->hull, examine, &r, c->watch);
  if (c->blocked) return hr2di_watch_status(c->watch);
  *joined = r.joined;
  return status || !r.joined ? status : regroup(c);
}

hr2d_status hr2di_occluder_hulls_init(hr2di_occluder_hulls *c, const hr2d_allocator *alloc,
                                      const hr2di_opening *o, hr2di_clipped_occluder *screen,
                                      size_t count, hr2di_watch *watch) {
  *c = (hr2di_occluder_hulls){.alloc = *alloc, .watch = watch};
  hr2d_status status = add_hand(c, o->part[0].b, o->part[1].a);
  if (!status) status = add_hand(c, o->part[0].a, o->part[1].b);
  if (!status) status = hr2di_sort(screen, count, sizeof *screen, by_length, watch);
  int joined = 1;
  for (size_t next = 0; (next < count || joined) && !c->blocked && !status;) {
    const size_t max = c->hulls > FIRST_ROUND ? c->hulls : FIRST_ROUND;
    const size_t last = count - next < max ? count : next + max;
    status = hr2di_watch_work(watch, (last - next) / 4);
    while (next < last && !status) status = add_screen(c, &screen[next++]);
    if (!status) status = play_round(c, &joined);
  }
  return status;
}

void hr2di_occluder_hulls_clear(hr2di_occluder_hulls *c) {
  hr2di_alloc_free(&c->alloc, c->hull);
  hr2di_alloc_free(&c->alloc, c->point);
  hr2di_alloc_free(&c->alloc, c->parent);
}
