/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas and blocks through gas: against integrals over positions in binary128, closed
   forms, each other, and areas without gas. */
#include <gsl/gsl_sf_expint.h>
#include <math.h>
#include <string.h>

#include "base/pi.h"
#include "blocks/block.h"
#include "scene/scene-impl.h"
#include "support/support.h"

/* A pair of patches in gas. */
typedef struct pair_in_gas {
  hr2d_segment i, j;
  double kappa;
  hr2d_section section;
} pair_in_gas;

/* The blocks of a pair, in scene lengths. */
typedef struct made {
  double block[HR2D_MAX_ORDER * HR2D_MAX_ORDER];
  double lost[2][HR2D_MAX_ORDER];
  int distant;
} made;

static hr2d_scene *scene_of(const pair_in_gas *p) {
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = &p->kappa;
  gas.absorption_bands = 1;
  gas.section = p->section;
  ck_assert_int_eq(test_add_patch(scene, p->i, 0, 0, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(test_add_patch(scene, p->j, 0, 0, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
  test_commit(scene);
  return scene;
}

static made make(const pair_in_gas *p, size_t order, int swapped) {
  made m = {.distant = 0};
  hr2d_scene *scene = scene_of(p);
  hr2d_hierarchy *h;
  hr2di_integrator w;
  hr2di_watch watch;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  hr2di_scene_watch(scene, &watch, NULL, NULL, "blocks");
  ck_assert_int_eq(hr2di_integrator_init(&w, h, &scene->alloc, order, NULL, &watch), HR2D_OK);
  const hr2d_pair pair = swapped ? (hr2d_pair){1, 0} : (hr2d_pair){0, 1};
  const double area = hr2d_exchange_area(&scene->patch[0].scaled, &scene->patch[1].scaled);
  ck_assert_int_eq(hr2di_block(&w, pair, area, m.block, &m.distant), HR2D_OK);
  const double unit = hr2d_scene_unit(scene);
  for (size_t k = 0; k < order * order; k++) m.block[k] *= unit;
  for (size_t k = 0; k < order; k++) {
    m.lost[0][k] = unit * w.lost[0][k];
    m.lost[1][k] = unit * w.lost[1][k];
  }
  hr2di_integrator_clear(&w);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
  return m;
}

static pair_in_gas pair_of_row(const test_table *t, size_t row) {
  static const char *const name[] = {"ax", "ay", "bx", "by", "cx", "cy", "dx", "dy"};
  double c[8];
  for (size_t k = 0; k < 8; k++) c[k] = test_number(t, row, name[k]);
  return (pair_in_gas){{{c[0], c[1]}, {c[2], c[3]}},
                       {{c[4], c[5]}, {c[6], c[7]}},
                       test_number(t, row, "kappa"),
                       strcmp(test_cell(t, row, "section"), "flat") == 0 ? HR2D_SECTION_FLAT
                                                                         : HR2D_SECTION_LONG};
}

START_TEST(areas_are_those_of_positions) {
  test_table t = test_read_table("gas_areas.csv");
  double of_clear = 0, of_itself = 0, of_lost = 0;
  ck_assert_uint_gt(t.rows, 50);
  for (size_t row = 1; row < t.rows; row++) {
    const pair_in_gas p = pair_of_row(&t, row);
    const double area = test_number(&t, row, "area"), lost = test_number(&t, row, "lost");
    const double clear = hr2d_exchange_area(&p.i, &p.j);
    const made m = make(&p, 1, 0);
    of_clear = fmax(of_clear, fabs(m.block[0] - area) / clear);
    of_itself = fmax(of_itself, fabs(m.block[0] / area - 1));
    of_lost = fmax(of_lost, fabs(m.lost[0][0] - lost) / fmax(lost, 1e-3 * clear));
    ck_assert(m.lost[0][0] == m.lost[1][0]);
    /* negative control: what is absorbed is no rounding */
    ck_assert_double_gt(fabs(clear - area), 0.5 * lost);
  }
  test_free_table(&t);
  printf("areas are off by at most %.1e of the clear ones and %.1e of themselves, what is "
         "absorbed by %.1e\n",
         of_clear, of_itself, of_lost);
  ck_assert_double_lt(of_clear, 3e-15);
  ck_assert_double_lt(of_itself, 5e-14);
  ck_assert_double_lt(of_lost, 2e-14);
}
END_TEST

/* With few digits, so that sums of multiples are exact. */
static double round_off(double x) {
  return ldexp(nearbyint(ldexp(x, 30)), -30);
}

static hr2d_point round_point(double x, double y) {
  return (hr2d_point){round_off(x), round_off(y)};
}

/* κ from 1e-12 to 1e6 over corners, gaps and distances of all sizes. */
static pair_in_gas draw_pair(randoms *r, int n) {
  pair_in_gas p = {.kappa = random_power(r, -12, 6),
                   .section = n % 2 ? HR2D_SECTION_FLAT : HR2D_SECTION_LONG};
  p.i = (hr2d_segment){{0, 0}, {1, 0}};
  const double size = random_power(r, -2, 1), angle = random_between(r, 0.05, 3.1);
  if (n % 3 == 0) { /* a corner */
    p.j = (hr2d_segment){{1, 0}, round_point(1 - size * cos(angle), size * sin(angle))};
    return p;
  }
  const double gap = n % 3 == 1 ? random_power(r, -3, 0) : random_between(r, 2, 10);
  const double x = random_between(r, -1, 2);
  p.j = (hr2d_segment){round_point(x + size, gap),
                       round_point(x, gap + random_between(r, 0, 0.2) * size)};
  return p;
}

/* Both parts are integrated on their own, and make the area that crossed strings know. */
START_TEST(what_arrives_and_what_is_absorbed_make_the_clear_area) {
  double worst = 0;
  for (int n = 0; n < test_count(6000); n++) {
    randoms r = randoms_stream(test_seed(), n);
    const pair_in_gas p = draw_pair(&r, n);
    const double clear = hr2d_exchange_area(&p.i, &p.j);
    if (clear == 0) continue;
    const made m = make(&p, 1, 0);
    worst = fmax(worst, fabs(m.block[0] + m.lost[0][0] - clear) / clear);
    ck_assert(m.block[0] >= 0 && m.lost[0][0] > 0);
  }
  printf("the sum is off by at most %.1e\n", worst);
  ck_assert_double_lt(worst, 1e-14);
}
END_TEST

/* Rules over offsets against divided differences of Ki_4. */
START_TEST(blocks_of_any_order_begin_with_the_area) {
  double near = 0, lost = 0, distant = 0;
  for (int n = 0; n < test_count(3000); n++) {
    randoms r = randoms_stream(test_seed() + 1, n);
    const pair_in_gas p = draw_pair(&r, n);
    const double clear = hr2d_exchange_area(&p.i, &p.j);
    const size_t order = 2 + (size_t)random_below(&r, 15);
    const made one = make(&p, 1, 0), many = make(&p, order, 0);
    const double off = fabs(many.block[0] - one.block[0]) / clear;
    const double off_lost =
        fabs(many.lost[0][0] - one.lost[0][0]) / fmax(one.lost[0][0], 1e-6 * clear);
    if (!many.distant) {
      near = fmax(near, off);
      lost = fmax(lost, off_lost);
    } else if (order > 9) {
      distant = fmax(distant, fmax(off, off_lost));
    }
    ck_assert(one.distant == 0);
  }
  printf("C_00 of an order is off by at most %.1e near, what is absorbed by %.1e, and both by "
         "%.1e far away\n",
         near, lost, distant);
  ck_assert_double_lt(near, 2e-14);
  ck_assert_double_lt(lost, 1e-12);
  ck_assert_double_lt(distant, 1e-9);
}
END_TEST

/* Coefficients of a pair by a fine product rule over positions, where nothing is near. */
static void by_positions(const pair_in_gas *p, size_t order, double *block) {
  enum { POINTS = 48 };
  hr2di_rule rule;
  hr2di_basis basis;
  hr2di_rule_init(&rule, POINTS);
  hr2di_basis_init(&basis, order);
  const double length_i = hypot(p->i.b.x - p->i.a.x, p->i.b.y - p->i.a.y);
  const double length_j = hypot(p->j.b.x - p->j.a.x, p->j.b.y - p->j.a.y);
  memset(block, 0, order * order * sizeof *block);
  for (size_t k = 0; k < POINTS; k++)
    for (size_t q = 0; q < POINTS; q++) {
      double on_i[HR2D_MAX_ORDER], on_j[HR2D_MAX_ORDER];
      const hr2d_point x =
          hr2di_block_along(p->i.a, (hr2d_point){p->i.b.x - p->i.a.x, p->i.b.y - p->i.a.y},
                            0.5 + 0.5 * rule.at[k]);
      const hr2d_point y =
          hr2di_block_along(p->j.a, (hr2d_point){p->j.b.x - p->j.a.x, p->j.b.y - p->j.a.y},
                            0.5 + 0.5 * rule.at[q]);
      const double depth = p->kappa * hypot(y.x - x.x, y.y - x.y);
      /* T by its definition: a rule over the angle out of the plane */
      double t = p->section == HR2D_SECTION_FLAT ? exp(-depth) : 0;
      for (size_t m = 0; m < POINTS && p->section == HR2D_SECTION_LONG; m++) {
        const double c = cos((0.25 * HR2DI_PI) * (1 + rule.at[m]));
        t += 2 * rule.weight[m] * c * c * exp(-depth / c);
      }
      const double g = rule.weight[k] * rule.weight[q] * length_i * length_j * t *
                       hr2d_kernel(&p->i, x, &p->j, y);
      hr2di_basis_at(&basis, rule.at[k], on_i);
      hr2di_basis_at(&basis, rule.at[q], on_j);
      for (size_t l = 0; l < order; l++)
        for (size_t m = 0; m < order; m++) block[l * order + m] += g * on_i[l] * on_j[m];
    }
}

START_TEST(coefficients_are_those_of_positions) {
  static const double kappa[] = {1e-3, 0.5, 3, 12};
  enum { ORDER = 8 };
  double expected[ORDER * ORDER], worst = 0, control = 0;
  size_t distant = 0;
  for (size_t n = 0; n < 16; n++) {
    const double gap = n % 2 ? 0.7 : 4;
    const pair_in_gas p = {{{0, 0}, {1, 0}},
                           {{1.5, gap}, {0.25, gap + 0.125}},
                           kappa[n / 4],
                           n / 2 % 2 ? HR2D_SECTION_FLAT : HR2D_SECTION_LONG};
    by_positions(&p, ORDER, expected);
    const made m = make(&p, ORDER, 0), back = make(&p, ORDER, 1);
    distant += (size_t)m.distant;
    for (size_t l = 0; l < ORDER; l++)
      for (size_t k = 0; k < ORDER; k++) {
        const double c = m.block[l * ORDER + k];
        worst = fmax(worst, fabs(c - expected[l * ORDER + k]) / expected[0]);
        ck_assert_double_eq_tol(back.block[k * ORDER + l], c, 1e-14 * expected[0]);
        if (l != k) control = fmax(control, fabs(m.block[k * ORDER + l] - c) / expected[0]);
      }
    for (size_t l = 0; l < ORDER; l++)
      ck_assert_double_eq_tol(back.lost[0][l], m.lost[1][l], 1e-14);
  }
  printf("coefficients are off by at most %.1e of C_00; %zu pairs are distant\n", worst,
         distant);
  ck_assert_uint_gt(distant, 2);
  ck_assert_double_lt(worst, 1e-9);
  ck_assert_double_gt(control, 1e-3); /* transposed ones would be seen */
}
END_TEST

/* Long plates at the distance 1: each more length exchanges 2E₃(κ), the plane layer. */
START_TEST(long_plates_are_a_plane_layer) {
  static const double kappa[] = {0.25, 1, 3, 10};
  for (size_t n = 0; n < 4; n++) {
    const double shorter = 64 / fmin(kappa[n], 1), longer = 2 * shorter;
    const pair_in_gas p = {{{0, 0}, {shorter, 0}}, {{shorter, 1}, {0, 1}}, kappa[n], 0};
    const pair_in_gas q = {{{0, 0}, {longer, 0}}, {{longer, 1}, {0, 1}}, kappa[n], 0};
    const double more = make(&q, 1, 0).block[0] - make(&p, 1, 0).block[0];
    ck_assert_double_eq_tol(more / (longer - shorter), 2 * gsl_sf_expint_En(3, kappa[n]),
                            2e-14);
    /* negative control: the flat world has another layer */
    pair_in_gas flat = q;
    flat.section = HR2D_SECTION_FLAT;
    ck_assert_double_gt(fabs(make(&flat, 1, 0).block[0] - make(&q, 1, 0).block[0]), 1e-6);
  }
}
END_TEST

/* In thick gas a corner of the angle α keeps (2/(3πκ))(1 + (π − α) cot α), or ¼ for 2/(3π). */
START_TEST(thick_gas_leaves_corners_alone) {
  static const hr2d_point end[] = {{1, 1}, {0, 1}, {2, 1}};
  static const double angle[] = {0.5 * HR2DI_PI, (0.25 * HR2DI_PI), 3 * (0.25 * HR2DI_PI)};
  for (size_t n = 0; n < 3; n++)
    for (double kappa = 1e3; kappa < 1e12; kappa *= 100)
      for (int flat = 0; flat < 2; flat++) {
        const pair_in_gas p = {{{0, 0}, {1, 0}}, {{1, 0}, end[n]}, kappa, (hr2d_section)flat};
        const double factor = flat ? 0.25 : 2 / (3 * HR2DI_PI);
        const double limit = factor / kappa * (1 + (HR2DI_PI - angle[n]) / tan(angle[n]));
        ck_assert_double_eq_tol(make(&p, 1, 0).block[0] / limit, 1, 1e-14);
        ck_assert_double_eq_tol(make(&p, 7, 0).block[0] / limit, 1, 1e-13);
      }
}
END_TEST

static hr2d_point turned(hr2d_point p, double scale) {
  return (hr2d_point){scale * (3 * p.x - 4 * p.y), scale * (4 * p.x + 3 * p.y)};
}

/* By 3-4-5, and to scale: depths are the same, and areas lengths. */
START_TEST(gas_knows_neither_place_nor_direction_nor_unit) {
  double worst = 0;
  for (int n = 0; n < test_count(1000); n++) {
    randoms r = randoms_stream(test_seed() + 2, n);
    const pair_in_gas p = draw_pair(&r, n);
    const double scale = ldexp(1, random_below(&r, 40) - 20);
    pair_in_gas q = p;
    q.i = (hr2d_segment){turned(p.i.a, scale), turned(p.i.b, scale)};
    q.j = (hr2d_segment){turned(p.j.a, scale), turned(p.j.b, scale)};
    q.kappa = p.kappa / (5 * scale);
    const made one = make(&p, 1, 0), other = make(&q, 1, 0);
    const double clear = hr2d_exchange_area(&p.i, &p.j);
    worst = fmax(worst, fabs(other.block[0] / (5 * scale) - one.block[0]) / clear);
  }
  printf("turned areas are off by at most %.1e of the clear ones\n", worst);
  ck_assert_double_lt(worst, 1e-14);
}
END_TEST

START_TEST(parts_make_the_whole) {
  double worst = 0;
  for (int n = 0; n < test_count(1000); n++) {
    randoms r = randoms_stream(test_seed() + 3, n);
    const pair_in_gas p = draw_pair(&r, n);
    pair_in_gas left = p, right = p;
    left.i.b = right.i.a = (hr2d_point){0.25, 0};
    const double sum = make(&left, 1, 0).block[0] + make(&right, 1, 0).block[0];
    worst = fmax(worst, fabs(sum - make(&p, 1, 0).block[0]) / hr2d_exchange_area(&p.i, &p.j));
  }
  printf("parts are off by at most %.1e of the clear area\n", worst);
  ck_assert_double_lt(worst, 1e-14);
}
END_TEST

TEST_SUITE("gas areas") {
  ADD_TESTS("areas", areas_are_those_of_positions,
            what_arrives_and_what_is_absorbed_make_the_clear_area,
            blocks_of_any_order_begin_with_the_area, coefficients_are_those_of_positions);
  ADD_TESTS("limits", long_plates_are_a_plane_layer, thick_gas_leaves_corners_alone);
  ADD_TESTS("invariance", gas_knows_neither_place_nor_direction_nor_unit, parts_make_the_whole);
}
