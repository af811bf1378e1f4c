/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orientations and facing against exact arithmetic, the kernel against its
   definition, and exchange areas against closed forms, reference values and their
   own laws. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "geometry/predicates.h"
#include "independent/mpfr-exchange.h"
#include "support/pair-classes.h"
#include "support/plane.h"
#include "support/support.h"

#define BAR 4e-15

static int sign(double x) {
  return (x > 0) - (x < 0);
}

static double area(hr2d_segment i, hr2d_segment j) {
  return hr2d_exchange_area(&i, &j);
}

static void assert_close(double value, double expected, double bar) {
  ck_assert_msg(fabs(value - expected) <= bar * fabs(expected), "%.17g is not %.17g", value,
                expected);
}

/* Whether the coordinates' scales are as near as hr2d_orientation() promises for;
   a nudge of 0 leads to 2^-1074. */
static int near_in_scale(const hr2d_point *points, int count) {
  double min = INFINITY, max = 0;
  for (int k = 0; k < 2 * count; k++) {
    const double x = fabs(k & 1 ? points[k / 2].y : points[k / 2].x);
    if (x > 0) min = fmin(min, x);
    max = fmax(max, x);
  }
  return ldexp(max, -900) < min;
}

static void check_orientation(const pair_class *class, hr2d_point a, hr2d_point b,
                              hr2d_point c) {
  if (!near_in_scale((const hr2d_point[]){a, b, c}, 3)) return;
  mpfr_t exact;
  mpfr_init2(exact, MPFR_PREC_MIN);
  mpfr_orient(exact, a, b, c);
  const int expected = sign(mpfr_sgn(exact));
  ck_assert_msg(hr2d_orientation(a, b, c) == expected, "%s: %d at %a %a  %a %a  %a %a",
                class->name, expected, a.x, a.y, b.x, b.y, c.x, c.y);
  const double rounded = mpfr_get_d(exact, MPFR_RNDN), det = hr2di_orient(a, b, c);
  if (fabs(rounded) < DBL_MIN)
    ck_assert_double_le(fabs(det - rounded), 2 * DBL_TRUE_MIN);
  else if (isinf(rounded))
    ck_assert(det == rounded);
  else
    ck_assert_double_le(mpfr_relative_error(det, exact), 3 * DBL_EPSILON);
  mpfr_clear(exact);
}

START_TEST(orientations_are_exact) {
  const pair_class *class = &pair_classes[_i];
  randoms r = randoms_stream(test_seed(), 4000 + _i);
  for (int k = test_count(10000); k > 0; k--) {
    const pair p = draw_pair(class, &r);
    check_orientation(class, p.i.a, p.i.b, p.j.a);
    check_orientation(class, p.j.a, p.j.b, p.i.b);
    check_orientation(class, p.j.a, p.i.b, p.j.a);
  }
}
END_TEST

static hr2di_facing exact_facing(const pair *p) {
  const hr2d_point points[4][3] = {{p->i.a, p->i.b, p->j.a},
                                   {p->i.a, p->i.b, p->j.b},
                                   {p->j.a, p->j.b, p->i.a},
                                   {p->j.a, p->j.b, p->i.b}};
  int at[4];
  mpfr_t exact;
  mpfr_init2(exact, MPFR_PREC_MIN);
  for (int k = 0; k < 4; k++) {
    mpfr_orient(exact, points[k][0], points[k][1], points[k][2]);
    at[k] = mpfr_sgn(exact);
  }
  mpfr_clear(exact);
  if ((at[0] <= 0 && at[1] <= 0) || (at[2] <= 0 && at[3] <= 0)) return HR2DI_FACING_NONE;
  for (int k = 0; k < 4; k++)
    if (at[k] < 0) return HR2DI_FACING_PART;
  return HR2DI_FACING_FULL;
}

static int is_below_the_doubles(const pair *p) {
  mpfr_t exact;
  mpfr_init2(exact, MPFR_PREC_MIN);
  mpfr_exchange_area(exact, &p->i, &p->j);
  const int below = mpfr_cmp_d(exact, DBL_TRUE_MIN) < 0;
  mpfr_clear(exact);
  return below;
}

START_TEST(facing_is_exact_and_agrees_with_the_area) {
  const pair_class *class = &pair_classes[_i];
  randoms r = randoms_stream(test_seed(), 5000 + _i);
  for (int k = test_count(10000); k > 0; k--) {
    const pair p = draw_pair(class, &r);
    if (!near_in_scale((const hr2d_point[]){p.i.a, p.i.b, p.j.a, p.j.b}, 4)) continue;
    const hr2di_facing facing = hr2di_facing_of(&p.i, &p.j);
    ck_assert_int_eq(facing, exact_facing(&p));
    ck_assert_int_eq(facing, hr2di_facing_of(&p.j, &p.i));
    const double af = area(p.i, p.j);
    if (facing == HR2DI_FACING_NONE)
      ck_assert(af == 0);
    else
      ck_assert(af > 0 || is_below_the_doubles(&p));
  }
}
END_TEST

START_TEST(closed_forms) {
  const hr2d_segment floor = {{0, 0}, {1, 0}}, wall = {{0, 1}, {0, 0}};
  static const double distance[] = {1e-6, 0.1, 1, 10, 1e8};
  for (size_t k = 0; k < sizeof distance / sizeof distance[0]; k++) {
    const double d = distance[k];
    assert_close(area(floor, (hr2d_segment){{1, d}, {0, d}}), 1 / (hypot(1, d) + d), BAR);
  }
  assert_close(area(floor, wall), 1 - sqrt(0.5), BAR);
  assert_close(area(floor, (hr2d_segment){{0, 3}, {0, 0}}), 0.5 * (4 - sqrt(10)), BAR);
  /* In a triangle AF is half of a + b − c. */
  const hr2d_segment right = {{4, 0}, {0, 3}};
  assert_close(area((hr2d_segment){{0, 0}, {4, 0}}, right), 3, BAR);
  assert_close(area((hr2d_segment){{0, 3}, {0, 0}}, right), 2, BAR);
  /* Equal sides of a wedge: F = 1 − sin(α/2), so F → 1 as the wedge closes. */
  for (double t = 1; t > 1e-15; t *= 0.125) {
    const double h = sqrt(1 + t * t);
    const hr2d_segment lower = {{0, 0}, {1, -t}}, upper = {{1, t}, {0, 0}};
    assert_close(area(lower, upper), h - t, BAR);
  }
}
END_TEST

START_TEST(nothing_is_exchanged_with_a_back) {
  const hr2d_segment up = {{0, 0}, {1, 0}}, down = {{1, 0}, {0, 0}}, point = {{0, 1}, {0, 1}};
  ck_assert(area(up, down) == 0);
  ck_assert(area(up, up) == 0);
  ck_assert(area(up, point) == 0);
  ck_assert(area(up, (hr2d_segment){{0, 1}, {1, 1}}) == 0);
  ck_assert(area(up, (hr2d_segment){{1, -1}, {0, -1}}) == 0);
  ck_assert(area(up, (hr2d_segment){{1, 0}, {2, 0}}) == 0);
  ck_assert(area(up, (hr2d_segment){{3, 0}, {2, 0}}) == 0);
  ck_assert_int_eq(hr2di_facing_of(&up, &down), HR2DI_FACING_NONE);
}
END_TEST

START_TEST(what_is_not_finite_is_not_a_number) {
  static const double bad[] = {INFINITY, -INFINITY, NAN};
  for (int k = 0; k < 24; k++) {
    double x[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    x[k % 8] = bad[k / 8];
    const hr2d_segment i = {{x[0], x[1]}, {x[2], x[3]}}, j = {{x[4], x[5]}, {x[6], x[7]}};
    const hr2d_segment back = {j.b, j.a};
    ck_assert(isnan(area(i, j)) && isnan(area(j, i)) && isnan(area(i, back)));
    ck_assert(isnan(hr2d_kernel(&i, i.a, &j, j.a)) || (k % 8 != 0 && k % 8 != 4));
  }
}
END_TEST

START_TEST(reference_rows) {
  test_table table = test_read_table("formfactors.csv");
  for (size_t row = 1; row < table.rows; row++) {
    double x[8];
    static const char *const column[] = {"ax", "ay", "bx", "by", "cx", "cy", "dx", "dy"};
    for (int k = 0; k < 8; k++) x[k] = test_number(&table, row, column[k]);
    const hr2d_segment i = {{x[0], x[1]}, {x[2], x[3]}}, j = {{x[4], x[5]}, {x[6], x[7]}};
    const double af = area(i, j), expected = test_number(&table, row, "AF");
    ck_assert(area(j, i) == af);
    if (expected < DBL_MIN) {
      ck_assert_double_le(fabs(af - expected), 2 * DBL_TRUE_MIN);
      continue;
    }
    assert_close(af, expected, BAR);
    assert_close(af / plane_length(i), test_number(&table, row, "F_ij"), BAR + 2 * DBL_EPSILON);
    assert_close(af / plane_length(j), test_number(&table, row, "F_ji"), BAR + 2 * DBL_EPSILON);
    /* The arithmetic of the other tests stands on the same rows. */
    mpfr_t exact;
    mpfr_init2(exact, MPFR_PREC_MIN);
    mpfr_exchange_area(exact, &i, &j);
    assert_close(mpfr_get_d(exact, MPFR_RNDN), expected, DBL_EPSILON);
    mpfr_clear(exact);
  }
  test_free_table(&table);
}
END_TEST

START_TEST(scaling_by_a_power_of_two_changes_no_bit) {
  randoms r = randoms_stream(test_seed(), 6000);
  for (int k = test_count(20000); k > 0; k--) {
    const pair p = draw_pair(&pair_classes[k % 3 ? 0 : 8], &r);
    const int e = random_below(&r, 90) - 45;
    const hr2d_point q[4] = {p.i.a, p.i.b, p.j.a, p.j.b};
    hr2d_point s[4];
    for (int n = 0; n < 4; n++) s[n] = (hr2d_point){ldexp(q[n].x, e), ldexp(q[n].y, e)};
    const double scaled = area((hr2d_segment){s[0], s[1]}, (hr2d_segment){s[2], s[3]});
    ck_assert(scaled == ldexp(area(p.i, p.j), e));
  }
}
END_TEST

/* Both ends and the midpoint of a segment on a lattice of 2^-20 are doubles. */
static hr2d_segment lattice_segment(randoms *r) {
  double x[4];
  for (int k = 0; k < 4; k++) x[k] = ldexp(random_below(r, 1 << 20), -20);
  return (hr2d_segment){{x[0], x[1]}, {x[2], x[3]}};
}

START_TEST(children_add_up_to_their_parent) {
  randoms r = randoms_stream(test_seed(), 7000);
  for (int k = test_count(50000); k > 0; k--) {
    const hr2d_segment i = lattice_segment(&r), j = lattice_segment(&r);
    const hr2d_point m = {0.5 * (i.a.x + i.b.x), 0.5 * (i.a.y + i.b.y)};
    const double left = area((hr2d_segment){i.a, m}, j),
                 right = area((hr2d_segment){m, i.b}, j);
    const double whole = area(i, j);
    ck_assert((left == 0 && right == 0) == (whole == 0));
    assert_close(left + right, whole, 2 * BAR);
  }
}
END_TEST

START_TEST(no_more_than_a_length_is_exchanged) {
  const pair_class *class = &pair_classes[_i];
  randoms r = randoms_stream(test_seed(), 8000 + _i);
  for (int k = test_count(20000); k > 0; k--) {
    const pair p = draw_pair(class, &r);
    const double af = area(p.i, p.j), max = fmin(plane_length(p.i), plane_length(p.j));
    ck_assert(af >= 0 && af <= max * (1 + BAR) + DBL_TRUE_MIN);
  }
}
END_TEST

/* Ends and points of dyadic segments, so that the points lie on them exactly. */
START_TEST(kernel_is_what_it_is_defined_to_be) {
  randoms r = randoms_stream(test_seed(), 9000);
  mpfr_t exact;
  mpfr_init2(exact, MPFR_PREC_MIN);
  for (int k = test_count(20000); k > 0; k--) {
    static const double scales[] = {1, 0x1p-498, 0x1p+498};
    hr2d_segment i = lattice_segment(&r), j = lattice_segment(&r);
    const double s = scales[random_below(&r, 3)];
    i = (hr2d_segment){{s * i.a.x, s * i.a.y}, {s * i.b.x, s * i.b.y}};
    j = (hr2d_segment){{s * j.a.x, s * j.a.y}, {s * j.b.x, s * j.b.y}};
    const hr2d_point x = plane_along(i, ldexp(random_below(&r, 257), -8));
    const hr2d_point y = plane_along(j, ldexp(random_below(&r, 257), -8));
    if (x.x == y.x && x.y == y.y) continue;
    mpfr_kernel(exact, &i, x, &j, y);
    const double g = hr2d_kernel(&i, x, &j, y);
    ck_assert(g == hr2d_kernel(&j, y, &i, x));
    if (mpfr_zero_p(exact))
      ck_assert(g == 0);
    else
      ck_assert_double_le(mpfr_relative_error(g, exact), BAR);
  }
  mpfr_clear(exact);
}
END_TEST

START_TEST(kernel_at_its_borders) {
  const hr2d_segment floor = {{0, 0}, {1, 0}}, wall = {{0, 1}, {0, 0}}, back = {{0, 0}, {0, 1}};
  const hr2d_point corner = {0, 0}, middle = {0.5, 0}, high = {0, 0.5};
  assert_close(hr2d_kernel(&floor, middle, &wall, high), sqrt(0.5) / 2, BAR);
  ck_assert(hr2d_kernel(&floor, middle, &back, high) == 0);
  ck_assert(hr2d_kernel(&floor, middle, &wall, corner) == 0);
  ck_assert(hr2d_kernel(&floor, corner, &wall, corner) == INFINITY);
  ck_assert(hr2d_kernel(&floor, corner, &back, corner) == 0);
  /* G = 1/(2d) between facing midpoints, also where d³ is no double. */
  for (int e = -140; e <= 140; e += 35) {
    const double d = pow(10, e);
    const hr2d_segment i = {{-d, 0}, {d, 0}}, j = {{d, d}, {-d, d}};
    assert_close(hr2d_kernel(&i, corner, &j, (hr2d_point){0, d}), 0.5 / d, BAR);
  }
}
END_TEST

TEST_SUITE("geometry") {
  REPEAT_TESTS(pair_class_count, "predicates", orientations_are_exact,
               facing_is_exact_and_agrees_with_the_area);
  ADD_TESTS("exchange area", closed_forms, nothing_is_exchanged_with_a_back,
            what_is_not_finite_is_not_a_number, reference_rows,
            scaling_by_a_power_of_two_changes_no_bit, children_add_up_to_their_parent);
  REPEAT_TESTS(pair_class_count, "exchange area", no_more_than_a_length_is_exchanged);
  ADD_TESTS("kernel", kernel_is_what_it_is_defined_to_be, kernel_at_its_borders);
}
