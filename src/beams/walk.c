/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walks beams depth first, with two chains that change by one point at each split.

   The lines of a beam are those that separate two chains, as in a line class.  A vertex v
   behind the edge that a beam enters is on the left of some line iff it lies strictly on the
   left of the tangent that leans most to the right, and on the right of some line iff strictly
   on the right of the other.  Both are signs of three vertices, and exact, so that a beam is
   followed iff it has lines.  Where v is on the left, it becomes the last point of the left
   chain; points before it that it hides are dropped, and those at the start of the right chain
   that no tangent to v can touch.

   "Drop some, add one" overwrites one place of an array: that place and the old first and last
   indices undo it, whatever was dropped.

   A line has two ends.  It goes up if its far end is higher, or as high and further to the
   right. The lines of a beam turn by less than half a turn between its tangents: if both
   tangents go up, all lines do.  With `once`, beams that go down are dropped, as the other end
   finds them, and a line class whose tangents differ is taken from the side of the lesser
   number. */
#include "beams/walk.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "geometry/orient-sign.h"

typedef struct chains {
  uint32_t first[2], last[2]; /* of hr2di_walk::chain: 0 the left one, 1 the right one */
} chains;

/* A split.  While its first beam is walked, the second waits; while the second is walked, the
   frame holds what restores the chains for the splits below. */
struct hr2di_walk_frame {
  hr2d_point v, overwritten;
  chains before;
  int32_t other; /* the half-edge of the second beam; negative if there is none */
  uint32_t place;
  int hand; /* the chain that was written to, and by the first beam */
};

/* What stays the same during a walk. */
typedef struct base {
  hr2di_wall_side side;
  hr2d_segment at;
  const hr2d_segment *part;
} base;

hr2d_segment hr2di_wall_side_at(const hr2di_triangulation *t, hr2di_wall_side side) {
  const hr2di_wall_edge *e = &t->edge[side >> 1];
  const hr2d_point from = t->at[e->from], to = t->at[e->to];
  return side & 1 ? (hr2d_segment){to, from} : (hr2d_segment){from, to};
}

static hr2d_point first(const hr2di_walk *w, const chains *c, int hand) {
  return w->chain[hand][c->first[hand]];
}

static hr2d_point last(const hr2di_walk *w, const chains *c, int hand) {
  return w->chain[hand][c->last[hand]];
}

static int goes_up(hr2d_point p, hr2d_point q) {
  return q.y > p.y || (q.y == p.y && q.x > p.x);
}

/* How many of the two tangents go up. */
static int tangents_up(const hr2di_walk *w, const chains *c) {
  return goes_up(first(w, c, 0), last(w, c, 1)) + goes_up(first(w, c, 1), last(w, c, 0));
}

/* Whether r, a point of a base, is on the right of p → q for certain: by more than the rounding
   of the sign and than r is off the base, some roundings of coordinates.  That matters where p,
   q and r all lie on the base. */
static int surely_right(hr2d_point p, hr2d_point q, hr2d_point r) {
  const double dx = q.x - p.x, dy = q.y - p.y;
  const double u = dx * (r.y - p.y), v = dy * (r.x - p.x);
  return u - v < -0x1p-40 * (fabs(u) + fabs(v) + fabs(dx) + fabs(dy)) - 0x1p-900;
}

static int misses_part(const hr2di_walk *w, const chains *c, const base *b) {
  return b->part && (surely_right(first(w, c, 1), last(w, c, 0), b->part->a) ||
                     surely_right(last(w, c, 1), first(w, c, 0), b->part->b));
}

static int is_dropped(const hr2di_walk *w, const chains *c, const base *b) {
  return (w->once && tangents_up(w, c) == 0) || misses_part(w, c, b);
}

/* Makes v the last point of a chain; f receives what undoes it. */
static inline void turn_to(hr2di_walk *w, chains *c, int hand, hr2d_point v,
                           hr2di_walk_frame *f) {
  const int sign = hand ? -1 : 1;
  hr2d_point *mine = w->chain[hand];
  const hr2d_point *other = w->chain[1 - hand];
  uint32_t end = c->last[hand], start = c->first[1 - hand];
  while (end > c->first[hand] && sign * hr2di_orient_sign(mine[end - 1], mine[end], v) <= 0)
    end--;
  while (start < c->last[1 - hand] &&
         sign * hr2di_orient_sign(other[start], v, other[start + 1]) >= 0)
    start++;
  end++;
  f->hand = hand;
  f->place = end;
  f->overwritten = mine[end];
  mine[end] = v;
  c->last[hand] = end;
  c->first[1 - hand] = start;
}

static void undo(hr2di_walk *w, const hr2di_walk_frame *f) {
  w->chain[f->hand][f->place] = f->overwritten;
}

/* A beam ends at side j, which lies at `at`. */
static hr2d_status take(hr2di_walk *w, const chains *c, const base *b, hr2di_wall_side j,
                        hr2d_segment at) {
  const int up = w->once ? tangents_up(w, c) : 2;
  if (up == 0 || (up == 1 && b->side > j)) return HR2D_OK;
  const hr2di_line_class s = {
      .left = w->chain[0] + c->first[0],
      .right = w->chain[1] + c->first[1],
      .lefts = c->last[0] - c->first[0] + 1,
      .rights = c->last[1] - c->first[1] + 1,
      .ends = (hr2di_point_same(first(w, c, 0), b->at.a) ? HR2DI_LINE_CLASS_A : 0u) |
              (hr2di_point_same(first(w, c, 1), b->at.b) ? HR2DI_LINE_CLASS_B : 0u) |
              (hr2di_point_same(last(w, c, 1), at.a) ? HR2DI_LINE_CLASS_C : 0u) |
              (hr2di_point_same(last(w, c, 0), at.b) ? HR2DI_LINE_CLASS_D : 0u)};
  return w->take(w->ctx, &s, j);
}

/* Room for one point more in each chain, and for one frame more. */
static hr2d_status reserve(hr2di_walk *w, const chains *c) {
  for (int hand = 0; hand < 2; hand++)
    if (c->last[hand] + 2 > w->capacity[hand] &&
        hr2di_alloc_reserve(&w->alloc, &w->chain[hand], &w->capacity[hand], c->last[hand] + 2,
                            sizeof *w->chain[hand]))
      return HR2D_ENOMEM;
  if (w->frames + 1 > w->room &&
      hr2di_alloc_reserve(&w->alloc, &w->frame, &w->room, w->frames + 1, sizeof *w->frame))
    return HR2D_ENOMEM;
  return HR2D_OK;
}

static int is_end(const hr2di_walk *w, int32_t across) {
  return across < 0 && across != HR2DI_SKY && w->wanted[~across];
}

/* The triangle that a beam enters across the edge from l to r, and its apex. */
typedef struct entry {
  hr2d_point l, r, v;
  int32_t across[2]; /* behind r → v, where beams go that leave v on their left, and v → l */
  uint32_t vertex;   /* the number of v */
} entry;

/* The part of a beam that leaves v on its left (0) or right (1) ends here. */
static inline hr2d_status finish(hr2di_walk *w, chains *c, const base *b, const entry *e,
                                 int hand) {
  const hr2d_segment at = hand ? (hr2d_segment){e->v, e->l} : (hr2d_segment){e->r, e->v};
  const chains before = *c;
  hr2di_walk_frame f;
  turn_to(w, c, hand, e->v, &f);
  const hr2d_status status = take(w, c, b, (hr2di_wall_side)~e->across[hand], at);
  undo(w, &f);
  *c = before;
  return status;
}

/* Lets one part of a beam go on; 0 if it is dropped. */
static inline int go_on(hr2di_walk *w, chains *c, const base *b, hr2di_walk_frame *f,
                        int hand) {
  turn_to(w, c, hand, f->v, f);
  if (!is_dropped(w, c, b)) return 1;
  undo(w, f);
  *c = f->before;
  return 0;
}

/* Splits a beam; *next is the half-edge where a part of it goes on, or negative. */
static hr2d_status split(hr2di_walk *w, chains *c, const base *b, const entry *e,
                         int32_t *next) {
  hr2d_status status = reserve(w, c);
  if (w->see) w->see(w->ctx, e->vertex);
  if (!status && is_end(w, e->across[0])) status = finish(w, c, b, e, 0);
  if (!status && is_end(w, e->across[1])) status = finish(w, c, b, e, 1);
  if (status || (e->across[0] < 0 && e->across[1] < 0)) return status;
  hr2di_walk_frame *f = &w->frame[w->frames];
  f->v = e->v;
  f->before = *c;
  f->other = -1;
  if (e->across[0] >= 0 && go_on(w, c, b, f, 0)) *next = e->across[0];
  if (e->across[1] >= 0 && *next >= 0)
    f->other = e->across[1];
  else if (e->across[1] >= 0 && go_on(w, c, b, f, 1))
    *next = e->across[1];
  w->frames += *next >= 0;
  return HR2D_OK;
}

/* Goes back to the last split whose second part waits; returns its half-edge, or −1. */
static int32_t back(hr2di_walk *w, chains *c, const base *b) {
  while (w->frames > 0) {
    hr2di_walk_frame *f = &w->frame[w->frames - 1];
    const int32_t other = f->other;
    undo(w, f);
    *c = f->before;
    f->other = -1;
    if (other >= 0 && go_on(w, c, b, f, 1)) return other;
    w->frames--;
  }
  return -1;
}

/* Follows a beam that does not split from half-edge h on.  Returns whether it then splits, in
   the triangle that *e is; otherwise it has ended behind e->across[*hand].

   What is not on the left of any line is on the right of all.  The decision is a branch and not
   an index: where it is foreseen, the next triangle is read before the signs are known. */
static int follow(hr2di_walk *w, const chains *c, int32_t h, entry *e, int *hand) {
  const hr2d_point *at = w->in->at;
  const uint32_t sky = w->in->sky;
  const hr2d_point l0 = first(w, c, 0), l1 = last(w, c, 0);
  const hr2d_point r0 = first(w, c, 1), r1 = last(w, c, 1);
  for (;;) {
    const hr2di_triangle *t = &w->in->triangle[h >> 2];
    const int k = h & 3, to_right = hr2di_corner_after(k), to_left = hr2di_corner_before(k);
    const hr2d_point v = at[t->corner[to_left]];
    int splits = 0;
    w->steps++;
    if (t->corner[to_left] >= sky) {
      *hand = 0;
      e->across[0] = HR2DI_SKY;
      return 0;
    }
    *hand = !(hr2di_orient_sign(l0, r1, v) > 0);
    if (*hand) {
      h = t->across[to_left];
      if (h >= 0) continue;
    } else {
      h = t->across[to_right];
      splits = hr2di_orient_sign(r0, l1, v) < 0;
      if (h >= 0 && !splits) continue;
    }
    *e = (entry){at[t->corner[k]],
                 at[t->corner[to_right]],
                 v,
                 {t->across[to_right], t->across[to_left]},
                 t->corner[to_left]};
    return splits;
  }
}

/* Walks with the chains that are there. */
static hr2d_status walk(hr2di_walk *w, const base *b, chains c) {
  hr2d_status status = HR2D_OK;
  int32_t h = w->in->edge[b->side >> 1].half_edge[b->side & 1];
  while (h >= 0 && !status) {
    const uint64_t before = w->steps;
    entry e;
    int hand;
    int32_t next = -1;
    if (follow(w, &c, h, &e, &hand))
      status = split(w, &c, b, &e, &next);
    else if (is_end(w, e.across[hand]))
      status = take(w, &c, b, (hr2di_wall_side)~e.across[hand],
                    hand ? (hr2d_segment){e.v, e.l} : (hr2d_segment){e.r, e.v});
    h = next >= 0 || status ? next : back(w, &c, b);
    if (!status) status = hr2di_watch_work(w->watch, 1 + (w->steps - before) / 8);
  }
  return status;
}

hr2d_status hr2di_walk_from(hr2di_walk *w, hr2di_wall_side side, const hr2d_segment *part) {
  const base b = {side, hr2di_wall_side_at(w->in, side), part};
  const chains c = {{0, 0}, {0, 0}};
  w->frames = 0;
  const hr2d_status status = reserve(w, &c);
  if (status) return status;
  w->chain[0][0] = b.at.a;
  w->chain[1][0] = b.at.b;
  return walk(w, &b, c);
}

hr2d_status hr2di_walk_on(hr2di_walk *w, hr2di_wall_side side, const hr2di_line_class *s) {
  const base b = {side, hr2di_wall_side_at(w->in, side), NULL};
  const chains c = {{0, 0}, {(uint32_t)s->lefts - 1, (uint32_t)s->rights - 1}};
  w->frames = 0;
  const hr2d_status status = reserve(w, &c);
  if (status) return status;
  memcpy(w->chain[0], s->left, s->lefts * sizeof *s->left);
  memcpy(w->chain[1], s->right, s->rights * sizeof *s->right);
  return walk(w, &b, c);
}

uint64_t hr2di_walk_bytes(const hr2di_walk *w) {
  return (w->capacity[0] + w->capacity[1]) * sizeof(hr2d_point) + w->room * sizeof *w->frame;
}

void hr2di_walk_clear(hr2di_walk *w) {
  for (int hand = 0; hand < 2; hand++) hr2di_alloc_free(&w->alloc, w->chain[hand]);
  hr2di_alloc_free(&w->alloc, w->frame);
}
