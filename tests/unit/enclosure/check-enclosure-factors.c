/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What form factors of points are between, against angles in long double. */
#include <math.h>

#include "enclosure/enclosure-sweep.h"
#include "support/support.h"

typedef long double real;

static hr2d_point point_of(randoms *r) {
  return (hr2d_point){random_between(r, -1, 1), random_between(r, -1, 1)};
}

static hr2d_point between(hr2d_segment s, double t) {
  return (hr2d_point){s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
}

static int is_split(hr2d_segment s, hr2d_segment t) {
  return hr2d_orientation(s.a, s.b, t.a) * hr2d_orientation(s.a, s.b, t.b) < 0;
}

/* A pair of patches that do not cross: anywhere, at a corner, one on the other, nearly
 * parallel. */
static void draw_patches(randoms *r, int kind, hr2d_segment *i, hr2d_segment *j) {
  do {
    *i = (hr2d_segment){point_of(r), point_of(r)};
    *j = (hr2d_segment){point_of(r), point_of(r)};
    if (kind == 1) j->a = i->b;
    if (kind == 2) j->b = i->a;
    if (kind == 3) j->a = between(*i, random_unit(r));
    if (kind == 4) *j = (hr2d_segment){{i->b.x + 1e-3, i->b.y + 1e-3}, i->a};
  } while (is_split(*i, *j) && is_split(*j, *i));
}

/* A part of a patch as halving makes it. */
static hr2di_enclosed draw_part(randoms *r, hr2d_segment patch) {
  hr2d_segment part = patch;
  const int level = random_below(r, 9);
  for (int k = 0; k < level; k++) {
    const hr2d_point middle = between(part, 0.5);
    if (random_below(r, 2))
      part.a = middle;
    else
      part.b = middle;
  }
  hr2di_enclosed e;
  hr2di_enclosed_init(&e, part, patch, (unsigned)level);
  return e;
}

/* The angle of v at x against the normal of i, no further than the horizon. */
static real angle_of(hr2d_segment i, real x, real y, hr2d_point v) {
  const real dx = (real)i.b.x - i.a.x, dy = (real)i.b.y - i.a.y;
  const real t = (v.x - x) * dx + (v.y - y) * dy, h = (v.y - y) * dx - (v.x - x) * dy;
  return atan2l(t, h);
}

/* What a point of a part sees of j between the horizons of the patch, whose line the part has
   but for roundings, by the angles of both ends: j is less than half a turn wide, and one of
   its ends is in front. */
static real factor_at(const hr2di_enclosed *from, double t, hr2d_segment j) {
  const hr2d_segment i = from->part;
  const real x = i.a.x + t * ((real)i.b.x - i.a.x), y = i.a.y + t * ((real)i.b.y - i.a.y);
  const real side = ((real)j.b.x - j.a.x) * (y - j.a.y) - ((real)j.b.y - j.a.y) * (x - j.a.x);
  if (side <= 0) return 0;
  const real quarter = acosl(0);
  real a = angle_of(from->patch, x, y, j.a), b = angle_of(from->patch, x, y, j.b);
  if (fabsl(a) >= quarter && fabsl(b) >= quarter) return 0;
  const real width = fmodl(a - b + 8 * quarter, 4 * quarter);
  if (fabsl(b) < quarter)
    a = fminl(b + width, quarter);
  else
    b = fmaxl(a - width, -quarter);
  return 0.5L * (sinl(a) - sinl(b));
}

static double line_at(double a, double b, double u) {
  return a + u * (b - a);
}

/* How far a factor is outside of a strip. */
static double outside(const hr2di_strip *s, double u, real f) {
  return fmax((double)(line_at(s->at[0].lower, s->at[1].lower, u) - f),
              (double)(f - line_at(s->at[0].upper, s->at[1].upper, u)));
}

START_TEST(factors_are_inside) {
  randoms r = randoms_stream(test_seed(), _i);
  for (int turn = test_count(20000); turn > 0; turn--) {
    hr2d_segment p, q;
    draw_patches(&r, _i, &p, &q);
    const hr2di_enclosed i = draw_part(&r, p), j = draw_part(&r, q);
    const hr2di_strip s = hr2di_factor_strip(&i, &j);
    for (int k = 0; k <= 8; k++) {
      const double u = k < 2 ? 1e-9 + k * (1 - 2e-9) : random_unit(&r);
      const real f = factor_at(&i, u, j.part);
      ck_assert_msg(outside(&s, u, f) <= 0,
                    "turn %d: F = %.17Lg at %g is outside of %.17g..%.17g, %.17g..%.17g", turn,
                    f, u, s.at[0].lower, s.at[0].upper, s.at[1].lower, s.at[1].upper);
    }
  }
}
END_TEST

/* Strips that are lower by a thousandth do not hold. */
START_TEST(lower_factors_are_noticed) {
  randoms r = randoms_stream(test_seed(), 11);
  int noticed = 0;
  for (int turn = 0; turn < 1000; turn++) {
    hr2d_segment p, q;
    draw_patches(&r, 0, &p, &q);
    const hr2di_enclosed i = draw_part(&r, p), j = draw_part(&r, q);
    hr2di_strip s = hr2di_factor_strip(&i, &j);
    for (int k = 0; k < 2; k++) s.at[k].upper *= 0.999;
    for (int k = 0; k <= 8; k++)
      noticed += outside(&s, 0.125 * k, factor_at(&i, 0.125 * k, j.part)) > 0;
  }
  ck_assert_int_gt(noticed, 100);
}
END_TEST

/* Of two parallel elements, h long and 1 apart, a strip is as high as 2h³. */
START_TEST(strips_shrink_with_elements) {
  double before = 0;
  for (double h = 0.25; h > 1e-2; h *= 0.5) {
    const hr2d_segment a = {{1, 0}, {1 + h, 0}}, b = {{1.5 + h, 1}, {1.5, 1}};
    hr2di_enclosed i, j;
    hr2di_enclosed_init(&i, a, a, 0);
    hr2di_enclosed_init(&j, b, b, 0);
    const hr2di_strip s = hr2di_factor_strip(&i, &j);
    const double height = s.at[0].upper - s.at[0].lower;
    ck_assert_double_lt(height, 2 * h * h * h);
    if (before > 0) ck_assert_double_lt(height, before / 7);
    before = height;
  }
}
END_TEST

START_TEST(kernels_are_inside) {
  randoms r = randoms_stream(test_seed(), 12);
  for (int turn = test_count(20000); turn > 0; turn--) {
    hr2d_segment p, q;
    draw_patches(&r, turn % 5, &p, &q);
    const hr2di_enclosed i = draw_part(&r, p), j = draw_part(&r, q);
    const double spread = hr2di_kernel_spread(&i, &j);
    double min = INFINITY, max = 0;
    for (int k = 0; k < 20; k++) {
      const double g = hr2d_kernel(&i.part, between(i.part, random_unit(&r)), &j.part,
                                   between(j.part, random_unit(&r)));
      min = fmin(min, g);
      max = fmax(max, g);
    }
    ck_assert_double_le(max - min, spread);
  }
}
END_TEST

/* Of functions in strips: f = sin, B = a step, by sums. */
START_TEST(covariances_are_inside) {
  randoms r = randoms_stream(test_seed(), 13);
  for (int turn = 0; turn < 1000; turn++) {
    enum { POINTS = 1000 };
    const double a = random_unit(&r), b = random_unit(&r), c = 0.3 * random_unit(&r),
                 step = random_unit(&r), phase = 6 * random_unit(&r);
    const hr2di_strip f = {{{a - c, a + c}, {b - c, b + c}}};
    const hr2di_strip g = {{{b - 0.1, b + 0.1}, {a - 0.1, a + 0.1}}};
    double fg = 0, sum_f = 0, sum_g = 0;
    for (int k = 0; k < POINTS; k++) {
      const double u = (k + 0.5) / POINTS;
      const double at = line_at(a, b, u) + c * sin(20 * u + phase);
      const double it = line_at(b, a, u) + (u > step ? 0.1 : -0.1);
      fg += at * it / POINTS;
      sum_f += at / POINTS;
      sum_g += it / POINTS;
    }
    const hr2di_covariance is = hr2di_covariance_of(&f, &g);
    ck_assert_double_le(fabs(fg - sum_f * sum_g - is.value), is.off + 1e-5);
  }
}
END_TEST

TEST_SUITE("factors of enclosures") {
  REPEAT_TESTS(5, "factors", factors_are_inside);
  ADD_TESTS("factors", lower_factors_are_noticed, strips_shrink_with_elements,
            kernels_are_inside, covariances_are_inside);
}
