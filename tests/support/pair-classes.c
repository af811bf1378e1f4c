/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each class removes a property on which a formula might rely: size, distance, angle, a
   common scale, a common origin, general position. */
#include "support/pair-classes.h"

#include <math.h>

#include "geometry/predicates.h"
#include "support/plane.h"

#define PI 3.14159265358979323846

static hr2d_point random_point(randoms *r) {
  const double x = random_unit(r), y = random_unit(r);
  return (hr2d_point){x, y};
}

static hr2d_point nudged(randoms *r, hr2d_point p, int n) {
  p.x = random_nudge(r, p.x, n);
  p.y = random_nudge(r, p.y, n);
  return p;
}

static hr2d_point scaled(hr2d_point p, double s) {
  return (hr2d_point){s * p.x, s * p.y};
}

static pair scaled_pair(pair p, double s, double t) {
  return (pair){{scaled(p.i.a, s), scaled(p.i.b, s)}, {scaled(p.j.a, t), scaled(p.j.b, t)}};
}

static pair moved(pair p, double x, double y) {
  hr2d_point *points[4] = {&p.i.a, &p.i.b, &p.j.a, &p.j.b};
  for (int k = 0; k < 4; k++) points[k]->x += x, points[k]->y += y;
  return p;
}

static pair turned(pair p, double angle) {
  hr2d_point *points[4] = {&p.i.a, &p.i.b, &p.j.a, &p.j.b};
  const double c = cos(angle), s = sin(angle);
  for (int k = 0; k < 4; k++) {
    const hr2d_point q = *points[k];
    *points[k] = (hr2d_point){c * q.x - s * q.y, s * q.x + c * q.y};
  }
  return p;
}

/* Half of the pairs stay aligned with the axes. */
static pair perhaps_turned(randoms *r, pair p) {
  return random_below(r, 2) ? turned(p, random_between(r, 0, 2 * PI)) : p;
}

static pair generic(randoms *r) {
  const hr2d_point a = random_point(r), b = random_point(r), c = random_point(r);
  return (pair){{a, b}, {c, random_point(r)}};
}

/* A point 10^low to 10^high from another, in any direction. */
static hr2d_point step(randoms *r, hr2d_point from, double low, double high) {
  const double length = random_power(r, low, high);
  return plane_polar(from, length, random_between(r, 0, 2 * PI));
}

static pair far(randoms *r) {
  const hr2d_point a = random_point(r), c = step(r, a, 0, 8), b = step(r, a, -8, 0);
  return (pair){{a, b}, {c, step(r, c, -8, 0)}};
}

static pair gap(randoms *r) {
  const double d = random_power(r, -15, -1), tilt = d * random_between(r, -1, 1);
  const double left = random_between(r, -1, 1), right = left + random_power(r, -3, 0.3);
  return perhaps_turned(r, (pair){{{0, 0}, {1, 0}}, {{right, d + tilt}, {left, d}}});
}

/* Elements on nearly one line, one beside the other. */
static pair coplanar(randoms *r) {
  const double start = 1 + random_power(r, -3, 1), size = random_power(r, -3, 1);
  const double lift = random_power(r, -18, 0), slope = random_power(r, -18, 0);
  const int sign = random_below(r, 2) ? 1 : -1;
  return perhaps_turned(
      r, (pair){{{0, 0}, {1, 0}}, {{start, lift}, {start + size, lift + sign * slope * size}}});
}

static pair offset(randoms *r) {
  static const double sizes[] = {1, 1e-6};
  const double s = sizes[random_below(r, 2)], t = sizes[random_below(r, 2)];
  const pair p = random_below(r, 2) ? coplanar(r) : generic(r);
  return moved(scaled_pair(p, s, t), 1e8, random_below(r, 2) ? 1e8 : -3e7);
}

static pair one_scale(randoms *r) {
  const double s = random_below(r, 2) ? 1e150 : 1e-150;
  return scaled_pair(random_below(r, 2) ? coplanar(r) : generic(r), s, s);
}

/* A tiny segment near the origin beside a huge one, also one that starts there. */
static pair mixed_scales(randoms *r) {
  pair p = generic(r);
  if (random_below(r, 2)) p = turned(moved(p, -0.5, -0.5), random_unit(r));
  if (random_below(r, 3) == 0) p.i.a = (hr2d_point){0, 0};
  if (random_below(r, 4) == 0) p.j.b = p.i.a = (hr2d_point){0, 0};
  const double s = random_power(r, -100, 100), t = random_power(r, -100, 100);
  return scaled_pair(p, s, t);
}

static pair corner(randoms *r) {
  const hr2d_point x = random_below(r, 2) ? (hr2d_point){0, 0} : random_point(r);
  const double angle = random_below(r, 2) ? random_between(r, 0, PI) : random_power(r, -15, 0);
  const double first = random_between(r, 0, 2 * PI);
  const double s = random_power(r, -4, 4), t = random_power(r, -4, 4);
  return (pair){{x, plane_polar(x, s, first)}, {plane_polar(x, t, first + angle), x}};
}

static pair clipped(randoms *r) {
  for (;;) {
    const pair p = generic(r);
    if (hr2di_facing_of(&p.i, &p.j) == HR2DI_FACING_PART) return p;
  }
}

static pair clipped_by_ulps(randoms *r) {
  pair p = generic(r);
  if (random_below(r, 2)) p.i = (hr2d_segment){{0, 0}, {1, 0}};
  p.j.b = nudged(r, plane_along(p.i, random_between(r, -2, 3)), 1);
  return p;
}

static pair crossing(randoms *r) {
  const hr2d_point x = random_point(r);
  const double first = random_between(r, 0, 2 * PI);
  const double angle = random_below(r, 2) ? random_between(r, 0, PI) : random_power(r, -15, 0);
  const double s = random_power(r, -4, 0), t = random_power(r, -4, 0);
  const double back = -s * random_unit(r), beyond = -t * random_unit(r);
  return (pair){{plane_polar(x, back, first), plane_polar(x, s, first)},
                {plane_polar(x, t, first + angle), plane_polar(x, beyond, first + angle)}};
}

static pair denormal(randoms *r) {
  pair p = generic(r);
  const double s = ldexp(1, -1074 + random_below(r, 100));
  const double t = random_below(r, 3) ? s : ldexp(1, -1074 + random_below(r, 200));
  p = scaled_pair(p, 1024, 1024);
  hr2d_point *points[4] = {&p.i.a, &p.i.b, &p.j.a, &p.j.b};
  for (int k = 0; k < 4; k++) *points[k] = (hr2d_point){rint(points[k]->x), rint(points[k]->y)};
  return scaled_pair(p, s, t);
}

static pair collinear(randoms *r) {
  pair p = generic(r);
  p.j.a = nudged(r, plane_along(p.i, random_between(r, -2, 3)), 1);
  if (random_below(r, 2))
    p.j.b = nudged(r, plane_along(p.i, random_between(r, -2, 3)), 1);
  else if (random_below(r, 2))
    p.j.b = nudged(r, plane_along((hr2d_segment){p.j.a, p.i.a}, 0.3), 1);
  return p;
}

hr2d_segment random_descendant(randoms *r, hr2d_segment s, int levels) {
  for (; levels > 0; levels--) {
    const hr2d_point m = plane_middle(s);
    if (random_below(r, 2))
      s.a = m;
    else
      s.b = m;
  }
  return s;
}

static pair children(randoms *r) {
  static const double distances[] = {0.1, 1, 10};
  const double d = distances[random_below(r, 3)];
  pair p = generic(r);
  if (random_below(r, 3) == 0) p = (pair){{{0, 0}, {1, 0}}, {{1, d}, {0, d}}};
  if (random_below(r, 3) == 0) p = (pair){{{0, 0}, {1, 0}}, {{0, 1}, {0, 0}}};
  const int levels = random_below(r, 31);
  p.i = random_descendant(r, p.i, levels);
  p.j = random_descendant(r, p.j, levels);
  return p;
}

static pair slit(randoms *r) {
  const double d = 1e-12 * random_between(r, 0.5, 2);
  pair p = perhaps_turned(r, (pair){{{0, 0}, {1, 0}}, {{1, d}, {0, d}}});
  p.i = random_descendant(r, p.i, random_below(r, 25));
  p.j = random_descendant(r, p.j, random_below(r, 25));
  return p;
}

/* Coordinates so large that differences overflow, and others beside them. */
static pair whole_range(randoms *r) {
  const pair p = scaled_pair(moved(generic(r), -0.5, -0.5), 3.99, 3.99);
  const int below = random_below(r, 2) ? 0 : random_below(r, 1000);
  return scaled_pair(p, 0x1p+1023, ldexp(1, 1023 - below));
}

/* Every degenerate position there is. */
static pair lattice(randoms *r) {
  double x[8];
  for (int k = 0; k < 8; k++) x[k] = random_below(r, 4);
  return (pair){{{x[0], x[1]}, {x[2], x[3]}}, {{x[4], x[5]}, {x[6], x[7]}}};
}

static pair lattice_by_ulps(randoms *r) {
  pair p = lattice(r);
  if (random_below(r, 2)) p = moved(p, 0.1, 0);
  if (random_below(r, 2)) p = moved(p, 0, 1. / 3);
  const int n = 1 + random_below(r, 3);
  hr2d_point *points[4] = {&p.i.a, &p.i.b, &p.j.a, &p.j.b};
  for (int k = 0; k < 4; k++) *points[k] = nudged(r, *points[k], n);
  return p;
}

const pair_class pair_classes[] = {
    {"generic", generic, 6},
    {"far", far, 4},
    {"gap 1e-15 to 0.1", gap, 4},
    {"nearly coplanar", coplanar, 4},
    {"offset 1e8", offset, 4},
    {"scales 1e±150", one_scale, 4},
    {"mixed scales 1e±100", mixed_scales, 2},
    {"corner", corner, 6},
    {"clipped", clipped, 6},
    {"clipped by 1 ulp", clipped_by_ulps, 6},
    {"crossing", crossing, 6},
    {"denormal", denormal, 6},
    {"collinear ±1 ulp", collinear, 6},
    {"children to level 30", children, 6},
    {"slit of 1e-12", slit, 4},
    {"whole range", whole_range, 2},
    {"lattice", lattice, 6},
    {"lattice ±3 ulp", lattice_by_ulps, 6},
};
const int pair_class_count = sizeof pair_classes / sizeof pair_classes[0];

pair draw_pair(const pair_class *class, randoms *r) {
  pair p = class->draw(r);
  const int turns = random_below(r, 8) ? 4 : 0;
  for (int k = 0; k < turns && hr2di_facing_of(&p.i, &p.j) == HR2DI_FACING_NONE; k++) {
    hr2d_segment *s = k & 1 ? &p.j : &p.i;
    *s = (hr2d_segment){s->b, s->a};
  }
  return random_below(r, 2) ? p : (pair){p.j, p.i};
}
