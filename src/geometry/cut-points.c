/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses one point for each crossing of two walls, and the same point for crossings at one
   place.

   A point P serves walls i and j if it is within two roundings of both lines.  Walls that are
   cut at P bend by no more than that and meet in P exactly, so that they no longer cross.  A
   crossing takes the nearest point that serves it: first among the ends and cuts of its own
   walls, then among the ends and cuts of other walls within two roundings; if there is none,
   its own point.  The steeper a crossing is, the better its own point is known, so steep
   crossings come first: three lines through one place take the point of the two that cross most
   steeply, on whichever side of it the third line passes. */
#include "geometry/cut-points.h"

#include <math.h>
#include <stdint.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/crossings.h"
#include "geometry/vector.h"

#define NONE SIZE_MAX

typedef struct crossing {
  size_t i, j;
  hr2d_point at;
  double sine;
  size_t node;
  double reach;  /* two roundings */
  double window; /* points within reach of both lines are no farther from `at` */
} crossing;

typedef struct partners { /* two walls that share a stretch */
  size_t i, j;
  int part; /* cut at each other's ends even if no crossing cuts them */
} partners;

/* A point that may serve crossings nearby: an end, or a crossing once it is settled. */
typedef struct node {
  double key;
  hr2d_point at;
  size_t crossing; /* NONE for an end */
  int done;
} node;

typedef struct finder {
  const hr2d_allocator *alloc;
  const hr2di_cut_wall *wall;
  size_t walls;
  hr2di_cuts *cuts;
  crossing *crossing;
  size_t crossings, crossing_capacity;
  partners *partners;
  size_t pairs, pair_capacity;
  int parted; /* `part` of some partners is set */
  node *node; /* sorted by key */
  size_t nodes;
} finder;

static hr2d_segment directed(const hr2di_cut_wall *w, int side) {
  return side == HR2DI_FORWARD ? w->s : (hr2d_segment){w->s.b, w->s.a};
}

/* Whether two walls that share a stretch must be cut at each other's ends: patches on them hide
   each other, or overlap so little that one of them can do without the stretch. */
static int must_part(const hr2di_cut_wall *i, const hr2di_cut_wall *j) {
  for (int a = HR2DI_FORWARD; a <= HR2DI_BACKWARD; a++)
    for (int b = HR2DI_FORWARD; b <= HR2DI_BACKWARD; b++) {
      if (!(i->sides & a) || !(j->sides & b)) continue;
      const hr2d_segment s = directed(i, a), t = directed(j, b);
      const hr2di_meeting m = hr2di_crossings_meet(&s, &t);
      if (m.kind == HR2DI_MEET_FACE) return 1;
      if (m.kind == HR2DI_MEET_LIE &&
          hypot(m.to.x - m.from.x, m.to.y - m.from.y) <=
              HR2DI_SHORT_STRETCH * hr2di_crossings_rounding(&s, &t))
        return 1;
    }
  return 0;
}

static hr2d_status note_partners(finder *f, size_t i, size_t j) {
  if (hr2di_alloc_reserve(f->alloc, &f->partners, &f->pair_capacity, f->pairs + 1,
                          sizeof *f->partners))
    return HR2D_ENOMEM;
  const int part = must_part(&f->wall[i], &f->wall[j]);
  f->partners[f->pairs++] = (partners){i, j, part};
  f->parted |= part;
  return HR2D_OK;
}

static hr2d_status note_meeting(void *ctx, size_t i, size_t j) {
  finder *f = ctx;
  const hr2d_segment *s = &f->wall[i].s, *t = &f->wall[j].s;
  const hr2di_meeting m = hr2di_crossings_meet(s, t);
  if (m.together) return note_partners(f, i, j);
  if (m.kind != HR2DI_MEET_CROSS) return HR2D_OK;
  if (hr2di_alloc_reserve(f->alloc, &f->crossing, &f->crossing_capacity, f->crossings + 1,
                          sizeof *f->crossing))
    return HR2D_ENOMEM;
  const int e = f->cuts->exponent;
  const hr2d_point at = {ldexp(ldexp(m.from.x, e), -e), ldexp(ldexp(m.from.y, e), -e)};
  const double reach = 2 * hr2di_crossings_rounding(s, t);
  f->crossing[f->crossings++] = (crossing){i, j, at, m.sine, 0, reach, 4 * reach / m.sine};
  return HR2D_OK;
}

static int steepest_first(const void *left, const void *right) {
  const crossing *l = left, *r = right;
  if (l->sine != r->sine) return l->sine > r->sine ? -1 : 1;
  if (l->i != r->i) return l->i < r->i ? -1 : 1;
  return (l->j > r->j) - (l->j < r->j);
}

/* The position along a direction in which the points of a lattice rarely coincide. */
static double key_of(hr2d_point p) {
  return 0.8251 * p.x + 0.5650 * p.y;
}

static int by_key(const void *left, const void *right) {
  const node *l = left, *r = right;
  if (l->key != r->key) return l->key < r->key ? -1 : 1;
  if (l->crossing == r->crossing) return hr2di_point_order(l->at, r->at);
  return (l->crossing > r->crossing) - (l->crossing < r->crossing);
}

static hr2d_status make_nodes(finder *f) {
  f->node = hr2di_alloc(f->alloc, 2 * f->walls + f->crossings, sizeof *f->node);
  if (!f->node) return HR2D_ENOMEM;
  for (size_t k = 0; k < f->walls; k++) {
    const hr2d_segment *s = &f->wall[k].s;
    f->node[f->nodes++] = (node){key_of(s->a), s->a, NONE, 1};
    f->node[f->nodes++] = (node){key_of(s->b), s->b, NONE, 1};
  }
  for (size_t k = 0; k < f->crossings; k++)
    f->node[f->nodes++] = (node){key_of(f->crossing[k].at), f->crossing[k].at, k, 0};
  const hr2d_status status =
      hr2di_sort(f->node, f->nodes, sizeof *f->node, by_key, f->cuts->watch);
  for (size_t k = 0; k < f->nodes; k++)
    if (f->node[k].crossing != NONE) f->crossing[f->node[k].crossing].node = k;
  return status;
}

static double distance_of(hr2d_point p, hr2d_point q) {
  return fmax(fabs(p.x - q.x), fabs(p.y - q.y));
}

static int is_on(const finder *f, size_t wall, hr2d_point p) {
  if (hr2di_point_same(f->wall[wall].s.a, p) || hr2di_point_same(f->wall[wall].s.b, p))
    return 1;
  const hr2di_cut_range own = f->cuts->of[wall];
  for (size_t k = own.first; k < own.end; k++)
    if (hr2di_point_same(f->cuts->cut[k].at, p)) return 1;
  return 0;
}

static int is_inside(const hr2d_segment *s, hr2d_point p) {
  const double t = hr2di_point_along(*s, p);
  return t > hr2di_point_along(*s, s->a) && t < hr2di_point_along(*s, s->b);
}

static int serves(const finder *f, size_t wall, hr2d_point p, double reach) {
  return is_on(f, wall, p) || (is_inside(&f->wall[wall].s, p) &&
                               hr2di_crossings_distance(p, &f->wall[wall].s) <= reach);
}

/* The best point so far and its distance from the crossing; the distance is SHARED if both
   walls end or are cut there already. */
typedef struct choice {
  hr2d_point at;
  double distance;
} choice;

#define SHARED (-1)

static void offer(const finder *f, const crossing *c, hr2d_point p, choice *best) {
  const double distance = distance_of(p, c->at);
  if (best->distance == SHARED || distance > c->window) return;
  const int shared = is_on(f, c->i, p) && is_on(f, c->j, p);
  if (!shared && (distance >= best->distance || !serves(f, c->i, p, c->reach) ||
                  !serves(f, c->j, p, c->reach)))
    return;
  *best = (choice){p, shared ? SHARED : distance};
}

static void offer_wall(const finder *f, const crossing *c, size_t wall, choice *best) {
  offer(f, c, f->wall[wall].s.a, best);
  offer(f, c, f->wall[wall].s.b, best);
  const hr2di_cut_range own = f->cuts->of[wall];
  for (size_t k = own.first; k < own.end; k++) offer(f, c, f->cuts->cut[k].at, best);
}

static size_t first_node(const finder *f, double key) {
  size_t low = 0, high = f->nodes;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (f->node[middle].key < key)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static void offer_neighbours(const finder *f, const crossing *c, choice *best) {
  const double key = key_of(c->at), width = 2 * c->reach;
  for (size_t k = first_node(f, key - width); k < f->nodes && f->node[k].key <= key + width;
       k++) {
    if (k % 16 == 0 && hr2di_watch_work(f->cuts->watch, 1)) return;
    if (f->node[k].done && distance_of(f->node[k].at, c->at) <= c->reach)
      offer(f, c, f->node[k].at, best);
  }
}

/* Makes room for one cut of a wall at each of its crossings and at both ends of a partner. */
static hr2d_status make_room(finder *f) {
  hr2di_cuts *cuts = f->cuts;
  const size_t room = 2 * f->crossings + 4 * f->pairs;
  cuts->cut = hr2di_alloc(f->alloc, room, sizeof *cuts->cut);
  cuts->of = hr2di_alloc_zero(f->alloc, f->walls, sizeof *cuts->of);
  if (!cuts->cut || !cuts->of) return HR2D_ENOMEM;
  for (size_t k = 0; k < f->crossings; k++) {
    cuts->of[f->crossing[k].i].end++;
    cuts->of[f->crossing[k].j].end++;
  }
  for (size_t k = 0; k < f->pairs; k++) {
    cuts->of[f->partners[k].i].end += 2;
    cuts->of[f->partners[k].j].end += 2;
  }
  size_t next = 0;
  for (size_t k = 0; k < f->walls; k++) {
    const size_t size = cuts->of[k].end;
    cuts->of[k] = (hr2di_cut_range){next, next};
    next += size;
  }
  return HR2D_OK;
}

static int is_cut(const finder *f, size_t wall) {
  return f->cuts->of[wall].end > f->cuts->of[wall].first;
}

static void cut(finder *f, size_t wall, hr2d_point p) {
  if (is_on(f, wall, p)) return;
  f->cuts->cut[f->cuts->of[wall].end++] = (hr2di_cut){p, hr2di_point_along(f->wall[wall].s, p)};
  f->cuts->count++;
}

static size_t cuts_of(const finder *f, size_t wall) {
  return f->cuts->of[wall].end - f->cuts->of[wall].first;
}

static hr2d_status settle(finder *f, const crossing *c) {
  const hr2d_status status =
      hr2di_watch_work(f->cuts->watch, 4 + (cuts_of(f, c->i) + cuts_of(f, c->j)) / 8);
  if (status) return status;
  choice best = {.at = c->at, .distance = HUGE_VAL};
  offer_wall(f, c, c->i, &best);
  offer_wall(f, c, c->j, &best);
  if (best.distance == HUGE_VAL) offer_neighbours(f, c, &best);
  f->node[c->node].at = best.at;
  f->node[c->node].done = 1;
  f->cuts->place[f->cuts->places++] = best.at;
  if (best.distance == SHARED) return HR2D_OK;
  cut(f, c->i, best.at);
  cut(f, c->j, best.at);
  return HR2D_OK;
}

/* A wall that is cut bends by a rounding, away from a partner along it.  So partners are cut at
   the ends of the stretch that they share, which makes it a wall of its own. */
static hr2d_status cut_partners(finder *f) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < f->pairs; k++)
    f->partners[k].part |= is_cut(f, f->partners[k].i) || is_cut(f, f->partners[k].j);
  for (size_t k = 0; k < 2 * f->pairs && !status; k++) {
    const partners *p = &f->partners[k / 2];
    const size_t i = k % 2 ? p->j : p->i;
    status = hr2di_watch_work(f->cuts->watch, 1 + cuts_of(f, i) / 16);
    const hr2d_segment own = f->wall[i].s, other = f->wall[k % 2 ? p->i : p->j].s;
    if (p->part && is_inside(&own, other.a)) cut(f, i, other.a);
    if (p->part && is_inside(&own, other.b)) cut(f, i, other.b);
  }
  return status;
}

static int by_position(const void *left, const void *right) {
  const hr2di_cut *l = left, *r = right;
  if (l->along != r->along) return l->along < r->along ? -1 : 1;
  return hr2di_point_order(l->at, r->at);
}

static hr2d_status sort_cuts(finder *f) {
  hr2di_cuts *cuts = f->cuts;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < f->walls && !status; k++)
    if (is_cut(f, k))
      status = hr2di_sort(&cuts->cut[cuts->of[k].first], cuts_of(f, k), sizeof *cuts->cut,
                          by_position, cuts->watch);
  return status;
}

static hr2d_status find(finder *f) {
  hr2di_cuts *cuts = f->cuts;
  hr2d_status status = hr2di_crossings_find(f->alloc, &f->wall[0].s, f->walls, sizeof *f->wall,
                                            NULL, note_meeting, f, cuts->watch);
  if (status || (f->crossings == 0 && !f->parted)) return status;
  status =
      hr2di_sort(f->crossing, f->crossings, sizeof *f->crossing, steepest_first, cuts->watch);
  if (!status) status = make_nodes(f);
  if (!status) status = make_room(f);
  if (!status && hr2di_alloc_reserve(f->alloc, &cuts->place, &cuts->place_capacity,
                                     cuts->places + f->crossings, sizeof *cuts->place))
    status = HR2D_ENOMEM;
  for (size_t k = 0; k < f->crossings && !status; k++) status = settle(f, &f->crossing[k]);
  if (!status) status = cut_partners(f);
  return status ? status : sort_cuts(f);
}

static void drop_cuts(hr2di_cuts *cuts) {
  hr2di_alloc_free(cuts->alloc, cuts->cut);
  hr2di_alloc_free(cuts->alloc, cuts->of);
  cuts->cut = NULL;
  cuts->of = NULL;
  cuts->count = 0;
}

hr2d_status hr2di_cuts_init(hr2di_cuts *cuts, const hr2di_cut_wall *wall, size_t walls) {
  finder f = {.alloc = cuts->alloc, .wall = wall, .walls = walls, .cuts = cuts};
  drop_cuts(cuts);
  const hr2d_status status = find(&f);
  hr2di_alloc_free(f.alloc, f.crossing);
  hr2di_alloc_free(f.alloc, f.partners);
  hr2di_alloc_free(f.alloc, f.node);
  return status;
}

void hr2di_cuts_clear(hr2di_cuts *cuts) {
  drop_cuts(cuts);
  hr2di_alloc_free(cuts->alloc, cuts->place);
}
