/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes with mirrors against the same scenes unfolded by hand and solved without symmetry:
   elements of one epsilon, and of a target. */
#include <math.h>
#include <string.h>

#include "support/support.h"

enum { BASE = 8, BANDS = 2 };

/* The part of a room in x ≥ 0, y ≥ 0, open along both axes: ax ay bx by, E and ρ of two bands.
   No two lengths are alike, nor are they multiples of each other. */
static const double base[BASE][8] = {
    {2.13, 0, 2.41, 1.31, 1, .1, .3, .6}, {2.41, 1.31, 1.07, 1.83, 0, .2, .5, .2},
    {1.07, 1.83, 0, 1.69, .2, 0, .7, .4}, {.61, .37, 1.17, .89, 0, 0, .5, .5},
    {1.17, .89, .61, .37, .3, 0, .4, .8}, {.53, 1.47, .29, 1.13, 0, .5, .6, .1},
    {.29, 1.13, .53, 1.47, 0, 0, .2, .3}, {1.71, .23, 1.93, .31, 0, 0, .9, .7}};

/* x → −x and y → −y, then a turn and a shift. */
typedef struct frame {
  double angle;
  hr2d_point shift;
} frame;

static const frame frames[] = {{0, {0, 0}}, {.7, {3.1, -1.7}}, {-2.3, {-40, 25}}};

static hr2d_point place(const frame *f, double x, double y) {
  const double c = cos(f->angle), s = sin(f->angle);
  return (hr2d_point){c * x - s * y + f->shift.x, s * x + c * y + f->shift.y};
}

/* Bit 0 of `image` reflects at x = 0, bit 1 at y = 0. */
static void add_image(hr2d_scene *scene, const frame *f, unsigned image) {
  const double sx = image & 1 ? -1 : 1, sy = image & 2 ? -1 : 1;
  for (size_t k = 0; k < BASE; k++) {
    const double *p = base[k];
    const hr2d_point a = place(f, sx * p[0], sy * p[1]), b = place(f, sx * p[2], sy * p[3]);
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = sx * sy < 0 ? b : a;
    patch.b = sx * sy < 0 ? a : b;
    patch.emission = p + 4;
    patch.reflectance = p + 6;
    patch.emission_bands = patch.reflectance_bands = BANDS;
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
}

static hr2d_segment mirror_line(const frame *f, int second) {
  return (hr2d_segment){place(f, 0, 0), second ? place(f, 1, 0) : place(f, 0, 1)};
}

typedef struct outside {
  double background;
  int sun, sky;
} outside;

/* A sun along the first mirror, and a sky that is symmetric in it. */
static void set_outside(hr2d_scene *scene, const frame *f, outside o) {
  const double background[BANDS] = {o.background, .5 * o.background};
  const hr2d_point from = place(f, 0, 0), to = place(f, 0, -1);
  const hr2d_sun sun = {{to.x - from.x, to.y - from.y}, 3};
  const double middle = -f->angle * 180 / 3.14159265358979323846;
  const hr2d_sky_piece piece[3] = {
      {middle - 60, middle - 20}, {middle - 20, middle + 20}, {middle + 20, middle + 60}};
  const double value[3] = {2, 5, 2};
  if (o.background > 0)
    ck_assert_int_eq(hr2d_scene_set_background(scene, background, BANDS), HR2D_OK);
  if (o.sun) ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  if (o.sky) ck_assert_int_eq(hr2d_scene_set_sky(scene, piece, 3, value, 1), HR2D_OK);
}

static hr2d_scene *folded(const frame *f, int mirrors, outside o) {
  hr2d_scene *scene = test_new_scene(NULL);
  add_image(scene, f, 0);
  for (int m = 0; m < mirrors; m++)
    ck_assert_int_eq(hr2d_scene_add_mirror(scene, mirror_line(f, m)), HR2D_OK);
  set_outside(scene, f, o);
  test_commit(scene);
  ck_assert_uint_eq(hr2d_scene_patches(scene), BASE);
  ck_assert_uint_eq(hr2d_scene_images(scene), (size_t)1 << mirrors);
  ck_assert(hr2d_scene_cut_off(scene) == 0);
  return scene;
}

static hr2d_scene *unfolded(const frame *f, int mirrors, outside o) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (unsigned image = 0; image < 1U << mirrors; image++) add_image(scene, f, image);
  set_outside(scene, f, o);
  test_commit(scene);
  return scene;
}

/* Averages of B and H of the patches of the base. */
typedef struct answer {
  double b[BASE * BANDS], h[BASE * BANDS];
  hr2d_power power[BANDS];
  uint64_t links;
} answer;

static answer read(const hr2d_solution *solution) {
  answer a = {.links = hr2d_linkset_size(hr2d_solution_links(solution))};
  for (size_t k = 0; k < BASE * BANDS; k++) {
    a.b[k] = hr2d_solution_average(solution, k / BANDS, k % BANDS);
    a.h[k] = hr2d_solution_irradiance(solution, k / BANDS, k % BANDS);
  }
  for (size_t b = 0; b < BANDS; b++) a.power[b] = hr2d_solution_power(solution, b);
  return a;
}

static double largest_difference(const answer *a, const answer *b) {
  double max = 0, off = 0;
  for (size_t k = 0; k < BASE * BANDS; k++) {
    max = fmax(max, fmax(b->b[k], b->h[k]));
    off = fmax(off, fmax(fabs(a->b[k] - b->b[k]), fabs(a->h[k] - b->h[k])));
  }
  return off / max;
}

/* The powers of the unfolded scene are those of the cell for each image. */
static double power_difference(const answer *a, const answer *b, double images) {
  double off = 0;
  for (size_t k = 0; k < BANDS; k++) {
    const hr2d_power p = a->power[k], q = b->power[k];
    const double max = q.emitted + q.received;
    off = fmax(off, fabs(images * p.emitted - q.emitted) / max);
    off = fmax(off, fabs(images * p.received - q.received) / max);
    off = fmax(off, fabs(images * p.absorbed - q.absorbed) / max);
    off = fmax(off, fabs(images * p.escaped - q.escaped) / max);
  }
  return off;
}

typedef struct method {
  const hr2d_oracle *oracle;
  unsigned order, threads;
  double epsilon;
  int directed;
} method;

static answer solve_with(hr2d_scene *scene, const method *m) {
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options how = HR2D_SOLVE_OPTIONS_INIT;
  options.epsilon = m->epsilon;
  options.threads = how.threads = m->threads;
  how.tolerance = 1e-15;
  how.max_iterations = 60;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_set_order(hierarchy, m->order), HR2D_OK);
  ck_assert_int_eq(
      hr2d_linkset_create(hierarchy, m->oracle, NULL, hr2d_policy_modified(), NULL, &links),
      HR2D_OK);
  ck_assert_int_eq(hr2d_refine(links, &options), HR2D_OK);
  ck_assert_msg(hr2d_linkset_validate(links) == HR2D_OK, "%s", hr2d_linkset_message(links));
  const hr2d_status status = hr2d_solve(links, &how, &solution);
  ck_assert_msg(status == HR2D_OK, "%s", hr2d_linkset_message(links));
  const answer a = read(solution);
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  return a;
}

/* What is compared, and how far it may be apart. */
static void expect_same(const frame *f, int mirrors, outside o, const method *m, double bar) {
  hr2d_scene *cell = folded(f, mirrors, o), *whole = unfolded(f, mirrors, o);
  const answer a = solve_with(cell, m), b = solve_with(whole, m);
  const double images = 1 << mirrors;
  const double off = largest_difference(&a, &b), power = power_difference(&a, &b, images);
  ck_assert_msg(off <= bar && power <= bar, "%g and %g off, %d mirrors, angle %g, order %u",
                off, power, mirrors, f->angle, m->order);
  /* Pairs of a patch and its own image are linked as a whole. */
  if (!m->directed) ck_assert(images * (double)a.links <= 1.5 * (double)b.links);
  hr2d_scene_destroy(cell);
  hr2d_scene_destroy(whole);
}

START_TEST(one_epsilon_has_the_digits_of_the_unfolded_scene) {
  const method m = {hr2d_oracle_size(), 1, 1, .3, 0};
  for (int mirrors = 1; mirrors <= 2; mirrors++) {
    expect_same(&frames[0], mirrors, (outside){0, 0, 0}, &m, 1e-12);
    expect_same(&frames[0], mirrors, (outside){1, 0, 0}, &m, 1e-12);
  }
  expect_same(&frames[0], 1, (outside){0, 1, 0}, &m, 1e-12);
  expect_same(&frames[0], 1, (outside){.5, 0, 1}, &m, 1e-12);
}
END_TEST

START_TEST(turned_and_shifted_scenes_have_them_up_to_coordinates) {
  const method m = {hr2d_oracle_size(), 1, 1, .3, 0};
  for (size_t k = 1; k < 3; k++)
    for (int mirrors = 1; mirrors <= 2; mirrors++)
      expect_same(&frames[k], mirrors, (outside){.5, 0, 0}, &m, k == 1 ? 1e-12 : 1e-11);
  expect_same(&frames[1], 1, (outside){.5, 1, 1}, &m, 1e-12);
}
END_TEST

START_TEST(higher_orders_have_them_too) {
  for (unsigned order = 2; order <= 5; order++) {
    const method m = {hr2d_oracle_size(), order, 1, .6, 0};
    expect_same(&frames[0], 1, (outside){.5, 1, 1}, &m, 1e-12);
    expect_same(&frames[0], 2, (outside){.5, 0, 0}, &m, 1e-12);
  }
}
END_TEST

START_TEST(directed_links_have_them_too) {
  const method m = {hr2d_oracle_bf(), 1, 1, .004, 1};
  expect_same(&frames[0], 1, (outside){.5, 0, 0}, &m, 1e-12);
  expect_same(&frames[0], 2, (outside){0, 0, 0}, &m, 1e-12);
}
END_TEST

START_TEST(no_bit_depends_on_threads) {
  for (unsigned order = 1; order <= 3; order += 2) {
    answer a[2];
    for (unsigned k = 0; k < 2; k++) {
      const method m = {hr2d_oracle_size(), order, 1 + 2 * k, .2, 0};
      hr2d_scene *scene = folded(&frames[1], 2, (outside){.5, 0, 0});
      a[k] = solve_with(scene, &m);
      hr2d_scene_destroy(scene);
    }
    ck_assert_mem_eq(a[0].b, a[1].b, sizeof a[0].b);
    ck_assert_mem_eq(a[0].h, a[1].h, sizeof a[0].h);
  }
}
END_TEST

static double largest_average(const hr2d_solution *solution) {
  const hr2d_hierarchy *trees = hr2d_linkset_hierarchy(hr2d_solution_links(solution));
  const size_t patches = hr2d_scene_patches(hr2d_hierarchy_scene(trees));
  double max = 0;
  for (size_t k = 0; k < patches * BANDS; k++)
    max = fmax(max, hr2d_solution_average(solution, k / BANDS, k % BANDS));
  return max;
}

/* Two solves to the same target, and the errors that they tell.  With few cases the target is
   nearer. */
static void expect_same_to(int mirrors, outside o) {
  hr2d_scene *scene[2] = {folded(&frames[0], mirrors, o), unfolded(&frames[0], mirrors, o)};
  const double error = test_multiplier() < 0.1 ? 1e-5 : 1e-9;
  answer a[2];
  double bound = 0, at_points = 0;
  for (int k = 0; k < 2; k++) {
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_account account;
    hr2d_solution *solution;
    target.error = error;
    target.points = 1; /* averages are asked for, and points are told */
    ck_assert_int_eq(hr2d_solve_to(scene[k], &target, &solution, &account), HR2D_OK);
    ck_assert(account.average.estimate <= error && account.irradiance.estimate <= error);
    bound += account.average.bound + account.irradiance.bound;
    at_points += account.sup.bound;
    a[k] = read(solution);
    const double at[3] = {0, .37, 1};
    double value[3 * BANDS];
    ck_assert_int_eq(hr2d_solution_gather(solution, 3, at, 3, value), HR2D_OK);
    static double former[3 * BANDS];
    for (size_t m = 0; m < 3 * BANDS && k; m++)
      ck_assert_double_eq_tol(value[m], former[m], at_points * largest_average(solution));
    memcpy(former, value, sizeof value);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene[k]);
  }
  const double off = largest_difference(&a[0], &a[1]);
  ck_assert_msg(off <= fmin(2 * error, bound), "%g off, with bounds of %g", off, bound);
}

START_TEST(targets_are_met_as_without_symmetry) {
  expect_same_to(1, (outside){0, 0, 0});
  expect_same_to(1, (outside){.5, 1, 1});
  expect_same_to(2, (outside){.5, 0, 0});
}
END_TEST

/* With the mirror the room is closed by it; without it light is lost. */
START_TEST(the_mirror_matters) {
  const method m = {hr2d_oracle_size(), 1, 1, .3, 0};
  hr2d_scene *cell = folded(&frames[0], 1, (outside){0, 0, 0});
  hr2d_scene *half = unfolded(&frames[0], 0, (outside){0, 0, 0});
  const answer a = solve_with(cell, &m), b = solve_with(half, &m);
  ck_assert(largest_difference(&a, &b) > 1e-2);
  hr2d_scene_destroy(cell);
  hr2d_scene_destroy(half);
}
END_TEST

static hr2d_status take_row(void *ctx, const hr2d_exchange_row *row) {
  double *area = ctx;
  for (size_t k = 0; k < row->count; k++)
    area[row->patch * BASE + row->column[k]] = row->area[k];
  return HR2D_OK;
}

/* Exchange areas of patches are sums over all images, in a matrix and in rows. */
START_TEST(view_factors_are_those_of_all_images) {
  for (int mirrors = 1; mirrors <= 2; mirrors++) {
    const size_t images = (size_t)1 << mirrors, n = images * BASE;
    hr2d_scene *cell = folded(&frames[0], mirrors, (outside){0, 0, 0});
    hr2d_scene *whole = unfolded(&frames[0], mirrors, (outside){0, 0, 0});
    static double area[BASE * BASE], all[16 * BASE * BASE], shown[BASE * BASE];
    hr2d_exchange_rows *rows;
    ck_assert_int_eq(hr2d_exchange_matrix(cell, NULL, area, NULL), HR2D_OK);
    ck_assert_int_eq(hr2d_exchange_matrix(whole, NULL, all, NULL), HR2D_OK);
    ck_assert_int_eq(hr2d_exchange_rows_create(cell, NULL, &rows, NULL), HR2D_OK);
    memset(shown, 0, sizeof shown);
    ck_assert_int_eq(hr2d_exchange_rows_visit(cell, NULL, take_row, shown, NULL), HR2D_OK);
    ck_assert_mem_eq(shown, area, sizeof area);
    uint64_t entries = 0;
    for (size_t i = 0; i < BASE; i++)
      for (size_t k = 0; k < BASE; k++) {
        double sum = 0;
        for (size_t g = 0; g < images; g++) sum += all[i * n + g * BASE + k];
        ck_assert_double_eq_tol(area[i * BASE + k], sum, 1e-14);
        ck_assert_double_eq(area[i * BASE + k], area[k * BASE + i]);
        entries += area[i * BASE + k] != 0;
      }
    ck_assert_uint_eq(hr2d_exchange_rows_entries(rows), entries);
    hr2d_exchange_rows_destroy(rows);
    hr2d_scene_destroy(cell);
    hr2d_scene_destroy(whole);
  }
}
END_TEST

/* Points on both sides of the mirror, one of them near a patch. */
START_TEST(fields_are_those_of_the_unfolded_scene) {
  static const hr2d_point at[] = {{.2, .3}, {1.5, 1.2}, {-.2, .3}, {.9, .62}, {-1.9, .9}};
  enum { POINTS = sizeof at / sizeof *at };
  double mean[2][POINTS * BANDS], flux[2][2 * POINTS * BANDS];
  for (int k = 0; k < 2; k++) {
    const outside o = {.5, 1, 0};
    hr2d_scene *scene = k ? unfolded(&frames[0], 1, o) : folded(&frames[0], 1, o);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *solution;
    target.error = 1e-8;
    hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
    values.mean = mean[k];
    values.flux = flux[k];
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, NULL), HR2D_OK);
    ck_assert_int_eq(hr2d_field_at(solution, at, POINTS, NULL, &values), HR2D_OK);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  for (size_t k = 0; k < POINTS * BANDS; k++)
    ck_assert_double_eq_tol(mean[0][k], mean[1][k], 1e-7);
  for (size_t k = 0; k < 2 * POINTS * BANDS; k++)
    ck_assert_double_eq_tol(flux[0][k], flux[1][k], 1e-7);
  for (size_t b = 0; b < BANDS; b++)
    ck_assert_double_eq_tol(mean[0][b], mean[0][2 * BANDS + b], 1e-7);
}
END_TEST

/* A half of a room in equilibrium stays so. */
START_TEST(isothermal_halves_stay_isothermal) {
  static const double half[][6] = {
      {0, 0, 2, 0, .5, .5}, {2, 0, 2, 1, .2, .8}, {2, 1, 0, 1, .9, .1}};
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_solution *solution;
  hr2d_account account;
  for (size_t k = 0; k < 3; k++)
    test_add_patch(scene, (hr2d_segment){{half[k][0], half[k][1]}, {half[k][2], half[k][3]}},
                   half[k][4], half[k][5], HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 0}, {0, 1}}), HR2D_OK);
  test_commit(scene);
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-12;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &account), HR2D_OK);
  for (size_t k = 0; k < 3; k++)
    ck_assert_double_eq_tol(hr2d_solution_average(solution, k, 0), 1, 4e-15);
  ck_assert_double_eq_tol(hr2d_solution_power(solution, 0).escaped, 0, 1e-14);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("mirrors") {
  ADD_TESTS("epsilon", one_epsilon_has_the_digits_of_the_unfolded_scene,
            turned_and_shifted_scenes_have_them_up_to_coordinates, higher_orders_have_them_too,
            directed_links_have_them_too, no_bit_depends_on_threads);
  ADD_TESTS("target", targets_are_met_as_without_symmetry, isothermal_halves_stay_isothermal);
  ADD_TESTS("factors", view_factors_are_those_of_all_images);
  ADD_TESTS("points", fields_are_those_of_the_unfolded_scene);
  ADD_TESTS("control", the_mirror_matters);
}
