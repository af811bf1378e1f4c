/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The L¹ oracles against nested adaptive quadrature, closed forms, reference values
   and the counts of the paper's experiment. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/predicates.h"
#include "oracle/l1-grid.h"
#include "oracle/l1.h"
#include "support/elements.h"
#include "support/order.h"
#include "support/pair-classes.h"
#include "support/plane.h"
#include "support/support.h"

/* Nested quadrature: G/Gc − 1 in long double, each line split where it changes its
   sign, at maxima, at the horizon, and geometrically about the foot of y. */

enum { LIMIT = 2000, MOST_SPLITS = 400 };

typedef long double real;

typedef struct line {
  real x, y, ux, uy, length; /* start, direction */
} line;

/* i starts at its a and j, backwards, at its b: places near a shared corner are small
   numbers. */
typedef struct nested {
  line i, j;
  real centre, t; /* Gc; where y is, from 0 to 1 */
  gsl_integration_workspace *outer, *inner;
} nested;

static line line_between(hr2d_point a, hr2d_point b) {
  const real dx = (real)b.x - a.x, dy = (real)b.y - a.y, length = hypotl(dx, dy);
  return (line){a.x, a.y, dx / length, dy / length, length};
}

static nested nested_of(const hr2d_segment *i, const hr2d_segment *j) {
  return (nested){.i = line_between(i->a, i->b), .j = line_between(j->b, j->a)};
}

/* From x to y, and the distances of each from the line of the other. */
typedef struct line_class {
  real dx, dy, r, before_i, before_j;
} line_class;

static line_class sight_at(const nested *n, real s, real t) {
  const line *i = &n->i, *j = &n->j;
  s *= i->length;
  t *= j->length;
  line_class v = {.dx = j->x - i->x + (t * j->ux - s * i->ux),
                  .dy = j->y - i->y + (t * j->uy - s * i->uy)};
  v.r = hypotl(v.dx, v.dy);
  v.before_i = i->ux * v.dy - i->uy * v.dx;
  v.before_j = j->ux * v.dy - j->uy * v.dx;
  return v;
}

static real kernel_at(const nested *n, real s, real t) {
  const line_class v = sight_at(n, s, t);
  if (!(v.before_i > 0 && v.before_j > 0)) return 0;
  return v.before_i / v.r * (v.before_j / v.r) / (2 * v.r);
}

static double deviation(double s, void *params) {
  const nested *n = params;
  return (double)fabsl(kernel_at(n, s, n->t) / n->centre - 1);
}

static int sign_change(const nested *n, double low, double high, double *root) {
  const int sign = kernel_at(n, low, n->t) > n->centre;
  if ((kernel_at(n, high, n->t) > n->centre) == sign) return 0;
  while (high - low > 1e-15 * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    if ((kernel_at(n, middle, n->t) > n->centre) == sign)
      low = middle;
    else
      high = middle;
  }
  *root = low;
  return 1;
}

/* A maximum between low and high, by golden section. */
static double find_maximum(const nested *n, double low, double high) {
  const double part = 0.61803398874989485;
  for (int k = 0; k < 60; k++) {
    const double left = high - part * (high - low), right = low + part * (high - low);
    if (kernel_at(n, left, n->t) > kernel_at(n, right, n->t))
      high = right;
    else
      low = left;
  }
  return 0.5 * (low + high);
}

/* Beyond the ends there is nothing, so that a maximum next to an end is found. */
static int add_maxima(const nested *n, double *found, int count) {
  enum { SAMPLES = 4 };
  const int last = SAMPLES * (count - 1), old = count;
  double at[3] = {found[0], found[0], found[0]};
  real value[3] = {-1, -1, -1};
  for (int k = 0; k <= last + 1; k++) {
    const int m = k / SAMPLES, next = m + 1 < old ? m + 1 : m;
    at[0] = at[1], at[1] = at[2], value[0] = value[1], value[1] = value[2];
    if (k <= last) at[2] = found[m] + (found[next] - found[m]) * (k % SAMPLES) / SAMPLES;
    value[2] = k <= last ? kernel_at(n, at[2], n->t) : -1;
    if (value[1] > value[0] && value[1] >= value[2])
      found[count++] = find_maximum(n, at[0], at[2]);
  }
  qsort(found, (size_t)count, sizeof *found, order_doubles);
  return count;
}

static int find_splits(const nested *n, double *at) {
  const line *i = &n->i, *j = &n->j;
  const real yx = j->x + n->t * j->length * j->ux - i->x;
  const real yy = j->y + n->t * j->length * j->uy - i->y;
  const real foot = (yx * i->ux + yy * i->uy) / i->length;
  const real height = fabsl(i->ux * yy - i->uy * yx) / i->length;
  const real across = i->ux * j->uy - i->uy * j->ux;
  const real horizon = ((j->x - i->x) * j->uy - (j->y - i->y) * j->ux) / (across * i->length);
  double found[MOST_SPLITS] = {0, 1};
  int count = 2, sorted;
  if (horizon > 0 && horizon < 1) found[count++] = (double)horizon;
  if (foot > 0 && foot < 1) found[count++] = (double)foot;
  for (real step = height / 2; step < 2 && count < 100; step *= 4) {
    if (foot + step > 0 && foot + step < 1) found[count++] = (double)(foot + step);
    if (foot - step > 0 && foot - step < 1) found[count++] = (double)(foot - step);
  }
  qsort(found, (size_t)count, sizeof *found, order_doubles);
  sorted = count = add_maxima(n, found, count);
  for (int k = 0; k + 1 < sorted; k++)
    for (int m = 0; m < 3; m++) {
      const double step = (found[k + 1] - found[k]) / 3, low = found[k] + m * step;
      count += sign_change(n, low, m < 2 ? low + step : found[k + 1], &found[count]);
    }
  qsort(found, (size_t)count, sizeof *found, order_doubles);
  memcpy(at, found, (size_t)count * sizeof *found);
  return count;
}

static double inner_integral(double t, void *params) {
  nested *n = params;
  const gsl_function f = {deviation, n};
  double at[MOST_SPLITS], sum = 0;
  n->t = t;
  const int count = find_splits(n, at);
  for (int k = 0; k + 1 < count; k++) {
    double value, error;
    if (!(at[k + 1] - at[k] > 1e-15 * at[k + 1])) continue;
    gsl_integration_qag(&f, at[k], at[k + 1], 1e-30, 1e-12, LIMIT, GSL_INTEG_GAUSS21, n->inner,
                        &value, &error);
    sum += value;
  }
  return sum;
}

/* The error of a pair with Gc > 0. */
static double nested_l1(const hr2d_segment *i, const hr2d_segment *j, double tolerance,
                        int pieces) {
  nested n = nested_of(i, j);
  const gsl_function f = {inner_integral, &n};
  n.centre = kernel_at(&n, 0.5, 0.5);

  n.outer = gsl_integration_workspace_alloc(LIMIT);
  n.inner = gsl_integration_workspace_alloc(LIMIT);
  /* A corner is found, and so is a horizon, by bisection about the ends. */
  double value, error;
  real sum = 0;
  const real across = n.i.ux * n.j.uy - n.i.uy * n.j.ux;
  const real cut =
      ((n.i.x - n.j.x) * n.i.uy - (n.i.y - n.j.y) * n.i.ux) / (-across * n.j.length);
  const double middle = cut > 0 && cut < 1 ? (double)cut : 0.5;
  /* The estimate of an adaptive rule's error misses kinks of a derivative in intervals
     that are not small. */
  for (int k = -pieces; k < pieces; k++) {
    const double from = k < 0 ? middle : 1 - middle, low = pow((double)abs(k) / pieces, 1.5);
    const double high = pow((double)abs(k + 1) / pieces, 1.5);
    gsl_integration_qag(&f, middle + (k < 0 ? -low : low) * from,
                        middle + (k < 0 ? -high : high) * from, 0, tolerance, LIMIT,
                        GSL_INTEG_GAUSS31, n.outer, &value, &error);
    sum += value;
  }
  gsl_integration_workspace_free(n.outer);
  gsl_integration_workspace_free(n.inner);
  return (double)(sum * n.centre * n.i.length * n.j.length);
}

/* Mirrored, so that the order of integration changes and a shared corner stays at the
   starts. */
static double nested_mirrored(const hr2d_segment *i, const hr2d_segment *j, double tolerance,
                              int pieces) {
  const hr2d_segment mi = {{-i->b.x, i->b.y}, {-i->a.x, i->a.y}};
  const hr2d_segment mj = {{-j->b.x, j->b.y}, {-j->a.x, j->a.y}};
  return nested_l1(&mj, &mi, tolerance, pieces);
}

/* Two orders that agree to 3e-11, on as many pieces as that takes. */
static double settled_l1(const hr2d_segment *i, const hr2d_segment *j) {
  for (int pieces = 4; pieces <= 256; pieces *= 2) {
    const double value = nested_l1(i, j, 1e-11, pieces);
    const double other = nested_mirrored(i, j, 1e-11, pieces);
    if (fabs(value - other) <= 3e-11 * value) return 0.5 * (value + other);
  }
  ck_abort_msg("nested quadrature does not settle");
  return NAN;
}

/* Pairs whose centres see each other. */

#define PI 3.14159265358979323846

static pair any_pair(randoms *r) {
  const double x = random_unit(r), y = random_unit(r), a = random_between(r, 0, 2 * PI);
  const double s = random_power(r, -1, 0), t = random_power(r, -1, 0);
  const hr2d_point p = {x, y}, q = plane_polar(p, 1.5, a);
  const double b = random_between(r, 0, 2 * PI), c = random_between(r, 0, 2 * PI);
  return (pair){{p, plane_polar(p, s, b)}, {q, plane_polar(q, t, c)}};
}

static pair corner_pair(randoms *r) {
  const hr2d_point p = {random_unit(r), random_unit(r)};
  const double first = random_between(r, 0, 2 * PI), angle = random_between(r, 0.05, 3);
  const double s = random_power(r, -1, 0), t = random_power(r, -1, 0);
  return (pair){{p, plane_polar(p, s, first)}, {plane_polar(p, t, first + angle), p}};
}

static pair half_pair(randoms *r) {
  for (;;) {
    const pair p = any_pair(r);
    if (hr2di_facing_of(&p.i, &p.j) == HR2DI_FACING_PART) return p;
  }
}

static pair tiny_pair(randoms *r) {
  static const double distances[] = {0.1, 1, 10};
  const double d = distances[random_below(r, 3)];
  pair p = random_below(r, 2) ? any_pair(r) : (pair){{{0, 0}, {1, 0}}, {{1, d}, {0, d}}};
  const int levels = random_below(r, 25);
  return (pair){random_descendant(r, p.i, levels),
                random_descendant(r, p.j, levels + random_below(r, 2))};
}

static pair far_pair(randoms *r) {
  const hr2d_point p = {random_unit(r), random_unit(r)};
  const hr2d_point q = plane_polar(p, random_power(r, 1, 6), random_between(r, 0, 2 * PI));
  const double b = random_between(r, 0, 2 * PI), c = random_between(r, 0, 2 * PI);
  return (pair){{p, plane_polar(p, 1, b)}, {q, plane_polar(q, random_power(r, -3, 0), c)}};
}

static pair thin_pair(randoms *r) {
  const double d = random_power(r, -4, -1), tilt = d * random_between(r, -0.9, 0.9);
  const double left = random_between(r, -0.9, 0.9), right = left + random_power(r, -1, 0);
  return (pair){{{0, 0}, {1, 0}}, {{right, d + tilt}, {left, d}}};
}

static const struct {
  const char *name;
  pair (*draw)(randoms *r);
} kinds[] = {{"any", any_pair},   {"corner", corner_pair}, {"half-facing", half_pair},
             {"tiny", tiny_pair}, {"far", far_pair},       {"thin", thin_pair}};
enum { KINDS = sizeof kinds / sizeof *kinds };

static double centre_kernel(const pair *p) {
  const hr2d_point x = {0.5 * (p->i.a.x + p->i.b.x), 0.5 * (p->i.a.y + p->i.b.y)};
  const hr2d_point y = {0.5 * (p->j.a.x + p->j.b.x), 0.5 * (p->j.a.y + p->j.b.y)};
  return hr2d_kernel(&p->i, x, &p->j, y);
}

static pair draw_kind(int kind, randoms *r) {
  for (;;) {
    const pair p = kinds[kind].draw(r);
    if (centre_kernel(&p) > 1e-12) return p;
  }
}

#define assert_close(x, y, bar)                                                                \
  ck_assert_msg(fabs((x) - (y)) <= (bar)*fabs(y), "%.17g is not %.17g: off by %.2g", x, y,     \
                fabs((x) / (y)-1))

/* The integral without its absolute value: the result of code that loses the sign. */
static double signed_error(const pair *p) {
  return fabs(hr2d_exchange_area(&p->i, &p->j) -
              centre_kernel(p) * plane_length(p->i) * plane_length(p->j));
}

START_TEST(nested_quadrature) {
  randoms r = randoms_stream(test_seed(), _i);
  const int count = test_count(170);
  double worst = 0;
  int told_apart = 0;
  for (int k = 0; k < count; k++) {
    const pair p = draw_kind(_i, &r);
    const double value = hr2di_l1(&p.i, &p.j), expected = settled_l1(&p.i, &p.j);
    ck_assert_msg(fabs(value - expected) <= 1e-10 * expected,
                  "%s pair %d of seed %lu: %.17g is not %.17g, off by %.2g: "
                  "%a %a %a %a  %a %a %a %a",
                  kinds[_i].name, k, test_seed(), value, expected, value / expected - 1,
                  p.i.a.x, p.i.a.y, p.i.b.x, p.i.b.y, p.j.a.x, p.j.a.y, p.j.b.x, p.j.b.y);
    worst = fmax(worst, fabs(value / expected - 1));
    told_apart += fabs(signed_error(&p) - expected) > 1e-3 * expected;
  }
  printf("%s: %d pairs, within %.1e\n", kinds[_i].name, count, worst);
  ck_assert_int_ge(4 * told_apart, count - 3);
}
END_TEST

static pair pair_of_row(const test_table *t, size_t row) {
  return (pair){{{test_number(t, row, "ax"), test_number(t, row, "ay")},
                 {test_number(t, row, "bx"), test_number(t, row, "by")}},
                {{test_number(t, row, "cx"), test_number(t, row, "cy")},
                 {test_number(t, row, "dx"), test_number(t, row, "dy")}}};
}

START_TEST(reference_values) {
  test_table t = test_read_table("l1_oracle.csv");
  for (size_t row = 1; row < t.rows; row++) {
    const pair p = pair_of_row(&t, row);
    const double value = hr2di_l1(&p.i, &p.j);
    assert_close(value, test_number(&t, row, "L1_outer_i"), 1e-10);
    assert_close(value, test_number(&t, row, "L1_outer_j"), 1e-10);
  }
  ck_assert_uint_ge(t.rows, 10);
  test_free_table(&t);
}
END_TEST

/* 1/(2d) − AF with AF = √(1+d²) − d, without cancellation. */
START_TEST(facing_parallel) {
  for (int k = -120; k <= 60; k++) {
    const double d = pow(10, k / 10.);
    const hr2d_segment i = {{0, 0}, {1, 0}}, j = {{1, d}, {0, d}};
    assert_close(hr2di_l1(&i, &j), 1 / (2 * d * pow(sqrt(1 + d * d) + d, 2)), 1e-11);
  }
}
END_TEST

static hr2d_segment scaled(hr2d_segment s, double by) {
  return (hr2d_segment){{s.a.x * by, s.a.y * by}, {s.b.x * by, s.b.y * by}};
}

START_TEST(symmetry_and_scale) {
  randoms r = randoms_stream(test_seed(), 10 + _i);
  for (int k = 0; k < test_count(2000); k++) {
    const pair p = draw_kind(_i, &r);
    const double value = hr2di_l1(&p.i, &p.j), by = ldexp(1, random_below(&r, 120) - 60);
    ck_assert_double_eq(value, hr2di_l1(&p.j, &p.i));
    const hr2d_segment i = scaled(p.i, by), j = scaled(p.j, by);
    ck_assert_double_eq(by * value, hr2di_l1(&i, &j));
  }
}
END_TEST

/* Also by a factor that rounds, at a corner that stays one. */
START_TEST(scale_at_corner) {
  randoms r = randoms_stream(test_seed(), 20);
  for (int k = 0; k < test_count(1000); k++) {
    const double angle = random_between(&r, 0.1, 3), by = random_power(&r, -6, 6);
    const hr2d_point o = {0, 0};
    const hr2d_segment i = {o, {random_unit(&r) + 0.1, 0}}, j = {plane_polar(o, 1, angle), o};
    const hr2d_segment si = scaled(i, by), sj = scaled(j, by);
    assert_close(hr2di_l1(&si, &sj), by * hr2di_l1(&i, &j), 1e-10);
  }
}
END_TEST

/* Gc A_x A_y; NaN where rounding of the centres would spoil it. */
static double spread_of(const pair *p) {
  const nested n = nested_of(&p->i, &p->j);
  const line_class v = sight_at(&n, 0.5, 0.5);
  const real size =
      fabsl(n.i.x) + fabsl(n.i.y) + fabsl(n.j.x) + fabsl(n.j.y) + n.i.length + n.j.length;
  if (!(v.before_i > 1e-6 * v.r && v.before_j > 1e-6 * v.r && v.r > 1e-3 * size)) return NAN;
  return (double)(kernel_at(&n, 0.5, 0.5) * n.i.length * n.j.length);
}

/* All classes of hard pairs: no value without meaning, bounds that hold, and an
   error of at most AF + Gc A_x A_y and at least |AF − Gc A_x A_y|. */
START_TEST(hard_pairs) {
  randoms r = randoms_stream(test_seed(), 30 + _i);
  for (int k = 0; k < test_count(2000); k++) {
    const pair p = draw_pair(&pair_classes[_i], &r);
    const double value = hr2di_l1(&p.i, &p.j);
    ck_assert(value >= 0);
    ck_assert_double_eq(value, hr2di_l1(&p.j, &p.i));
    const hr2di_l1_range range = hr2di_l1_bounds(&p.i, &p.j);
    ck_assert_double_le(range.low, value);
    ck_assert_double_ge(range.high, value);
    const double area = hr2d_exchange_area(&p.i, &p.j), spread = spread_of(&p);
    if (isinf(value) || isnan(spread) || spread > 1e300 || spread < 1e-290) continue;
    ck_assert_double_le(value, (area + spread) * (1 + 1e-9));
    ck_assert_double_ge(value, fabs(area - spread) - 1e-9 * (area + spread));
  }
}
END_TEST

START_TEST(one_behind_the_other) {
  const hr2d_segment i = {{0, 0}, {1, 0}}, away = {{0, 1}, {1, 1}},
                     half = {{0, 0.5}, {0.5, -2}};
  ck_assert_double_eq(hr2di_l1(&i, &away), 0);
  /* Gc is 0, and G is not everywhere. */
  const hr2d_segment turned = {half.b, half.a};
  ck_assert_double_gt(hr2d_exchange_area(&i, &half) + hr2d_exchange_area(&i, &turned), 0);
  ck_assert_double_eq(hr2di_l1(&i, &half), hr2d_exchange_area(&i, &half));
  ck_assert_double_eq(hr2di_l1(&i, &turned), hr2d_exchange_area(&i, &turned));
}
END_TEST

/* accept() decides as estimate() does, beside the value and on it. */
START_TEST(decisions) {
  static const double steps[] = {0,    1e-15, 1e-13, 1e-11, 1e-9, 1e-7, 1e-5,
                                 1e-3, 0.01,  0.03,  0.1,   0.3,  0.7};
  randoms r = randoms_stream(test_seed(), 60 + _i);
  long asked = 0;
  for (int k = 0; k < test_count(700); k++) {
    const pair p = draw_kind(_i, &r);
    const double value = hr2di_l1(&p.i, &p.j);
    for (size_t m = 0; m < sizeof steps / sizeof *steps; m++)
      for (int sign = -1; sign <= 1; sign += 2) {
        const double epsilon = value * (1 + sign * steps[m]), scale = ldexp(1, (int)m - 6);
        ck_assert_int_eq(hr2di_l1_accept(&p.i, &p.j, scale, scale * epsilon), value <= epsilon);
        ck_assert_int_eq(hr2di_l1_accept(&p.j, &p.i, 1, epsilon), value <= epsilon);
        asked += 2;
      }
    ck_assert_int_eq(hr2di_l1_accept(&p.i, &p.j, 1, 0), value <= 0);
    ck_assert_int_eq(hr2di_l1_accept(&p.i, &p.j, 1, INFINITY), 1);
  }
  ck_assert(test_multiplier() < 1 || asked * KINDS >= 100000);
}
END_TEST

/* Counts.  In the tables the rows for both orders of a pair follow the rows for one order; ε
   starts again there. */
static void check_counts(const char *file, const hr2d_oracle *oracle, size_t min) {
  test_table t = test_read_table(file);
  int ordered = 0;
  size_t checked = 0;
  for (size_t row = 1; row < t.rows; row++) {
    const int same =
        row > 1 && strcmp(test_cell(&t, row, "scene"), test_cell(&t, row - 1, "scene")) == 0 &&
        strcmp(test_cell(&t, row, "algorithm"), test_cell(&t, row - 1, "algorithm")) == 0;
    if (!same)
      ordered = 0;
    else if (test_number(&t, row, "eps") > test_number(&t, row - 1, "eps"))
      ordered = !ordered;
    if (test_number(&t, row, "L") > 1e6 * test_multiplier()) continue;
    test_links links =
        test_make_links(test_named_scene(test_cell(&t, row, "scene")), oracle, NULL,
                        hr2d_policy_find(test_cell(&t, row, "algorithm")), NULL);
    hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
    options.epsilon = test_number(&t, row, "eps");
    options.ordered = ordered;
    hr2d_refine_counts counts;
    ck_assert_int_eq(hr2d_refine_count(links.links, &options, &counts), HR2D_OK);
    ck_assert_uint_eq(counts.elements, (uint64_t)test_number(&t, row, "N_nodes"));
    ck_assert_uint_eq(counts.leaves, (uint64_t)test_number(&t, row, "N_leaves"));
    ck_assert_uint_eq(counts.links, (uint64_t)test_number(&t, row, "L"));
    ck_assert_uint_eq(counts.oracle_calls, (uint64_t)test_number(&t, row, "visited_pairs"));
    ck_assert_uint_eq(counts.levels, (uint64_t)test_number(&t, row, "max_level"));
    ck_assert_uint_eq(counts.limited_links, 0);
    test_free_links(&links);
    checked++;
  }
  ck_assert_uint_ge(checked, min);
  test_free_table(&t);
}

START_TEST(counts_of_l1) {
  check_counts("counts_L1_exact_pow2.csv", hr2d_oracle_l1(), 200);
}
END_TEST

START_TEST(counts_of_grid) {
  check_counts("counts_L1_1024_pow2.csv", hr2d_oracle_l1_grid(), 200);
}
END_TEST

/* The grid. */

static hr2d_scene *scene_of(const pair *p, double by) {
  const double patches[2][6] = {
      {by * p->i.a.x, by * p->i.a.y, by * p->i.b.x, by * p->i.b.y, 1, 0},
      {by * p->j.a.x, by * p->j.a.y, by * p->j.b.x, by * p->j.b.y, 0, 0}};
  return test_scene(patches, 2);
}

/* Asks an oracle about one pair, its estimate and whether its decisions agree. */
static double ask(const hr2d_oracle *oracle, const test_links *t, hr2d_pair asked) {
  const hr2d_batch batch = {.struct_size = sizeof batch,
                            .hierarchy = t->hierarchy,
                            .elements = hr2d_hierarchy_elements(t->hierarchy),
                            .pairs = &asked,
                            .count = 1,
                            .unit = hr2d_scene_unit(t->scene)};
  const double error = element_estimate(oracle, &batch);
  static const double factors[] = {0, 0.3, 0.9, 1 - 1e-12, 1, 1 + 1e-12, 1.1, 3};
  for (size_t k = 0; k < sizeof factors / sizeof *factors; k++)
    ck_assert_int_eq(element_accepted(oracle, &batch, error * factors[k]),
                     error <= error * factors[k]);
  return error;
}

START_TEST(grid_on_reference_pairs) {
  test_table t = test_read_table("l1_oracle.csv");
  for (size_t row = 1; row < t.rows; row++) {
    const pair p = pair_of_row(&t, row);
    test_links links = test_make_links(scene_of(&p, 1), NULL, NULL, NULL, NULL);
    /* ten digits are given */
    assert_close(ask(hr2d_oracle_l1_grid(), &links, (hr2d_pair){0, 1}),
                 test_number(&t, row, "midpoint_1024"), 6e-10);
    assert_close(ask(hr2d_oracle_l1(), &links, (hr2d_pair){1, 0}),
                 test_number(&t, row, "L1_outer_i"), 1e-10);
    test_free_links(&links);
  }
  test_free_table(&t);
}
END_TEST

static double plain_grid(const hr2d_segment *i, const hr2d_segment *j, int m, int n) {
  const pair p = {*i, *j};
  const double centre = centre_kernel(&p);
  double sum = 0;
  for (int k = 0; k < m; k++)
    for (int l = 0; l < n; l++) {
      const double s = (k + 0.5) / m, t = (l + 0.5) / n;
      const hr2d_point x = {i->a.x + s * (i->b.x - i->a.x), i->a.y + s * (i->b.y - i->a.y)};
      const hr2d_point y = {j->a.x + t * (j->b.x - j->a.x), j->a.y + t * (j->b.y - j->a.y)};
      sum += fabs(hr2d_kernel(i, x, j, y) - centre);
    }
  return sum * plane_length(*i) / m * plane_length(*j) / n;
}

/* Elements of all levels, of patches of different lengths, in a scene with a unit. */
START_TEST(grid_on_elements) {
  const pair p = {{{0, 0}, {1, 0}}, {{1.5, 0.25}, {1.25, 2}}};
  test_links t = test_make_links(scene_of(&p, 40), hr2d_oracle_size(), NULL, NULL, NULL);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 1e-3;
  options.max_level = 12;
  hr2d_refine_counts counts;
  ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_OK);
  ck_assert_uint_ge(counts.levels, 11);
  const hr2d_element *e = hr2d_hierarchy_elements(t.hierarchy);
  const double unit = hr2d_scene_unit(t.scene);
  ck_assert_double_gt(unit, 1);
  uint32_t i = 0;
  for (unsigned level = 0; level <= 12; level++, i = e[i].child + (level & 1)) {
    uint32_t j = 1;
    for (unsigned other = 0; other <= 12; other++, j = e[j].child + (other & 1)) {
      const double error = ask(hr2d_oracle_l1_grid(), &t, (hr2d_pair){i, j});
      ck_assert_double_eq(error, ask(hr2d_oracle_l1_grid(), &t, (hr2d_pair){j, i}));
      if (level >= 10 && other >= 10) ck_assert_double_eq(error, 0);
      if (level + other >= 3 && (level < 10 || other < 10)) {
        const hr2d_segment si = {e[i].a, e[i].b}, sj = {e[j].a, e[j].b};
        const int m = level < 10 ? 1024 >> level : 1, n = other < 10 ? 1024 >> other : 1;
        assert_close(error, unit * plain_grid(&si, &sj, m, n), 1e-9);
      }
      if (!e[j].child) break;
    }
    if (!e[i].child) break;
  }
  test_free_links(&t);
}
END_TEST

TEST_SUITE("l1") {
  gsl_set_error_handler_off(); /* rounding may keep the nested quadrature from its goal */
  ADD_TESTS("exact", reference_values, facing_parallel);
  REPEAT_TESTS(KINDS, "exact", nested_quadrature, symmetry_and_scale);
  ADD_TESTS("exact", scale_at_corner);
  REPEAT_TESTS(pair_class_count, "exact", hard_pairs);
  ADD_TESTS("exact", one_behind_the_other);
  REPEAT_TESTS(KINDS, "exact", decisions);
  ADD_TESTS("exact", counts_of_l1);
  ADD_TESTS("grid", counts_of_grid, grid_on_reference_pairs, grid_on_elements);
}
