/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each class removes a property of occluders on which a sweep might rely: separate ends,
   general position, being in front, being short, leaving room between them. */
#include "support/visibility-cases.h"

#include <check.h>
#include <hr2d/visibility.h>
#include <math.h>
#include <stdio.h>

#include "support/plane.h"

#define PI 3.14159265358979323846

static double snapped(double x, double step) {
  return step > 0 ? rint(x / step) * step : x;
}

static hr2d_point point_near(randoms *r, double step, double x, double y, double by) {
  const double dx = random_between(r, -by, by), dy = random_between(r, -by, by);
  return (hr2d_point){snapped(x + dx, step), snapped(y + dy, step)};
}

static hr2d_point point_between(randoms *r, double step) {
  return point_near(r, step, 0.5, 0.5, 0.7);
}

/* A sixteenth of a grid step is on the grid of all the coordinates. */
static hr2d_point foot(randoms *r, hr2d_segment w) {
  return plane_along(w, (1 + random_below(r, 15)) / 16.0);
}

static hr2d_point end_of(randoms *r, hr2d_segment w) {
  return random_below(r, 2) ? w.a : w.b;
}

static void add(occluded_pair *p, hr2d_point a, hr2d_point b) {
  if (p->count < MOST_OCCLUDERS && (a.x != b.x || a.y != b.y))
    p->occluder[p->count++] = (hr2d_segment){a, b};
}

static void face(randoms *r, double step, occluded_pair *p) {
  do {
    p->i = (hr2d_segment){point_near(r, step, 0, 0, .3), point_near(r, step, 1, 0, .3)};
    p->j = (hr2d_segment){point_near(r, step, 1, 1, .3), point_near(r, step, 0, 1, .3)};
  } while (hr2d_exchange_area(&p->i, &p->j) == 0);
}

static void short_ones(randoms *r, double step, occluded_pair *p, int count) {
  for (int k = 0; k < count; k++) {
    const hr2d_point a = point_between(r, step);
    add(p, a, point_near(r, step, a.x, a.y, .3));
  }
}

static void any_occluders(randoms *r, double step, occluded_pair *p) {
  face(r, step, p);
  short_ones(r, step, p, 1 + random_below(r, 12));
}

static void attached(randoms *r, double step, occluded_pair *p) {
  face(r, step, p);
  for (int k = 1 + random_below(r, 4); k > 0; k--)
    add(p, end_of(r, random_below(r, 2) ? p->i : p->j), point_between(r, step));
  short_ones(r, step, p, random_below(r, 6));
}

static void chains(randoms *r, double step, occluded_pair *p) {
  face(r, step, p);
  for (int chain = 1 + random_below(r, 3); chain > 0; chain--) {
    const hr2d_point first = point_between(r, step);
    hr2d_point at = first;
    for (int k = 1 + random_below(r, 4); k > 0; k--) {
      const hr2d_point next = point_near(r, step, at.x, at.y, .4);
      add(p, at, next);
      if (random_below(r, 4)) at = next;
    }
    if (random_below(r, 2)) add(p, at, first);
  }
}

/* i, j or an occluder; i with a probability of 1/n, and likewise j. */
static hr2d_segment one_of(randoms *r, const occluded_pair *p, int n) {
  const int on = random_below(r, n);
  if (on < 2) return on == 0 ? p->i : p->j;
  return p->occluder[random_below(r, (int)p->count)];
}

static void feet(randoms *r, double step, occluded_pair *p) {
  face(r, step, p);
  short_ones(r, step, p, 1 + random_below(r, 3));
  for (int k = 1 + random_below(r, 6); k > 0; k--) {
    const hr2d_point at = foot(r, one_of(r, p, 3));
    add(p, at, point_near(r, step, at.x, at.y, .5));
  }
}

static void crossed(randoms *r, double step, occluded_pair *p) {
  face(r, step, p);
  for (int k = 2 + random_below(r, 5); k > 0; k--) {
    const hr2d_point x = point_near(r, 0, .5, .5, .2);
    const double angle = random_between(r, 0, PI), s = random_between(r, .1, .5);
    const double c = s * cos(angle), d = s * sin(angle);
    add(p, point_near(r, step, x.x + c, x.y + d, 0), point_near(r, step, x.x - c, x.y - d, 0));
  }
}

static void partly_behind(randoms *r, double step, occluded_pair *p) {
  face(r, step, p);
  for (int k = 1 + random_below(r, 5); k > 0; k--) {
    const hr2d_point at = foot(r, random_below(r, 2) ? p->i : p->j);
    const hr2d_point a = point_near(r, step, at.x, at.y, .5);
    add(p, a, point_near(r, step, 2 * at.x - a.x, 2 * at.y - a.y, 0));
  }
  short_ones(r, step, p, random_below(r, 5));
}

/* One or both of the patches reach behind the other's line. */
static void over_the_horizon(randoms *r, double step, occluded_pair *p) {
  do {
    p->i = (hr2d_segment){point_near(r, step, 0, 0, .5), point_near(r, step, 1, .3, .5)};
    p->j = (hr2d_segment){point_near(r, step, .7, .3, .6), point_near(r, step, .3, .6, .6)};
  } while (hr2d_exchange_area(&p->i, &p->j) == 0);
  short_ones(r, step, p, 1 + random_below(r, 8));
  for (int k = random_below(r, 3); k > 0; k--)
    add(p, foot(r, random_below(r, 2) ? p->i : p->j), point_between(r, step));
}

static void corner(randoms *r, double step, occluded_pair *p) {
  do {
    const hr2d_point x = point_near(r, step, .2, .2, .2);
    p->i = (hr2d_segment){x, point_near(r, step, 1, 0, .3)};
    p->j = (hr2d_segment){point_near(r, step, 0, 1, .3), x};
  } while (hr2d_exchange_area(&p->i, &p->j) == 0);
  for (int k = random_below(r, 3); k > 0; k--) add(p, p->i.a, point_between(r, step));
  for (int k = random_below(r, 3); k > 0; k--)
    add(p, foot(r, random_below(r, 2) ? p->i : p->j), point_between(r, step));
  short_ones(r, step, p, 1 + random_below(r, 5));
}

/* Reaching far to one side: as in a lit slot between two walls. */
static void long_walls(randoms *r, double step, occluded_pair *p) {
  face(r, step, p);
  for (int k = 1 + random_below(r, 5); k > 0; k--) {
    const hr2d_point a = point_near(r, step, .5, .5, .4);
    const double reach = random_power(r, 0, 3) * (random_below(r, 2) ? 1 : -1);
    add(p, a, point_near(r, step, a.x + reach, a.y, .1 * fabs(reach)));
  }
  short_ones(r, step, p, random_below(r, 4));
}

/* Screens from side to side with one or two slits, of 1e-12 and more. */
static void slits(randoms *r, double step, occluded_pair *p) {
  (void)step;
  face(r, 0, p);
  for (int screen = 1 + random_below(r, 2); screen > 0; screen--) {
    const double y = random_between(r, .4, .6), tilt = random_between(r, -.1, .1);
    double from = -.4;
    for (int k = 1 + random_below(r, 2); k >= 0; k--) {
      const double to = k ? random_between(r, from + .1, 1) : 1.4;
      if (to <= from) break;
      add(p, (hr2d_point){from, y + tilt * (from - .5)},
          (hr2d_point){to, y + tilt * (to - .5)});
      from = to + random_power(r, -12, -1);
    }
  }
}

static void unequal(randoms *r, double step, occluded_pair *p) {
  (void)step;
  face(r, 0, p);
  const double size = random_power(r, -4, -1), t = random_unit(r);
  const hr2d_segment i = p->i;
  p->i.a = (hr2d_point){i.a.x + t * (i.b.x - i.a.x), i.a.y + t * (i.b.y - i.a.y)};
  p->i.b = (hr2d_point){p->i.a.x + size * (i.b.x - i.a.x), p->i.a.y + size * (i.b.y - i.a.y)};
  if (random_below(r, 2)) {
    const hr2d_segment w = p->i;
    p->i = p->j;
    p->j = w;
  }
  short_ones(r, 0, p, 1 + random_below(r, 8));
}

/* Along the lines of i, of j and of each other; exactly, for an ulp in front of i is in
   front of i. */
static void collinear(randoms *r, double step, occluded_pair *p) {
  step = fmax(step, 1.0 / 64);
  face(r, step, p);
  short_ones(r, step, p, 1 + random_below(r, 3));
  for (int k = 1 + random_below(r, 6); k > 0; k--) {
    const hr2d_segment w = one_of(r, p, 4);
    const int from = random_below(r, 33) - 8, to = random_below(r, 33) - 8;
    const double x = w.b.x - w.a.x, y = w.b.y - w.a.y;
    add(p, (hr2d_point){w.a.x + from * x / 16, w.a.y + from * y / 16},
        (hr2d_point){w.a.x + to * x / 16, w.a.y + to * y / 16});
  }
}

const occluded_class occluded_classes[] = {{"any occluders", any_occluders},
                                           {"attached to ends", attached},
                                           {"chains", chains},
                                           {"feet", feet},
                                           {"crossed", crossed},
                                           {"partly behind", partly_behind},
                                           {"horizon", over_the_horizon},
                                           {"corner", corner},
                                           {"long walls", long_walls},
                                           {"slits", slits},
                                           {"unequal", unequal},
                                           {"collinear", collinear}};
const int occluded_class_count = sizeof occluded_classes / sizeof *occluded_classes;

hr2d_point similar_point(similarity s, hr2d_point z) {
  return (hr2d_point){s.u * z.x - s.v * z.y + s.x, s.u * z.y + s.v * z.x + s.y};
}

hr2d_segment similar_segment(similarity s, hr2d_segment w) {
  return (hr2d_segment){similar_point(s, w.a), similar_point(s, w.b)};
}

occluded_pair similar_pair(similarity s, const occluded_pair *p) {
  occluded_pair q = {
      .i = similar_segment(s, p->i), .j = similar_segment(s, p->j), .count = p->count};
  for (size_t k = 0; k < p->count; k++) q.occluder[k] = similar_segment(s, p->occluder[k]);
  return q;
}

static similarity exact_turn(randoms *r) {
  const int p = random_below(r, 8) - 4, q = 1 + random_below(r, 4);
  return (similarity){p / 4.0, q / 4.0, 0, 0};
}

void draw_occluded(const occluded_class *class, randoms *r, occluded_pair *p) {
  static const double steps[] = {0.25, 1.0 / 64, 0};
  *p = (occluded_pair){.count = 0};
  class->draw(r, steps[random_below(r, 3)], p);
  if (random_below(r, 2)) *p = similar_pair(exact_turn(r), p);
  if (random_below(r, 2)) {
    const hr2d_segment i = p->i;
    p->i = p->j;
    p->j = i;
  }
}

double exchange_among(hr2d_segment i, hr2d_segment j, const hr2d_segment *occluder,
                      size_t count) {
  double area = -7;
  ck_assert_int_eq(hr2d_exchange_area_occluded(&i, &j, occluder, count, NULL, &area), HR2D_OK);
  return area;
}

static void print_segment(const char *name, hr2d_segment s) {
  fprintf(stderr, "  %s {{%a, %a}, {%a, %a}}\n", name, s.a.x, s.a.y, s.b.x, s.b.y);
}

void print_occluded(const occluded_pair *p) {
  print_segment("i", p->i);
  print_segment("j", p->j);
  for (size_t k = 0; k < p->count; k++) print_segment("w", p->occluder[k]);
}
