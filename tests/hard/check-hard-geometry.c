/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard cases of the exchange area and of the kernel.  Textbook formulas in doubles must be
   wrong here and the library must be right; both are compared with MPFR. */
#include <float.h>
#include <math.h>

#include "independent/mpfr-exchange.h"
#include "support/hard.h"
#include "support/pair-classes.h"
#include "support/plane.h"
#include "support/support.h"

/* The bounds of geometry.h, and the least error of a textbook formula. */
#define AREA   4e-15
#define KERNEL 3e-15
#define WRONG  1e-12

/* The error of a value, as a cell of the table. */
static hard_text describe(double value, const mpfr_t exact) {
  if (isnan(value)) return hard_format("NaN");
  if (isinf(value)) return hard_format("inf");
  if (mpfr_zero_p(exact))
    return value == 0 ? hard_format("0") : hard_format("%.1e for 0", value);
  if (value == 0) return hard_format("0");
  const double error = mpfr_double_error(value, exact);
  return value < 0 ? hard_format("negative") : hard_format("%.1e", error);
}

static void report(const char *part, const char *name, double textbook, double ours,
                   const mpfr_t exact, double bound) {
  const double wrong = mpfr_double_error(textbook, exact);
  const double error = mpfr_double_error(ours, exact);
  printf("%s, %s: textbook %g off by %.1e, ours %g off by %.1e\n", part, name, textbook, wrong,
         ours, error);
  ck_assert_msg(wrong > WRONG, "%s: the textbook is right: %g", name, textbook);
  ck_assert_msg(error <= bound, "%s: %g is off by %g", name, ours, error);
  hard_case(part, name, describe(textbook, exact), describe(ours, exact));
}

static double length(hr2d_point a, hr2d_point b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return sqrt(dx * dx + dy * dy);
}

/* Hottel's crossed strings as textbooks have them. */
static double crossed_strings(hr2d_segment i, hr2d_segment j) {
  return 0.5 * (length(i.a, j.a) + length(i.b, j.b) - length(i.a, j.b) - length(i.b, j.a));
}

static double clipped_strings(hr2d_segment i, hr2d_segment j) {
  return crossed_strings(plane_clipped(i, j), plane_clipped(j, i));
}

typedef struct area_case {
  const char *name;
  hr2d_segment i, j;
  int clip; /* the textbook cuts segments at horizons first */
} area_case;

#define SHIFT8  1e8
#define SHIFT15 1e15
#define SMALL   0x1p-20

static const area_case area_cases[] = {
    {"two patches of 1e-8 at 1e8", {{0, 0}, {1e-8, 0}}, {{1e-8, 1e8}, {0, 1e8}}, 0},
    {"elements of level 30 at distance 1",
     {{0.25, 0}, {0.25 + 0x1p-30, 0}},
     {{0.75 + 0x1p-30, 1}, {0.75, 1}},
     0},
    {"nearly coplanar, 1e-9 apart", {{0, 0}, {1, 0}}, {{2, 1e-9}, {3, 2e-9}}, 0},
    {"patches of 1e-6 at offset 1e8",
     {{SHIFT8, SHIFT8}, {SHIFT8 + SMALL, SHIFT8}},
     {{SHIFT8 + 0.5 + SMALL, SHIFT8 + 1}, {SHIFT8 + 0.5, SHIFT8 + 1}},
     0},
    {"across the horizon at offset 1e15",
     {{SHIFT15, SHIFT15}, {SHIFT15 + 3, SHIFT15 + 1}},
     {{SHIFT15 + 4, SHIFT15 - 1}, {SHIFT15 + 2, SHIFT15 + 2}},
     1},
    {"unit square in units of 1e160", {{0, 0}, {1e160, 0}}, {{1e160, 1e160}, {0, 1e160}}, 0},
    {"unit square in units of 1e-170",
     {{0, 0}, {1e-170, 0}},
     {{1e-170, 1e-170}, {0, 1e-170}},
     0},
    {"a patch of 1e-150 at the foot of one of 1e150",
     {{0, 0}, {1e-150, 0}},
     {{0, 1e150}, {0, 0}},
     0},
    {"coordinates from 1e-300 to 1e300",
     {{0, 0}, {1e300, 0}},
     {{1e300, 1e-300}, {1e299, 1e-300}},
     0},
    {"one ulp above the horizon", {{0, 0}, {1, 1. / 3}}, {{2, -1}, {2, 2. / 3 + 0x1p-53}}, 1},
    {"touching, 180 degrees less 1e-8", {{0, 0}, {1, 0}}, {{-1, 1e-8}, {0, 0}}, 0},
    {"touching, angle 1e-300", {{0, 0}, {1, 0}}, {{1e-150, 1e-300}, {0, 0}}, 0},
    {"a foot of 1e-9 on a unit wall", {{0, 0}, {1, 0}}, {{0.3, 0}, {0.3, 1e-9}}, 1},
    {"a point in place of a patch", {{0.1, 0.2}, {0.7, 0.3}}, {{0.25, 1.1}, {0.25, 1.1}}, 0},
    {"back to back, identical", {{0.1, 0.2}, {0.7, 0.3}}, {{0.7, 0.3}, {0.1, 0.2}}, 0},
    {"overlapping on one line", {{0, 0}, {2, 1}}, {{3, 1.5}, {1, 0.5}}, 0},
    {"one behind the other by an ulp",
     {{0, 1}, {1, 1}},
     {{1, 1 - 0x1p-53}, {0, 1 - 0x1p-53}},
     0},
    {"a wall of 2e300 over a unit patch", {{-0.5, 0}, {0.5, 0}}, {{1e300, 1}, {-1e300, 1}}, 0},
};

START_TEST(exchange_areas) {
  const area_case *c = &area_cases[_i];
  mpfr_t exact;
  mpfr_init2(exact, MPFR_PREC_MIN);
  mpfr_exchange_area(exact, &c->i, &c->j);
  const double ours = hr2d_exchange_area(&c->i, &c->j);
  ck_assert_double_eq(ours, hr2d_exchange_area(&c->j, &c->i));
  report("exchange area", c->name,
         c->clip ? clipped_strings(c->i, c->j) : crossed_strings(c->i, c->j), ours, exact,
         AREA);
  mpfr_clear(exact);
}
END_TEST

/* Relative errors mean nothing here: AF is the nearest subnormal number. */
START_TEST(subnormal_lengths) {
  const double step = DBL_TRUE_MIN;
  const hr2d_segment i = {{0, 0}, {100 * step, 0}},
                     j = {{100 * step, 50 * step}, {0, 50 * step}};
  const double exact = rint(50 * (sqrt(5) - 1)); /* in steps */
  ck_assert_double_eq(crossed_strings(i, j), 0);
  ck_assert_double_eq(hr2d_exchange_area(&i, &j), exact * step);
  hard_case("exchange area", "100 steps of the subnormal numbers long, 50 apart",
            hard_format("0"), hard_format("%g steps, exact: 61.8", exact));
}
END_TEST

/* Closed forms that need no MPFR: they confirm the errors reported above. */
START_TEST(closed_forms) {
  const hr2d_segment unit = {{-0.5, 0}, {0.5, 0}}, wall = {{1e300, 1}, {-1e300, 1}};
  ck_assert_double_eq_tol(hr2d_exchange_area(&unit, &wall), 1, AREA);
  const hr2d_segment floor = {{0, 0}, {1, 0}}, above = {{1, 0x1p-1074}, {0, 0x1p-1074}};
  ck_assert_double_eq(hr2d_exchange_area(&floor, &above), 1);
  const hr2d_segment under = {above.b, above.a}, below = {{1, -0x1p-1074}, {0, -0x1p-1074}};
  ck_assert_double_eq(hr2d_exchange_area(&floor, &under), 0);
  ck_assert_double_eq(hr2d_exchange_area(&floor, &below), 0);
  /* A wall that covers the whole sky receives all that a segment below it sends. */
  const hr2d_segment small = {{0, 0}, {3 * DBL_TRUE_MIN, 0}};
  ck_assert_double_eq(hr2d_exchange_area(&small, &wall), 3 * DBL_TRUE_MIN);
}
END_TEST

/* G by normals and dot products over r³. */
static double textbook_kernel(hr2d_segment i, hr2d_point x, hr2d_segment j, hr2d_point y) {
  const double li = length(i.a, i.b), lj = length(j.a, j.b), r = length(x, y);
  const double nx = -(i.b.y - i.a.y) / li, ny = (i.b.x - i.a.x) / li;
  const double mx = -(j.b.y - j.a.y) / lj, my = (j.b.x - j.a.x) / lj;
  const double hx = nx * (y.x - x.x) + ny * (y.y - x.y);
  const double hy = mx * (x.x - y.x) + my * (x.y - y.y);
  return fmax(hx, 0) * fmax(hy, 0) / (2 * (r * r * r));
}

typedef struct kernel_case {
  const char *name;
  hr2d_segment i;
  hr2d_point x;
  hr2d_segment j;
  hr2d_point y;
} kernel_case;

#define FACING(r)                                                                              \
  {{-(r), 0}, {(r), 0}}, {0, 0}, {{(r), (r)}, {-(r), (r)}}, {                                  \
    0, (r)                                                                                     \
  }

static const kernel_case kernel_cases[] = {
    {"r = 1e-110", FACING(1e-110)},
    {"r = 1e-160", FACING(1e-160)},
    {"r = 1e-300", FACING(1e-300)},
    {"r = 1e104", FACING(1e104)},
    {"r = 1e160", FACING(1e160)},
    {"r = 1e300", FACING(1e300)},
    {"a corner, r = 1e-200", {{0, 0}, {1, 0}}, {1e-200, 0}, {{0, 1}, {0, 0}}, {0, 1e-200}},
    {"one ulp above the horizon",
     {{0, 0}, {1, 1. / 3}},
     {0.5, 0.5 / 3},
     {{3, 0}, {3, 2}},
     {3, 1 + 0x1p-52}},
    {"both cosines below 1e-15",
     {{0, 0}, {3, 1}},
     {0.75, 0.25},
     {{9, 3 + 0x1p-51}, {12, 4 + 0x1p-50}},
     {9.75, 3.25 + 0x1p-51}},
    {"y on the horizon", {{0, 0}, {5, 1}}, {0.5, 0.1}, {{25, 0}, {25, 10}}, {25, 5}},
    {"x rounded off its own patch, y at 1e-15",
     {{0, 0}, {10, 10. / 3}},
     {7, 7. / 3},
     {{9, 3 + 1e-15}, {5, 5. / 3 + 1e-15}},
     {7, 7. / 3 + 1e-15}},
    {"x and y at offset 1e15, 1 apart",
     {{SHIFT15, SHIFT15}, {SHIFT15 + 3000, SHIFT15 + 1000}},
     {SHIFT15 + 1001, SHIFT15 + 333.625},
     {{SHIFT15 + 3000, SHIFT15 + 1001}, {SHIFT15, SHIFT15 + 1}},
     {SHIFT15 + 1000.625, SHIFT15 + 334.5}},
};

START_TEST(kernels) {
  const kernel_case *c = &kernel_cases[_i];
  mpfr_t exact;
  mpfr_init2(exact, MPFR_PREC_MIN);
  mpfr_kernel_of_lines(exact, &c->i, c->x, &c->j, c->y);
  const double ours = hr2d_kernel(&c->i, c->x, &c->j, c->y);
  ck_assert_double_eq(ours, hr2d_kernel(&c->j, c->y, &c->i, c->x));
  report("kernel", c->name, textbook_kernel(c->i, c->x, c->j, c->y), ours, exact, KERNEL);
  mpfr_clear(exact);
}
END_TEST

START_TEST(kernels_at_one_point) {
  const hr2d_segment floor = {{0, 0}, {1, 0}}, wall = {{0, 1}, {0, 0}}, back = {{1, 0}, {0, 0}};
  const hr2d_point corner = {0, 0};
  const double textbook = textbook_kernel(floor, corner, wall, corner);
  ck_assert(isnan(textbook));
  ck_assert_double_eq(hr2d_kernel(&floor, corner, &wall, corner), INFINITY);
  hard_case("kernel", "x = y in a corner, G = inf", hard_format("NaN"), hard_format("inf"));
  ck_assert(isnan(textbook_kernel(floor, corner, back, corner)));
  ck_assert_double_eq(hr2d_kernel(&floor, corner, &back, corner), 0);
  hard_case("kernel", "x = y back to back, G = 0", hard_format("NaN"), hard_format("0"));
}
END_TEST

TEST_SUITE("hard geometry") {
  REPEAT_TESTS(sizeof area_cases / sizeof *area_cases, "hard", exchange_areas);
  ADD_TESTS("hard", subnormal_lengths, closed_forms);
  REPEAT_TESTS(sizeof kernel_cases / sizeof *kernel_cases, "hard", kernels);
  ADD_TESTS("hard", kernels_at_one_point);
}
