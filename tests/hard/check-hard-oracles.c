/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard cases of the oracles.  Textbook formulas in doubles must be wrong here, and the
   library must be right. */
#include <float.h>
#include <math.h>
#include <mpfr.h>
#include <stdlib.h>
#include <string.h>

#include "independent/mpfr-exchange.h"
#include "independent/mpfr-l1.h"
#include "support/elements.h"
#include "support/hard.h"
#include "support/pair-classes.h"
#include "support/plane.h"
#include "support/support.h"

#define WRONG 1e-8

/* The estimate of an oracle, in whose unit the segments are. */
static double ask(const hr2d_oracle *oracle, hr2d_segment i, hr2d_segment j,
                  double brightness) {
  const double bright[2] = {1, brightness};
  const element_pair p = {{element_of(i), element_of(j)}, bright};
  const hr2d_batch batch = element_batch(&p);
  return element_estimate(oracle, &batch);
}

/* Textbooks. */

static double textbook_r2(hr2d_segment i, hr2d_segment j) {
  const hr2d_point p = plane_middle(i), q = plane_middle(j);
  return (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
}

static double textbook_size(hr2d_segment i, hr2d_segment j) {
  return fmax(plane_length(i), plane_length(j)) / sqrt(textbook_r2(i, j));
}

static double textbook_size2(hr2d_segment i, hr2d_segment j) {
  const double a = fmax(plane_length(i), plane_length(j));
  return a * a / textbook_r2(i, j);
}

static double textbook_kernel(hr2d_segment i, hr2d_point x, hr2d_segment j, hr2d_point y) {
  const double dx = y.x - x.x, dy = y.y - x.y, r = sqrt(dx * dx + dy * dy);
  const double hx = ((i.b.x - i.a.x) * dy - (i.b.y - i.a.y) * dx) / plane_length(i);
  const double hy = ((j.b.y - j.a.y) * dx - (j.b.x - j.a.x) * dy) / plane_length(j);
  return hx * hy / (2 * r * r * r);
}

static double textbook_distance(hr2d_point p, hr2d_point q) {
  return sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
}

/* Crossed strings. */
static double textbook_bf(hr2d_segment i, hr2d_segment j, double brightness) {
  const double strings = textbook_distance(i.a, j.a) + textbook_distance(i.b, j.b) -
                         textbook_distance(i.a, j.b) - textbook_distance(i.b, j.a);
  return 0.5 * strings / fmin(plane_length(i), plane_length(j)) * brightness;
}

/* The midpoint rule on a grid. */
static double textbook_l1(hr2d_segment i, hr2d_segment j) {
  enum { SAMPLES = 256 };
  const double centre = textbook_kernel(i, plane_middle(i), j, plane_middle(j));
  double sum = 0;
  for (int k = 0; k < SAMPLES; k++)
    for (int l = 0; l < SAMPLES; l++) {
      const double s = (k + 0.5) / SAMPLES, t = (l + 0.5) / SAMPLES;
      const hr2d_point x = {i.a.x + s * (i.b.x - i.a.x), i.a.y + s * (i.b.y - i.a.y)};
      const hr2d_point y = {j.a.x + t * (j.b.x - j.a.x), j.a.y + t * (j.b.y - j.a.y)};
      sum += fabs(centre - fmax(textbook_kernel(i, x, j, y), 0));
    }
  return sum * (plane_length(i) / SAMPLES) * (plane_length(j) / SAMPLES);
}

/* Cells. */

static hard_text describe(double value, double exact) {
  if (isnan(value)) return hard_format("NaN");
  if (isinf(value)) return hard_format("inf");
  if (value == 0) return hard_format("0");
  return exact == 0 || isinf(exact) ? hard_format("%.1e", value)
                                    : hard_format("%.1e", fabs(value / exact - 1));
}

static void report(const char *name, double textbook, double ours, double exact, double bound) {
  const int same = textbook == exact;
  const double wrong = same ? 0 : fabs(textbook / exact - 1);
  const double error = ours == exact ? 0 : fabs(ours / exact - 1);
  printf("%s: textbook %g off by %.1e, ours %g off by %.1e\n", name, textbook, wrong, ours,
         error);
  ck_assert_msg(!(wrong <= WRONG), "%s: the textbook is right: %g", name, textbook);
  ck_assert_msg(error <= bound, "%s: %g is off by %g", name, ours, error);
  hard_case("oracle", name, describe(textbook, exact), describe(ours, exact));
}

#define ROUNDING 0x1p-53

static const hr2d_segment flat = {{0, 0}, {1, 0}};

START_TEST(sizes) {
  const hr2d_segment i = {{0, 0}, {1e-170, 0}}, j = {{1e-170, 1e-170}, {0, 1e-170}};
  report("size, elements of 1e-170, 1e-170 apart", textbook_size(i, j),
         ask(hr2d_oracle_size(), i, j, 1), 1, 5 * ROUNDING);
  report("size2, elements of 1e-170, 1e-170 apart", textbook_size2(i, j),
         ask(hr2d_oracle_size2(), i, j, 1), 1, 10 * ROUNDING);
  const double step = DBL_TRUE_MIN;
  const hr2d_segment k = {{0, 0}, {8 * step, 0}}, l = {{8 * step, 2 * step}, {0, 2 * step}};
  report("size, 8 subnormal steps long, 2 apart", textbook_size(k, l),
         ask(hr2d_oracle_size(), k, l, 1), 4, 5 * ROUNDING);
  const hr2d_segment near = {{0.5 + 1e-165, 1e-165}, {0.5 - 1e-165, 1e-165}};
  report("size, lengths 1 and 2e-165, 1e-165 apart", textbook_size(flat, near),
         ask(hr2d_oracle_size(), flat, near, 1), 1e165, 5 * ROUNDING);
}
END_TEST

/* Both sides of one patch, patches that cross in their middles: there is no r. */
START_TEST(centres_that_coincide) {
  const hr2d_segment back = {flat.b, flat.a}, across = {{0.5, 0.5}, {0.5, -0.5}};
  const hr2d_segment pairs[] = {back, across};
  for (int k = 0; k < 2; k++) {
    ck_assert(ask(hr2d_oracle_size(), flat, pairs[k], 1) == INFINITY);
    ck_assert(ask(hr2d_oracle_size2(), flat, pairs[k], 1) == INFINITY);
    ck_assert(isnan(textbook_l1(flat, pairs[k])));
  }
  const hr2d_segment tiny = {{0.5, 0}, {0.5, 0}};
  ck_assert(isnan(textbook_size(tiny, tiny)));
  /* patches that do not see each other have no error */
  ck_assert(ask(hr2d_oracle_l1(), flat, back, 1) == 0);
  ck_assert(ask(hr2d_oracle_l1(), flat, across, 1) == INFINITY);
  hard_case("oracle", "l1, crossing in the centres", hard_format("NaN"), hard_format("inf"));
  hard_case("oracle", "l1, back to back", hard_format("NaN"), hard_format("0"));
  ck_assert(ask(hr2d_oracle_bf(), flat, back, 1) == 0);
  ck_assert(ask(hr2d_oracle_bf(), flat, across, 0) == 0);
  /* each has half of itself in front of the other: the sides of a right corner */
  report("bf, crossing in the centres", textbook_bf(flat, across, 1),
         ask(hr2d_oracle_bf(), flat, across, 1), (1 - sqrt(0.5)) / 2, 39 * ROUNDING);
}
END_TEST

START_TEST(grazing_form_factors) {
  const double slope = 1. / 3, h = 0x1p-40;
  const hr2d_segment i = {{0, 0}, {1, slope}}, j = {{8, 8 * slope + h}, {7, 7 * slope + h}};
  mpfr_t area;
  mpfr_init2(area, MPFR_PREC_MIN);
  mpfr_exchange_area(area, &i, &j);
  const double exact = mpfr_get_d(area, MPFR_RNDN) / fmin(plane_length(i), plane_length(j));
  mpfr_clear(area);
  report("bf, cosines of 1e-13", textbook_bf(i, j, 1), ask(hr2d_oracle_bf(), i, j, 1), exact,
         48 * ROUNDING);
  const hr2d_segment far = {{1e160, 1e160}, {0, 1e160}}, near = {{0, 0}, {1e160, 0}};
  const double unit = 0x1p+530;
  const hr2d_segment a = {{0, 0}, {1e160 / unit, 0}};
  const hr2d_segment b = {{1e160 / unit, 1e160 / unit}, {0, 1e160 / unit}};
  report("bf, unit square in units of 1e160", textbook_bf(near, far, 1),
         ask(hr2d_oracle_bf(), a, b, 1), sqrt(2) - 1, 39 * ROUNDING);
}
END_TEST

/* A decision with ε equal to an estimate, or next to it: a² ≤ ε²r² in doubles decides by its
   roundings, and not as max(A)/r ≤ ε would. */
START_TEST(image_map) {
  randoms r = randoms_stream(test_seed(), 8100);
  const int count = test_multiplier() < 0.1 ? 1000 : 10000;
  int textbook = 0, ours = 0;
  for (int k = 0; k < count; k++) {
    const hr2d_segment i = {{random_unit(&r), random_unit(&r)},
                            {random_unit(&r), random_unit(&r)}};
    const hr2d_segment j = {{random_unit(&r), random_unit(&r)},
                            {random_unit(&r), random_unit(&r)}};
    const element_pair p = {{element_of(i), element_of(j)}, NULL};
    const hr2d_batch batch = element_batch(&p);
    const double value = ask(hr2d_oracle_size(), i, j, 1),
                 a = fmax(plane_length(i), plane_length(j));
    for (int m = 0; m < 2; m++) {
      const double epsilon = m ? nextafter(value, 0) : value;
      ours += element_accepted(hr2d_oracle_size(), &batch, epsilon) != (m == 0);
      textbook += (a * a <= epsilon * epsilon * textbook_r2(i, j)) != (m == 0);
    }
  }
  ck_assert_int_eq(ours, 0);
  ck_assert_int_gt(textbook, count / 20);
  hard_case("oracle", "size, decisions at equality with eps",
            hard_format("%.0f%% wrong", 50. * textbook / count), hard_format("none wrong"));
}
END_TEST

/* Elements that touch never reach max(A)/r ≤ ½, at any depth.  The recursion of the library
   ends where doubles can no longer be halved. */
START_TEST(touching_pairs) {
  double a = 1, b = 1;
  int halvings = 0;
  for (; halvings < 4000 && a > 0 && fmax(a, b) / hypot(0.5 * a, 0.5 * b) > 0.5; halvings++)
    *(a >= b ? &a : &b) *= 0.5;
  ck_assert_int_ge(halvings, 2000);
  const double patches[2][6] = {{0, 0, 1, 0, 1, 0.5}, {0, 1, 0, 0, 1, 0.5}};
  test_links t = test_make_links(test_scene(patches, 2), NULL, NULL, NULL, NULL);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 0.5;
  options.max_level = 60000;
  hr2d_refine_counts counts;
  ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_OK);
  ck_assert_uint_ge(counts.levels, 1000);
  ck_assert_uint_gt(counts.limited_links, 0);
  ck_assert_uint_lt(counts.limited_links, 10);
  hard_case("oracle", "size of touching patches, no depth allowed for",
            hard_format("no end but length 0"),
            hard_format("ends on level %u, %u links limited", counts.levels,
                        (unsigned)counts.limited_links));
  test_free_links(&t);
}
END_TEST

typedef struct l1_case {
  const char *name;
  hr2d_segment i, j;
} l1_case;

static const l1_case l1_cases[] = {
    {"l1, 1e7 apart", {{0, 0}, {1, 0}}, {{1, 1e7}, {0, 1e7}}},
    {"l1, elements of 2^-30 at distance 1",
     {{0, 0}, {0x1p-30, 0}},
     {{0.25 + 0x1p-30, 1}, {0.25, 1}}},
    {"l1, kinks: G = Gc across the pair", {{0, 0}, {1, 0}}, {{1.5, 0.25}, {0.25, 0.75}}},
    {"l1, G = Gc touches an edge", {{0, 0}, {1, 0}}, {{0.75, 0.5}, {0.25, 0.5}}},
    {"l1, a slit of 1e-6", {{0, 0}, {1, 0}}, {{1, 1e-6}, {0, 1e-6}}},
    {"l1, a right corner", {{0, 0}, {1, 0}}, {{0, 1}, {0, 0}}},
    {"l1, a corner of 0.1 rad", {{0, 0}, {1, 0}}, {{1, 0.1}, {0, 0}}},
    {"l1, half behind the horizon", {{0, 0}, {1, 0}}, {{1.5, -0.25}, {0.5, 1}}},
    {"l1, a right corner of 1e150", {{0, 0}, {1e150, 0}}, {{0, 1e150}, {0, 0}}},
    {"l1, a right corner of 1e-150", {{0, 0}, {1e-150, 0}}, {{0, 1e-150}, {0, 0}}},
    {"l1, a corner of lengths 1 and 1e-9", {{0, 0}, {1, 0}}, {{-1e-9, 1e-9}, {0, 0}}},
    {"l1, a corner of lengths 1 and 1e-70", {{0, 0}, {1, 0}}, {{-1e-70, 1e-70}, {0, 0}}},
    {"l1, crossing off the centres", {{0, 0}, {1, 0}}, {{0.25, 1}, {0.25, -0.5}}},
};

START_TEST(l1_errors) {
  const l1_case *c = &l1_cases[_i];
  if (test_multiplier() < 0.1 && strstr(c->name, "1e-70")) return; /* seconds in MPFR */
  const double exact = mpfr_l1(&c->i, &c->j, 1e-12);
  report(c->name, textbook_l1(c->i, c->j), ask(hr2d_oracle_l1(), c->i, c->j, 1), exact, 1e-10);
}
END_TEST

TEST_SUITE("hard oracles") {
  ADD_TESTS("hard", sizes, centres_that_coincide, grazing_form_factors, image_map,
            touching_pairs);
  REPEAT_TESTS(sizeof l1_cases / sizeof *l1_cases, "hard", l1_errors);
}
