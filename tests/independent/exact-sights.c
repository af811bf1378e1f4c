/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines that have the same ends on their left cross the same walls in the same order.  Every
   such class has on its border a line through two ends p and q.  There, the ends on this line
   are, from first to last, on one side up to some place and on the other side behind it; all
   others stay where they are.

   A wall from a to b meets the line at t = (t_a d_b − t_b d_a)/(d_b − d_a), where d is the
   determinant with pq and t the projection on pq.  Walls meet it at the same t only in an end v
   on the line.  A line that passes v at a small distance δ, with v on its left, meets a wall of
   direction u there δ (u·d)/(d×u) before t. */
#include "independent/exact-sights.h"

#include <stdlib.h>

#include "support/plane.h"
#include "support/support.h"

typedef struct wall {
  hr2d_segment at;
  int from, to;    /* ends */
  size_t patch[2]; /* with its front on the left, on the right */
  int is[2];       /* there */
} wall;

/* An end as it lies to the line. */
typedef struct end {
  hr2d_point at;
  double det, along;
  int side; /* 1 for left, −1 for right */
} end;

/* Where the line meets a wall: `along`/`whole`, and by δ·`slope`/`steep` before it if the end
   there is on the left. */
typedef struct meeting {
  double along, whole; /* whole > 0 */
  double slope, steep; /* steep > 0 */
  int side;            /* of the end there */
  const wall *wall;
  int forward; /* leaves from the left of the wall */
} meeting;

typedef struct classes {
  wall *wall;
  size_t walls;
  end *end;
  int ends;
  int *on; /* ends on the line, along it */
  int count;
  meeting *met;
  hr2d_point direction;
  unsigned char *sees;
  size_t n;
} classes;

static int number_of(classes *s, hr2d_point p) {
  int k = 0;
  while (k < s->ends && !plane_same(s->end[k].at, p)) k++;
  if (k == s->ends) s->end[s->ends++].at = p;
  return k;
}

static void add_patch(classes *s, hr2d_segment at, size_t patch) {
  for (size_t k = 0; k < s->walls; k++) {
    wall *w = &s->wall[k];
    const int same = plane_same(w->at.a, at.a) && plane_same(w->at.b, at.b);
    if (!same && !(plane_same(w->at.a, at.b) && plane_same(w->at.b, at.a))) continue;
    w->patch[!same] = patch;
    w->is[!same] = 1;
    return;
  }
  const int from = number_of(s, at.a), to = number_of(s, at.b);
  s->wall[s->walls++] = (wall){.at = at, .from = from, .to = to, .patch = {patch}, .is = {1}};
}

/* Lays the line through p and q; 0 if two ends before these have done so. */
static int lay_line(classes *s, int p, int q) {
  const hr2d_point a = s->end[p].at, b = s->end[q].at;
  s->direction = (hr2d_point){b.x - a.x, b.y - a.y};
  s->count = 0;
  for (int k = 0; k < s->ends; k++) {
    end *e = &s->end[k];
    e->det = plane_det(a, b, e->at);
    e->side = (e->det > 0) - (e->det < 0);
    if (e->det == 0 && (k < p || (k < q && k != p))) return 0;
    e->along = (e->at.x - a.x) * s->direction.x + (e->at.y - a.y) * s->direction.y;
    if (e->det != 0) continue;
    int place = s->count++;
    for (; place > 0 && s->end[s->on[place - 1]].along > e->along; place--)
      s->on[place] = s->on[place - 1];
    s->on[place] = k;
  }
  return 1;
}

/* A wall on the line is met in the gap between two ends on it, where nothing else is. */
static meeting meet_in_gap(const classes *s, const wall *w) {
  int place = 1;
  while (s->end[s->on[place]].side == s->end[s->on[place - 1]].side) place++;
  return (meeting){.along = s->end[s->on[place]].along + s->end[s->on[place - 1]].along,
                   .whole = 2,
                   .steep = 1,
                   .wall = w,
                   .forward = s->end[w->from].side > 0};
}

static meeting meet(const classes *s, const wall *w) {
  const end *a = &s->end[w->from], *b = &s->end[w->to];
  if (a->det == 0 && b->det == 0) return meet_in_gap(s, w);
  const double sign = b->det > a->det ? 1 : -1;
  const double ux = w->at.b.x - w->at.a.x, uy = w->at.b.y - w->at.a.y;
  meeting m = {.along = sign * (a->along * b->det - b->along * a->det),
               .whole = sign * (b->det - a->det),
               .slope = sign * (ux * s->direction.x + uy * s->direction.y),
               .steep = sign * (s->direction.x * uy - s->direction.y * ux),
               .wall = w,
               .forward = a->side > 0};
  for (int k = 0; k < s->count; k++)
    if (s->end[s->on[k]].along * m.whole == m.along) m.side = s->end[s->on[k]].side;
  return m;
}

static int by_place(const void *left, const void *right) {
  const meeting *l = left, *r = right;
  const double t = l->along * r->whole - r->along * l->whole;
  if (t != 0) return t < 0 ? -1 : 1;
  const double behind = l->side * (r->slope * l->steep - l->slope * r->steep);
  return (behind > 0) - (behind < 0);
}

/* One class of lines, in both directions. */
static void look(classes *s) {
  size_t count = 0;
  for (size_t k = 0; k < s->walls; k++)
    if (s->end[s->wall[k].from].side != s->end[s->wall[k].to].side)
      s->met[count++] = meet(s, &s->wall[k]);
  qsort(s->met, count, sizeof *s->met, by_place);
  for (size_t k = 1; k < count; k++) {
    const meeting *l = &s->met[k - 1], *r = &s->met[k];
    const int i = !l->forward, j = r->forward;
    if (!l->wall->is[i] || !r->wall->is[j]) continue;
    s->sees[l->wall->patch[i] * s->n + r->wall->patch[j]] = 1;
    s->sees[r->wall->patch[j] * s->n + l->wall->patch[i]] = 1;
  }
}

static void look_around(classes *s) {
  for (int cut = 0; cut < s->count; cut++)
    for (int side = -1; side <= 1; side += 2) {
      for (int k = 0; k < s->count; k++) s->end[s->on[k]].side = k < cut ? side : -side;
      look(s);
    }
}

void exact_sights(const hr2d_segment *patch, size_t n, unsigned char *sees) {
  classes s = {.wall = malloc(n * sizeof *s.wall),
               .end = malloc(2 * n * sizeof *s.end),
               .on = malloc(2 * n * sizeof *s.on),
               .met = malloc(n * sizeof *s.met),
               .sees = sees,
               .n = n};
  ck_assert(s.wall != NULL && s.end != NULL && s.on != NULL && s.met != NULL);
  for (size_t k = 0; k < n * n; k++) sees[k] = 0;
  for (size_t k = 0; k < n; k++) add_patch(&s, patch[k], k);
  for (int p = 0; p < s.ends; p++)
    for (int q = p + 1; q < s.ends; q++)
      if (lay_line(&s, p, q)) look_around(&s);
  free(s.wall);
  free(s.end);
  free(s.on);
  free(s.met);
}
