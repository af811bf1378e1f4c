/* SPDX-License-Identifier: GPL-3.0-or-later */
/* G dy dx = ½ dp dθ, p the offset and θ the direction of a line.  For a fixed direction the
   places where a line meets i and j are affine in p, so that a Gauss rule of as many points as
   the order is exact. */
#include "independent/lines-block.h"

#include <math.h>
#include <stdlib.h>

typedef long double real;

typedef struct vec {
  real x, y;
} vec;

typedef struct screen {
  vec end[2];
} screen;

typedef struct scenery {
  vec a, u, c, v; /* i and j */
  screen part[2]; /* of i and of j, in front of each other */
  screen *wall;
  size_t walls;
  vec *event;
  size_t events;
  size_t order;
  unsigned steps;
  real *block;
  real node[32], weight[32]; /* of the rule over offsets */
} scenery;

static vec minus(vec p, vec q) {
  return (vec){p.x - q.x, p.y - q.y};
}

static real cross(vec p, vec q) {
  return p.x * q.y - p.y * q.x;
}

static vec mix(vec p, vec q, real part) {
  return (vec){p.x + part * (q.x - p.x), p.y + part * (q.y - p.y)};
}

static vec unit(vec p) {
  const real length = hypotl(p.x, p.y);
  return (vec){p.x / length, p.y / length};
}

static vec of(hr2d_point p) {
  return (vec){p.x, p.y};
}

/* Cuts off what is behind the line from `from` along `along`; 0 if nothing is left. */
static int clip(screen *s, vec from, vec along) {
  const real at[2] = {cross(along, minus(s->end[0], from)),
                      cross(along, minus(s->end[1], from))};
  if (!(at[0] > 0) && !(at[1] > 0)) return 0;
  const vec whole[2] = {s->end[0], s->end[1]};
  for (int k = 0; k < 2; k++)
    if (at[k] < 0) s->end[k] = mix(whole[0], whole[1], at[0] / (at[0] - at[1]));
  return 1;
}

/* P_n and P_n' give a rule for the mean over [-1,1]. */
static void make_rule(scenery *s) {
  const size_t n = s->order;
  for (size_t k = 0; k < n; k++) {
    real x = cosl(3.14159265358979323846L * ((real)k + 0.75L) / ((real)n + 0.5L)), slope = 1;
    for (int step = 0; step < 9; step++) {
      real before = 1, here = x;
      for (size_t l = 1; l < n; l++) {
        const real next = ((2 * (real)l + 1) * x * here - (real)l * before) / ((real)l + 1);
        before = here;
        here = next;
      }
      slope = (real)n * (before - x * here) / (1 - x * x);
      x -= here / slope;
    }
    s->node[k] = x;
    s->weight[k] = 1 / ((1 - x * x) * slope * slope);
  }
}

/* Rounding moves places off the element where directions are nearly along it, and see nearly
   nothing. */
static void fill_basis(size_t order, real place, real *phi) {
  const real x = 2 * fminl(fmaxl(place, 0), 1) - 1;
  real before = 0, here = 1;
  for (size_t l = 0; l < order; l++) {
    phi[l] = sqrtl(2 * (real)l + 1) * here;
    const real next = ((2 * (real)l + 1) * x * here - (real)l * before) / ((real)l + 1);
    before = here;
    here = next;
  }
}

/* Adds weight times the mean over the lines of direction e between two points. */
static void add_direction(const scenery *s, vec low, vec high, vec e, real weight) {
  const size_t p = s->order;
  real on_i[32], on_j[32];
  const real length = hypotl(e.x, e.y), across_i = cross(s->u, e), across_j = cross(e, s->v);
  const real width = cross(minus(high, low), e) / length;
  if (!(across_i > 0) || !(across_j > 0)) return; /* along an element, where nothing is seen */
  for (size_t k = 0; k < p; k++) {
    const vec z = mix(low, high, 0.5L + 0.5L * s->node[k]);
    fill_basis(p, cross(minus(z, s->a), e) / across_i, on_i);
    fill_basis(p, cross(e, minus(z, s->c)) / across_j, on_j);
    for (size_t l = 0; l < p; l++)
      for (size_t m = 0; m < p; m++)
        s->block[l * p + m] += 0.5L * weight * width * s->weight[k] * on_i[l] * on_j[m];
  }
}

/* λ = 1/(1 + exp(−π sinh τ)); dθ = e0 × e1 dλ/|e|². */
static void add_between(const scenery *s, vec low, vec high, vec e0, vec e1) {
  const real step = 1 / (real)s->steps, pi = 3.14159265358979323846L, turn = cross(e0, e1);
  for (int k = -(int)(4.3 * s->steps); k <= (int)(4.3 * s->steps); k++) {
    const real tau = step * (real)k, y = pi * sinhl(tau);
    const real g = 1 / (1 + expl(-y)), f = 1 / (1 + expl(y));
    const vec e = {f * e0.x + g * e1.x, f * e0.y + g * e1.y};
    add_direction(s, low, high, e,
                  step * pi * coshl(tau) * f * g * turn / (e.x * e.x + e.y * e.y));
  }
}

typedef struct shadow {
  vec from, to;
  real low, high;
} shadow;

static int by_low(const void *left, const void *right) {
  const shadow *l = left, *r = right;
  return (l->low > r->low) - (l->low < r->low);
}

/* The part of the lines of one direction that a screen covers. */
static shadow shadow_of(const screen *s, vec e) {
  const real p = cross(s->end[0], e), q = cross(s->end[1], e);
  if (p < q) return (shadow){s->end[0], s->end[1], p, q};
  return (shadow){s->end[1], s->end[0], q, p};
}

/* Adds the directions between two events. */
static void add_events(const scenery *s, vec e0, vec e1) {
  const vec e = unit(mix(e0, e1, 0.5L));
  shadow *hidden = malloc((s->walls + 1) * sizeof *hidden);
  const shadow i = shadow_of(&s->part[0], e), j = shadow_of(&s->part[1], e);
  vec low = i.low > j.low ? i.from : j.from;
  const shadow end = i.high < j.high ? i : j;
  real open = i.low > j.low ? i.low : j.low;
  for (size_t k = 0; k < s->walls; k++) hidden[k] = shadow_of(&s->wall[k], e);
  qsort(hidden, s->walls, sizeof *hidden, by_low);
  hidden[s->walls] = (shadow){end.to, end.to, end.high, end.high};
  for (size_t k = 0; k <= s->walls && open < end.high; k++) {
    const shadow h = hidden[k].low < end.high ? hidden[k] : hidden[s->walls];
    if (h.low > open) add_between(s, low, h.from, e0, e1);
    if (!(h.high > open)) continue;
    open = h.high;
    low = h.to;
  }
  free(hidden);
}

static int by_turn(const void *left, const void *right) {
  const real turn = cross(*(const vec *)left, *(const vec *)right);
  return (turn < 0) - (turn > 0);
}

static void find_events(scenery *s) {
  const size_t screens = s->walls + 2;
  const vec first = unit(minus(s->part[1].end[0], s->part[0].end[0]));
  const vec last = unit(minus(s->part[1].end[1], s->part[0].end[1]));
  s->event = malloc((4 * screens * screens + 2) * sizeof *s->event);
  s->event[s->events++] = first;
  s->event[s->events++] = last;
  for (size_t k = 0; k < 2 * screens; k++)
    for (size_t m = 0; m < 2 * screens; m++) {
      const screen *p = k < 4 ? &s->part[k / 2] : &s->wall[k / 2 - 2];
      const screen *q = m < 4 ? &s->part[m / 2] : &s->wall[m / 2 - 2];
      const vec way = minus(q->end[m % 2], p->end[k % 2]);
      if (way.x == 0 && way.y == 0) continue;
      const vec e = unit(way);
      if (cross(first, e) > 0 && cross(e, last) > 0) s->event[s->events++] = e;
    }
  qsort(s->event, s->events, sizeof *s->event, by_turn);
}

void lines_block(const hr2d_segment *i, const hr2d_segment *j, const hr2d_segment *occluder,
                 size_t count, size_t order, unsigned steps, long double *block) {
  scenery s = {.a = of(i->a), .c = of(j->a), .order = order, .steps = steps, .block = block};
  s.u = minus(of(i->b), s.a);
  s.v = minus(of(j->b), s.c);
  s.part[0] = (screen){{s.a, of(i->b)}};
  s.part[1] = (screen){{s.c, of(j->b)}};
  for (size_t k = 0; k < order * order; k++) block[k] = 0;
  if (!clip(&s.part[0], s.c, s.v) || !clip(&s.part[1], s.a, s.u)) return;
  make_rule(&s);
  s.wall = malloc((count + 1) * sizeof *s.wall);
  for (size_t k = 0; k < count; k++) {
    screen w = {{of(occluder[k].a), of(occluder[k].b)}};
    if (clip(&w, s.a, s.u) && clip(&w, s.c, s.v)) s.wall[s.walls++] = w;
  }
  find_events(&s);
  for (size_t k = 1; k < s.events; k++) {
    const vec e0 = s.event[k - 1], e1 = s.event[k];
    if (!(cross(e0, e1) > 0)) continue;
    /* Across a wide angle the middle is far from both. */
    const vec across = unit((vec){e1.y - e0.y, e0.x - e1.x});
    add_events(&s, e0, across);
    add_events(&s, across, e1);
  }
  free(s.wall);
  free(s.event);
}
