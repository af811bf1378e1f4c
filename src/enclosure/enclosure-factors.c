/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With u the place along the line of i, an end v of j at (t, h), h its distance from that line,
   appears under the sine s(u) = (t − u)/√((t − u)² + h²) against the normal of i, and

     F(u) = (s_a − s_b)/2 where that is positive, else 0: then u is behind j.

   An end behind the line of i gives way to the point where j crosses that line, which all of i
   sees at the sine 1 or −1.  Since ds/du = −h²/r³, the derivative of F vanishes where

     h_a^(4/3) r_b² = h_b^(4/3) r_a²,

   a quadratic equation.  So the ends of i and its roots have the extremes of F.

   Or F is near the straight line through its values at the ends of i.  The second derivative of
   G = h h′/(2r³) along the line of i, with h′ linear and |h′| ≤ r, is at most h (3 + 6h′/r)/r⁴,
   and so F differs from the line by at most |i|²/8 times |j| times that.

   Coordinates that are off by d turn the direction of v by d/r at most, each of the two points.
   What is so near to the line of i that it may lie on it does lie on it, as for commit. */
#include "enclosure/enclosure-factors.h"

#include <float.h>
#include <math.h>

#include "geometry/predicates.h"

/* Of the sines, and of the unit vector: some roundings of 1. */
#define SINES 0x1p-50

void hr2di_enclosed_init(hr2di_enclosed *e, hr2d_segment part, hr2d_segment patch,
                         unsigned level) {
  const double dx = patch.b.x - patch.a.x, dy = patch.b.y - patch.a.y;
  const double length = hypot(dx, dy);
  /* A rounding of coordinates below 2 for each level, and what counts as touching. */
  const double off = level * DBL_EPSILON + HR2DI_TOUCH;
  *e = (hr2di_enclosed){part, patch, dx / length, dy / length, length, off};
}

/* Where an end of j is as i sees it. */
typedef struct end {
  double t, h;
  int side; /* 1, −1: the sine everywhere on i; 0: by t and h; 2: unknown */
} end;

static double along(const hr2di_enclosed *i, hr2d_point v) {
  return (v.x - i->part.a.x) * i->dx + (v.y - i->part.a.y) * i->dy;
}

static double above(const hr2di_enclosed *i, hr2d_point v) {
  return hr2di_orient(i->patch.a, i->patch.b, v) / i->length;
}

/* The side of i on which the place t of its line is, known to within `off`. */
static int side_of(double t, double size, double off) {
  if (t <= -off) return -1;
  if (t >= size + off) return 1;
  /* Walls do not cross, so it is at an end of i, but for a part of i that is a rounding. */
  if (off > 0x1p-30 * size) return 2;
  return t <= off ? -1 : t >= size - off ? 1 : 2;
}

static void clip(end *v, const end *other, double size, double off) {
  if (v->h > off) return;
  if (v->h >= -off) {
    v->side = side_of(v->t, size, off);
    return;
  }
  const double rise = other->h - v->h, run = other->t - v->t;
  v->side = side_of(v->t - run * (v->h / rise), size, 4 * off * (1 + fabs(run) / rise));
}

static double sine(const end *v, double u) {
  if (v->side) return v->side;
  const double t = v->t - u;
  return t / sqrt(t * t + v->h * v->h);
}

/* What the direction of an end may turn by. */
static double turn(const end *v, double size, double off) {
  if (v->side) return 0;
  const double t = v->t < 0 ? v->t : v->t > size ? v->t - size : 0;
  return off / sqrt(t * t + v->h * v->h);
}

static double factor(const end *a, const end *b, double u) {
  return 0.5 * (sine(a, u) - sine(b, u));
}

static void include(hr2di_range *r, const end *a, const end *b, double u) {
  const double f = factor(a, b, u);
  r->lower = fmin(r->lower, f);
  r->upper = fmax(r->upper, f);
}

/* Where the derivative vanishes between 0 and `size`. */
static void include_roots(hr2di_range *r, const end *a, const end *b, double size) {
  if (a->side || b->side) return; /* F is monotone */
  const double ca = cbrt(a->h * a->h), cb = cbrt(b->h * b->h), p = ca * ca, q = cb * cb;
  const double two = p - q, one = p * b->t - q * a->t;
  const double zero = p * (b->t * b->t + b->h * b->h) - q * (a->t * a->t + a->h * a->h);
  const double square = one * one - two * zero;
  if (!(square > 0)) return;
  const double far = one + copysign(sqrt(square), one);
  const double root[2] = {far / two, zero / far};
  for (int k = 0; k < 2; k++)
    if (root[k] > 0 && root[k] < size) include(r, a, b, root[k]);
}

static double distance(const hr2di_enclosed *i, hr2d_point v) {
  const double t = along(i, v), size = along(i, i->part.b);
  return hypot(t < 0 ? t : t > size ? t - size : 0, above(i, v));
}

/* The smallest distance of two patches that do not cross is that of an end. */
static double min_distance(const hr2di_enclosed *i, const hr2di_enclosed *j) {
  return fmin(fmin(distance(i, j->part.a), distance(i, j->part.b)),
              fmin(distance(j, i->part.a), distance(j, i->part.b)));
}

/* What F may differ from a straight line; infinite where its derivative jumps. */
static double bend(const hr2di_enclosed *i, const hr2di_enclosed *j, double size, double high) {
  const double off = i->off + j->off, r = min_distance(i, j) - 2 * off;
  const double ga = above(j, i->part.a), gb = above(j, i->part.b);
  if (!(r > 4 * off) || ga < 0 || gb < 0) return INFINITY;
  const double length = along(j, j->part.b) + off, h = high + off;
  return (1 + 0x1p-40) * size * size / 8 * length * h * (3 + 6 * (fmax(ga, gb) + off) / r) /
         (r * r * r * r);
}

static hr2di_strip strip_of(hr2di_range a, hr2di_range b) {
  return (hr2di_strip){{a, b}};
}

static hr2di_range around(double value, double off) {
  return (hr2di_range){value - off, value + off};
}

hr2di_strip hr2di_factor_strip(const hr2di_enclosed *i, const hr2di_enclosed *j) {
  const hr2di_range any = {0, 1};
  const double off = i->off + j->off, size = along(i, i->part.b);
  end a = {along(i, j->part.a), above(i, j->part.a), 0};
  end b = {along(i, j->part.b), above(i, j->part.b), 0};
  const end given = a;
  const double high = fmax(a.h, b.h);
  if (high <= off) return strip_of(any, any);
  clip(&a, &b, size, off);
  clip(&b, &given, size, off);
  if (a.side == 2 || b.side == 2) return strip_of(any, any);
  hr2di_range r = {1, 0};
  include(&r, &a, &b, 0);
  include(&r, &a, &b, size);
  include_roots(&r, &a, &b, size);
  const double margin = SINES + turn(&a, size, off) + turn(&b, size, off);
  r = (hr2di_range){fmax(0, r.lower - margin), fmin(1, fmax(0, r.upper) + margin)};
  const double bent = margin + bend(i, j, size, high);
  const double at_a = factor(&a, &b, 0), at_b = factor(&a, &b, size);
  if (2 * bent < r.upper - r.lower && fmin(at_a, at_b) >= bent)
    return strip_of(around(at_a, bent), around(at_b, bent));
  return strip_of(r, r);
}

static double max_distance(hr2d_segment i, hr2d_segment j) {
  const double r =
      fmax(hypot(i.a.x - j.a.x, i.a.y - j.a.y), hypot(i.a.x - j.b.x, i.a.y - j.b.y));
  const double s =
      fmax(hypot(i.b.x - j.a.x, i.b.y - j.a.y), hypot(i.b.x - j.b.x, i.b.y - j.b.y));
  return fmax(r, s);
}

/* G = h h′/(2r³), with h and h′ the distances of the two points from the lines of the elements:
   these have their extremes at ends, and so has the smallest r, as patches do not cross. */
double hr2di_kernel_spread(const hr2di_enclosed *i, const hr2di_enclosed *j) {
  const double off = i->off + j->off;
  const double near = min_distance(i, j);
  const double lower = near - 2 * off, upper = max_distance(i->part, j->part) + 2 * off;
  if (!(lower > 0.5 * near)) return INFINITY;
  const double ha = above(i, j->part.a), hb = above(i, j->part.b);
  const double ga = above(j, i->part.a), gb = above(j, i->part.b);
  const double high = fmax(fmax(ha, hb) + off, 0) * fmax(fmax(ga, gb) + off, 0);
  const double low = fmax(fmin(ha, hb) - off, 0) * fmax(fmin(ga, gb) - off, 0);
  /* Roundings of these lines. */
  const double up = 1 + 64 * DBL_EPSILON, down = 1 - 64 * DBL_EPSILON;
  return up * high / (2 * lower * lower * lower) - down * low / (2 * upper * upper * upper);
}
