/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes under a sun: against a Nyström method in which the lit parts of patches are patches
   that emit, against the balance of power, and against scenes of one band each. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "independent/sweep-nystrom.h"
#include "support/order.h"
#include "support/support.h"

enum { PARTS = 40 };

/* Ground, a roof and a screen with backs: ax ay bx by ρ.  All lie along the axes, so that parts
   of them are on one line whatever is rounded. */
static const double panels[][5] = {{-4, 0, 6, 0, .3},
                                   {-1, 1, .25, 1, .2},
                                   {.25, 1, -1, 1, .5},
                                   {1.5, .4, 1.5, 1.25, .2},
                                   {1.5, 1.25, 1.5, .4, .5}};
enum { PANELS = sizeof panels / sizeof *panels };

static hr2d_scene *make_scene(const hr2d_sun *sun, size_t suns, double background) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < PANELS; k++) {
    const double *p = panels[k];
    ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){{p[0], p[1]}, {p[2], p[3]}},
                                    k == 1 ? .7 : 0, p[4], HR2D_SIDES_FRONT),
                     HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_set_sun(scene, sun, suns), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &background, 1), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* The same with parts of patches between the shadows of all ends. */
typedef struct split {
  double at[PARTS][4], part[PARTS];
  size_t of[PARTS], count;
  swept_light light[PARTS];
  double direct[PARTS]; /* H_sun */
} split;

/* Whether something stands between a point of patch k and the sun. */
static int is_hidden(size_t k, double x, double y, hr2d_point d) {
  for (size_t j = 0; j < PANELS; j++) {
    const double *p = panels[j], vx = p[2] - p[0], vy = p[3] - p[1];
    const double across = vx * d.y - vy * d.x;
    const double t = ((x - p[0]) * d.y - (y - p[1]) * d.x) / across;
    const double u = ((x - p[0]) * vy - (y - p[1]) * vx) / across;
    if (j != k && t > 0 && t < 1 && u < -1e-9) return 1;
  }
  return 0;
}

static void add_part(split *s, size_t k, double from, double to, const hr2d_sun *sun) {
  const double *p = panels[k], vx = p[2] - p[0], vy = p[3] - p[1], middle = .5 * (from + to);
  const hr2d_point d = sun->direction;
  const double cosine = (d.x * vy - d.y * vx) / hypot(vx, vy) / hypot(d.x, d.y);
  const size_t n = s->count++;
  const double ends[] = {p[0] + from * vx, p[1] + from * vy, p[0] + to * vx, p[1] + to * vy};
  for (int m = 0; m < 4; m++) s->at[n][m] = (m < 2 ? from == 0 : to == 1) ? p[m] : ends[m];
  s->of[n] = k;
  s->part[n] = to - from;
  s->direct[n] = is_hidden(k, p[0] + middle * vx, p[1] + middle * vy, d)
                     ? 0
                     : sun->irradiance * fmax(cosine, 0);
  s->light[n] = (swept_light){{(k == 1 ? .7 : 0) + p[4] * s->direct[n]}, {p[4]}};
}

static split split_at_shadows(const hr2d_sun *sun) {
  split s = {.count = 0};
  const hr2d_point d = sun->direction;
  for (size_t k = 0; k < PANELS; k++) {
    const double *p = panels[k], vx = p[2] - p[0], vy = p[3] - p[1];
    double cut[2 * PANELS + 2] = {0};
    size_t cuts = 1;
    for (size_t j = 0; j < 2 * PANELS; j++) {
      const double *q = panels[j / 2] + 2 * (j % 2);
      const double t = (d.x * (q[1] - p[1]) - d.y * (q[0] - p[0])) / (d.x * vy - d.y * vx);
      if (t > 1e-9 && t < 1 - 1e-9) cut[cuts++] = t;
    }
    qsort(cut, cuts, sizeof *cut, order_doubles);
    for (size_t m = 0; m < cuts; m++) {
      const double to = m + 1 < cuts ? cut[m + 1] : 1;
      if (to - cut[m] > 1e-9) add_part(&s, k, cut[m], to, sun);
    }
  }
  return s;
}

/* Averages of H of patches by the Nyström method, the sun included. */
static void reference(const hr2d_sun *sun, double background, double *average) {
  const split s = split_at_shadows(sun);
  const swept_scene scene = {
      .patches = {s.count, s.at}, .light = s.light, .bands = 1, .background = {background}};
  swept_solution *swept = swept_solve(&scene, (swept_mesh){12, 1e-11});
  memset(average, 0, PANELS * sizeof *average);
  for (size_t n = 0; n < s.count; n++) {
    double h[SWEPT_BANDS];
    swept_average(swept, n, h);
    average[s.of[n]] += s.part[n] * (h[0] + s.direct[n]);
  }
  swept_destroy(swept);
}

static hr2d_solution *solve_to(const hr2d_scene *scene, double error, hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, account), HR2D_OK);
  return solution;
}

static const hr2d_sun suns[] = {{{.5, -1}, 2}, {{-1.3, -1}, 1}, {{0, -3}, 5}, {{4, -1}, 1}};
enum { SUNS = sizeof suns / sizeof *suns };

START_TEST(averages_are_those_of_lit_parts_that_emit) {
  const double background = _i % 2 ? .6 : 0;
  const hr2d_sun *sun = &suns[_i / 2];
  double h[PANELS];
  reference(sun, background, h);
  hr2d_scene *scene = make_scene(sun, 1, background);
  for (double error = 1e-2; error > 1e-11; error *= 1e-2) {
    hr2d_account account;
    hr2d_solution *solution = solve_to(scene, error, &account);
    double worst = 0;
    for (size_t k = 0; k < PANELS; k++)
      worst = fmax(worst, fabs(hr2d_solution_irradiance(solution, k, 0) / h[k] - 1));
    ck_assert_msg(worst <= account.irradiance.bound + 1e-10, "target %g: error %g, bound %g",
                  error, worst, account.irradiance.bound);
    ck_assert_double_le(worst, error + 1e-10);
    const hr2d_power p = hr2d_solution_power(solution, 0);
    double received = 0;
    for (size_t k = 0; k < PANELS; k++)
      received += hr2d_scene_length(scene, k) * hr2d_scene_sunlight(scene, k, 0);
    ck_assert_double_eq_tol(p.emitted + p.received, p.absorbed + p.escaped, 1e-12);
    if (background == 0) ck_assert_double_eq_tol(p.received, received, 1e-12);
    hr2d_solution_destroy(solution);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Negative control: without the sun, or with its light in another direction, H is another. */
START_TEST(without_the_sun_it_is_darker) {
  double h[PANELS], other[PANELS];
  const hr2d_sun none = {{0, -1}, 0};
  reference(&suns[0], 0, h);
  reference(&none, 0, other);
  for (size_t k = 0; k < PANELS; k++) ck_assert_double_gt(fabs(h[k] / other[k] - 1), 1e-2);
  reference(&suns[1], 0, other);
  for (size_t k = 0; k < PANELS; k++) ck_assert_double_gt(fabs(h[k] / other[k] - 1), 1e-2);
}
END_TEST

/* The exchange area of two segments in front of each other, by crossed strings. */
static double strings(hr2d_segment s, hr2d_segment t) {
  const double crossed =
      hypot(s.a.x - t.a.x, s.a.y - t.a.y) + hypot(s.b.x - t.b.x, s.b.y - t.b.y);
  const double sides =
      hypot(s.a.x - t.b.x, s.a.y - t.b.y) + hypot(s.b.x - t.a.x, s.b.y - t.a.y);
  return fabs(crossed - sides) / 2;
}

/* What the ground between two abscissae sends to a panel. */
static double from_ground(hr2d_segment panel, double from, double to) {
  return to > from ? strings(panel, (hr2d_segment){{from, 0}, {to, 0}}) : 0;
}

/* A black panel of tilt β above a ground of reflectance ρ.  What its two sides get from the
   ground is that of lit ground on their side of the panel's line, less the shadow; for an
   endless ground it is ρ I cos θ (1 ∓ cos β)/2 but for the shadow, the ground term of models of
   tilted panels. */
START_TEST(the_ground_term_is_that_of_crossed_strings) {
  const double tilt = .1 + .25 * _i, height = 2, half = 3000, rho = .2;
  const hr2d_segment up = {{0, height}, {cos(tilt), height + sin(tilt)}};
  const hr2d_sun sun = {{.3 * _i - .7, -1}, 900};
  const double on_ground = 900 / hypot(sun.direction.x, 1);
  const double foot = -height / tan(tilt); /* where the panel's line meets the ground */
  /* The shadow, and on which side of the line it lies: the panel's front looks to its left. */
  const double one = sun.direction.x * height, other = cos(tilt) + sun.direction.x * up.b.y;
  const double dark[2] = {fmin(one, other), fmax(one, other)};
  const double front =
      from_ground(up, -half, fmin(foot, dark[0])) + from_ground(up, fmin(foot, dark[1]), foot);
  const double back =
      from_ground(up, foot, fmax(foot, dark[0])) + from_ground(up, fmax(foot, dark[1]), half);
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_account account;
  hr2d_solution *solution;
  target.error = 1e-9;
  const hr2d_segment ground = {{-half, 0}, {half, 0}};
  ck_assert_int_eq(test_add_patch(scene, ground, 0, rho, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(test_add_patch(scene, up, 0, 0, HR2D_SIDES_BOTH), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  test_commit(scene);
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &account), HR2D_OK);
  for (size_t side = 1; side <= 2; side++) {
    const double got =
        hr2d_solution_irradiance(solution, side, 0) - hr2d_scene_sunlight(scene, side, 0);
    const double part = side == 1 ? front : back;
    const double endless = (1 - (side == 1 ? 1 : -1) * cos(tilt)) / 2;
    ck_assert_double_eq_tol(got, rho * on_ground * part, 1e-8 * on_ground);
    /* without its shadow the ground term is more, by less than the shadow is seen */
    ck_assert_double_le(got, rho * on_ground * endless + 1e-9);
    ck_assert_double_ge(got, rho * on_ground * (endless - .3));
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A room into which the sun falls, and where it falls all is black: no light is sent, B is 0 to
   the last bit, and the errors are finite.  Roundings of the level of a nearly closed room were
   taken for light that grows for ever. */
START_TEST(what_is_absorbed_at_once_sends_nothing) {
  static const double room[][5] = {{4, 1, 4, 3, .5},  {4, 3, 0, 3, .5},   {0, 3, 0, 0, .9},
                                   {0, 0, 4, 0, 0},   {4, 0, 4, .98, .5}, {2, 0, 2, 1.8, .95},
                                   {2, 1.8, 2, 0, .6}};
  const hr2d_sun sun = {{-3, -4}, 800};
  for (int order = 0; order < 3; order++) {
    hr2d_scene *scene = test_new_scene(NULL);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_account account;
    hr2d_solution *solution;
    for (size_t k = 0; k < sizeof room / sizeof *room; k++)
      ck_assert_int_eq(
          test_add_patch(scene,
                         (hr2d_segment){{room[k][0], room[k][1]}, {room[k][2], room[k][3]}}, 0,
                         room[k][4], HR2D_SIDES_FRONT),
          HR2D_OK);
    ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
    test_commit(scene);
    target.error = pow(10, -2 - 4 * order);
    target.points = 1;
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &account), HR2D_OK);
    /* The sun comes in through .02, at a slope of 4 to 3. */
    ck_assert_double_eq_tol(4 * hr2d_solution_irradiance(solution, 3, 0), 800 * .02 * .6, 1e-9);
    for (size_t k = 0; k < sizeof room / sizeof *room; k++) {
      ck_assert_double_eq(hr2d_solution_average(solution, k, 0), 0);
      if (k != 3) ck_assert_double_eq(hr2d_solution_irradiance(solution, k, 0), 0);
    }
    ck_assert(isfinite(account.sup.bound) && isfinite(account.average.bound));
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(bands_are_as_scenes_of_one_band) {
  hr2d_scene *all = make_scene(suns, SUNS, .2);
  hr2d_account account;
  hr2d_solution *together = solve_to(all, 1e-9, &account);
  for (size_t b = 0; b < SUNS; b++) {
    hr2d_scene *scene = make_scene(&suns[b], 1, .2);
    hr2d_solution *alone = solve_to(scene, 1e-9, &account);
    for (size_t k = 0; k < PANELS; k++)
      ck_assert_double_eq_tol(hr2d_solution_average(together, k, b),
                              hr2d_solution_average(alone, k, 0), 1e-8);
    hr2d_solution_destroy(alone);
    hr2d_scene_destroy(scene);
  }
  hr2d_solution_destroy(together);
  hr2d_scene_destroy(all);
}
END_TEST

/* One gather at a point has the light of the sun exactly, on any elements. */
START_TEST(points_have_the_light_of_the_sun) {
  hr2d_scene *scene = make_scene(&suns[0], 1, 0);
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  test_refine(&t, .01, 6);
  hr2d_solution *solution = test_solve(&t, 1);
  const split s = split_at_shadows(&suns[0]);
  const swept_scene reference = {
      .patches = {s.count, s.at}, .light = s.light, .bands = 1, .background = {0}};
  swept_solution *swept = swept_solve(&reference, (swept_mesh){12, 1e-11});
  double since = 0;
  for (size_t n = 0; n < s.count; n++) {
    if (n > 0 && s.of[n] != s.of[n - 1]) since = 0;
    const double at = since + .3 * s.part[n];
    double h, is[SWEPT_BANDS];
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, s.of[n], &at, 1, &h), HR2D_OK);
    swept_at(swept, n, .3L, is);
    ck_assert_double_eq_tol(h, is[0] + s.direct[n], 2e-2);
    ck_assert_double_eq_tol(hr2d_scene_sunlight_at(scene, s.of[n], at, 0), s.direct[n], 1e-14);
    since += s.part[n];
  }
  swept_destroy(swept);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}
END_TEST

/* A black floor under a sun, alone: M and Φ between it and a roof are those of a beam. */
START_TEST(fields_have_a_beam) {
  const double sky = 0;
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_sun sun = {{3, -4}, 2};
  test_add_black(scene, (const double[]){-9, 0, 9, 0});
  test_add_black(scene, (const double[]){1, 2, 0, 2});
  ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
  test_commit(scene);
  hr2d_account account;
  hr2d_solution *solution = solve_to(scene, 1e-6, &account);
  const hr2d_point at[] = {{0, 1}, {1.25, 1}, {2, 1}, {.5, 3}, {.8, 1.9}};
  static const int lit[] = {1, 0, 1, 1, 0};
  double mean[5], flux[10];
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  values.mean = mean;
  values.flux = flux;
  ck_assert_int_eq(hr2d_field_at(solution, at, 5, NULL, &values), HR2D_OK);
  for (int k = 0; k < 5; k++) {
    ck_assert_double_eq_tol(mean[k], lit[k] * 2 / 3.14159265358979323846, 1e-14);
    ck_assert_double_eq_tol(flux[2 * k], lit[k] * -1.2, 1e-14);
    ck_assert_double_eq_tol(flux[2 * k + 1], lit[k] * 1.6, 1e-14);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Grids are interpolated nowhere across a border of the light. */
START_TEST(grids_have_sharp_shadows) {
  enum { SIDE = 60 };
  hr2d_scene *scene = make_scene(&suns[0], 1, .3);
  hr2d_account account;
  hr2d_solution *solution = solve_to(scene, 1e-4, &account);
  static double mean[SIDE * SIDE];
  hr2d_field_grid grid = HR2D_FIELD_GRID_INIT;
  grid.low = (hr2d_point){-3, 0.05};
  grid.high = (hr2d_point){5, 2};
  grid.columns = grid.rows = SIDE;
  grid.tolerance = 1e-3;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  values.mean = mean;
  ck_assert_int_eq(hr2d_field_on_grid(solution, &grid, NULL, &values, NULL), HR2D_OK);
  double worst = 0, max = 0;
  for (int k = 0; k < SIDE * SIDE; k++) {
    const hr2d_point at = {-3 + 8. * (k % SIDE) / (SIDE - 1),
                           0.05 + 1.95 * (k / SIDE) / (SIDE - 1)};
    double exact;
    hr2d_field_values one = HR2D_FIELD_VALUES_INIT;
    one.mean = &exact;
    ck_assert_int_eq(hr2d_field_at(solution, &at, 1, NULL, &one), HR2D_OK);
    if (isnan(exact)) continue;
    worst = fmax(worst, fabs(exact - mean[k]));
    max = fmax(max, exact);
  }
  ck_assert_double_le(worst, 1e-3 * max);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("sun") {
  REPEAT_TESTS(2 * SUNS, "averages", averages_are_those_of_lit_parts_that_emit);
  REPEAT_TESTS(5, "ground", the_ground_term_is_that_of_crossed_strings);
  ADD_TESTS("averages", without_the_sun_it_is_darker, what_is_absorbed_at_once_sends_nothing,
            bands_are_as_scenes_of_one_band);
  ADD_TESTS("points", points_have_the_light_of_the_sun, fields_have_a_beam,
            grids_have_sharp_shadows);
}
