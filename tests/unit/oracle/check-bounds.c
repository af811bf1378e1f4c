/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oracle `bounds` is above the error of a link, by brute force on random pairs, and no more
   above it than its definition says. */
#include <float.h>
#include <math.h>

#include "support/elements.h"
#include "support/plane.h"
#include "support/support.h"

enum { SAMPLES = 48, PAIRS = 10000 };

/* G by its definition; 0 where one point is behind the other segment. */
static double kernel(hr2d_segment i, hr2d_point x, hr2d_segment j, hr2d_point y) {
  const double dx = y.x - x.x, dy = y.y - x.y, r = hypot(dx, dy);
  const double hx = ((i.b.x - i.a.x) * dy - (i.b.y - i.a.y) * dx) / plane_length(i);
  const double hy = ((j.b.y - j.a.y) * dx - (j.b.x - j.a.x) * dy) / plane_length(j);
  return hx > 0 && hy > 0 ? hx * hy / (2 * r * r * r) : 0;
}

typedef struct sampled {
  double centre, mean;           /* G(x_c, y_c), and the mean of G */
  double least, most;            /* of all samples, ends and corners */
  double corners;                /* the range of the corners and the centre */
  double from_centre, from_mean; /* ∫∫ |G − …|: the errors of a link */
  double lengths;
} sampled;

/* Places from 0 to 1, at midpoints. */
static double place(int k) {
  return (k + 0.5) / SAMPLES;
}

static double kernel_at(const pair *p, double s, double t) {
  return kernel(p->i, plane_along(p->i, s), p->j, plane_along(p->j, t));
}

static void add_edges(const pair *p, sampled *e) {
  double low = e->centre, high = e->centre;
  for (int k = 0; k <= SAMPLES; k++)
    for (int side = 0; side < 4; side++) {
      const double along = (double)k / SAMPLES, end = side % 2;
      const double g = side < 2 ? kernel_at(p, along, end) : kernel_at(p, end, along);
      e->least = fmin(e->least, g);
      e->most = fmax(e->most, g);
      if (k > 0) continue;
      low = fmin(low, fmin(g, kernel_at(p, end, 1)));
      high = fmax(high, fmax(g, kernel_at(p, end, 1)));
    }
  low = fmin(low, fmin(kernel_at(p, 1, 0), kernel_at(p, 0, 1)));
  high = fmax(high, fmax(kernel_at(p, 1, 0), kernel_at(p, 0, 1)));
  e->corners = high - low;
}

/* ∫∫ |G − Gc| = AF − Gc A_x A_y + 2 ∫∫ (Gc − G)⁺, whose last integrand has no peaks. */
static sampled sample(const pair *p) {
  static double value[SAMPLES][SAMPLES];
  const double count = SAMPLES * SAMPLES, lengths = plane_length(p->i) * plane_length(p->j);
  sampled e = {.centre = kernel_at(p, 0.5, 0.5), .lengths = lengths};
  double below = 0;
  e.least = e.most = e.centre;
  for (int k = 0; k < SAMPLES; k++)
    for (int l = 0; l < SAMPLES; l++) {
      const double g = value[k][l] = kernel_at(p, place(k), place(l));
      e.mean += g / count;
      e.least = fmin(e.least, g);
      e.most = fmax(e.most, g);
    }
  for (int k = 0; k < SAMPLES; k++)
    for (int l = 0; l < SAMPLES; l++) {
      below += fmax(e.centre - value[k][l], 0) / count;
      e.from_mean += fabs(value[k][l] - e.mean) / count * lengths;
    }
  e.from_centre = hr2d_exchange_area(&p->i, &p->j) + lengths * (2 * below - e.centre);
  add_edges(p, &e);
  return e;
}

static hr2d_point random_point(randoms *r) {
  const double x = random_unit(r);
  return (hr2d_point){x, random_unit(r)};
}

/* In the unit square, of all lengths and directions; they do not cross, and see each other. */
static pair draw(randoms *r) {
  for (;;) {
    pair p;
    hr2d_segment *const both[] = {&p.i, &p.j};
    for (int k = 0; k < 2; k++) {
      const double length = exp2(-8 * random_unit(r)), angle = random_between(r, 0, 6.3);
      both[k]->a = random_point(r);
      both[k]->b =
          (hr2d_point){both[k]->a.x + length * cos(angle), both[k]->a.y + length * sin(angle)};
    }
    const int apart =
        hr2d_orientation(p.i.a, p.i.b, p.j.a) == hr2d_orientation(p.i.a, p.i.b, p.j.b) ||
        hr2d_orientation(p.j.a, p.j.b, p.i.a) == hr2d_orientation(p.j.a, p.j.b, p.i.b);
    if (apart && hr2d_exchange_area(&p.i, &p.j) > 0) return p;
  }
}

static double bound_of(const pair *p, int partial) {
  const unsigned char hidden = 1;
  const element_pair e = {.element = {element_of(p->i), element_of(p->j)}};
  hr2d_batch batch = element_batch(&e);
  if (partial) batch.partial = &hidden;
  return element_estimate(hr2d_oracle_bounds(), &batch);
}

typedef struct tally {
  int outside, half, corners, wide; /* errors above the bound, its half, that of the corners */
} tally;

static void compare(const pair *p, tally *t) {
  const sampled e = sample(p);
  const double bound = bound_of(p, 0), other = bound_of(&(pair){p->j, p->i}, 0);
  ck_assert_double_eq(bound, other);
  const double both = hr2d_exchange_area(&p->i, &p->j) + e.centre * e.lengths;
  const int is_range = bound < both * (1 - 1e-9);
  const double error = is_range ? fmax(e.from_centre, e.from_mean) : e.from_centre;
  t->outside += error > bound;
  t->half += error > bound / 2;
  t->corners += e.from_centre > e.corners * e.lengths;
  /* An obstacle hides a part of the pair, here all of it: ∫∫ |Gc − 0|. */
  ck_assert_double_ge(bound_of(p, 1), e.centre * e.lengths * (1 - 1e-12));
  ck_assert_double_ge(bound_of(p, 1), bound);
  /* Samples come close to the extremes; where they do not, G is steep, and AF + Gc A_x A_y is
     the bound. */
  const double exact = fmin((e.most - e.least) * e.lengths, both);
  ck_assert_double_ge(bound, exact * (1 - 1e-9));
  t->wide += bound > 1.05 * exact;
}

START_TEST(errors_are_within_their_bounds) {
  randoms r = randoms_stream(test_seed(), 4100);
  tally t = {0, 0, 0, 0};
  for (int k = 0; k < PAIRS; k++) {
    const pair p = draw(&r);
    compare(&p, &t);
  }
  printf("%d pairs: %d outside, %d of half of the bound, %d of the corners, %d wide\n", PAIRS,
         t.outside, t.half, t.corners, t.wide);
  ck_assert_int_eq(t.outside, 0);
  ck_assert_int_lt(t.wide, PAIRS / 50);
  /* Negative controls. */
  ck_assert_int_gt(t.half, PAIRS / 20);
  ck_assert_int_gt(t.corners, PAIRS / 100);
}
END_TEST

/* Closed forms: G of parallel unit segments at d is d²/(2(d² + x²)^(3/2)), x their shift. */
START_TEST(parallel_segments) {
  for (double d = 0.125; d <= 64; d *= 2) {
    const pair p = {{{0, 0}, {1, 0}}, {{1, d}, {0, d}}};
    const double high = 1 / (2 * d), low = d * d / (2 * pow(d * d + 1, 1.5));
    const double area = sqrt(1 + d * d) - d, expected = fmin(high - low, area + high);
    ck_assert_double_eq_tol(bound_of(&p, 0), expected, 1e-10 * high);
    ck_assert_double_eq_tol(bound_of(&p, 1), high, 1e-10 * high);
  }
}
END_TEST

/* In a corner G is unbounded, and the sum of both integrals is the bound. */
START_TEST(corners_are_finite) {
  const pair corner = {{{0, 0}, {1, 0}}, {{0, 1}, {0, 0}}};
  const double centre = 0.25 / (2 * pow(0.5, 1.5)), area = 1 - sqrt(0.5);
  ck_assert_double_eq_tol(bound_of(&corner, 0), area + centre, 1e-10);
  const pair behind = {corner.i, {corner.j.b, corner.j.a}};
  ck_assert_double_eq(bound_of(&behind, 0), 0);
  const pair crossing = {{{0, 0}, {1, 0}}, {{0.5, 0.5}, {0.5, -0.5}}};
  ck_assert(bound_of(&crossing, 0) == INFINITY);
  const pair back = {corner.i, {corner.i.b, corner.i.a}};
  ck_assert_double_eq(bound_of(&back, 0), 0);
}
END_TEST

START_TEST(any_unit_will_do) {
  randoms r = randoms_stream(test_seed(), 4200);
  for (int k = 0; k < 300; k++) {
    const pair p = draw(&r);
    for (int e = -900; e <= 900; e += 600) {
      pair q = p;
      hr2d_point *const point[] = {&q.i.a, &q.i.b, &q.j.a, &q.j.b};
      for (int m = 0; m < 4; m++)
        *point[m] = (hr2d_point){ldexp(point[m]->x, e), ldexp(point[m]->y, e)};
      const double bound = bound_of(&p, 0);
      ck_assert_double_eq_tol(ldexp(bound_of(&q, 0), -e), bound, 1e-12 * bound);
    }
  }
}
END_TEST

/* Tiny, flat, clipped, touching, crossing and far ones: above the exact error of l1. */
START_TEST(hard_pairs_are_bounded) {
  const pair_class *class = &pair_classes[_i];
  randoms r = randoms_stream(test_seed(), 4300 + _i);
  for (int k = 0; k < 300; k++) {
    double x[8];
    element_draw(class, &r, x);
    if (!element_in_range(x, 8, 400)) continue;
    const pair p = {{{x[0], x[1]}, {x[2], x[3]}}, {{x[4], x[5]}, {x[6], x[7]}}};
    const element_pair e = {.element = {element_of(p.i), element_of(p.j)}};
    const hr2d_batch batch = element_batch(&e);
    const double error = element_estimate(hr2d_oracle_l1(), &batch), bound = bound_of(&p, 0);
    ck_assert_msg(bound >= error * (1 - 1e-10) || error < DBL_MIN, "%s: %g is below %g",
                  class->name, bound, error);
  }
}
END_TEST

TEST_SUITE("bounds") {
  ADD_TESTS("the oracle bounds", errors_are_within_their_bounds, parallel_segments,
            corners_are_finite, any_unit_will_do);
  REPEAT_TESTS(pair_class_count, "the oracle bounds of hard pairs", hard_pairs_are_bounded);
}
