/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes under a sky in pieces: against closed forms, against a background, by superposition
   and rotation, and against the plain quadrature of rays to the sky. */
#include <math.h>

#include "support/support.h"

#define PI 3.14159265358979323846

/* A floor, a leaning roof with a back, and a post: ax ay bx by ρ. */
static const double walls[][5] = {{-3, 0, 3, 0, .4},
                                  {-1, 1, .5, 1.5, .3},
                                  {.5, 1.5, -1, 1, .6},
                                  {1.5, .3, 1.7, 1.2, .5},
                                  {1.7, 1.2, 1.5, .3, .2}};
enum { WALLS = sizeof walls / sizeof *walls };

static hr2d_point turn(double x, double y, double angle) {
  return (hr2d_point){x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)};
}

/* Turned counterclockwise by an angle; ρ times `part`. */
static hr2d_scene *make_walls(double angle, double part) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < WALLS; k++) {
    const double *w = walls[k];
    const hr2d_segment at = {turn(w[0], w[1], angle), turn(w[2], w[3], angle)};
    ck_assert_int_eq(test_add_patch(scene, at, 0, part * w[4], HR2D_SIDES_FRONT), HR2D_OK);
  }
  return scene;
}

static void set_sky(hr2d_scene *scene, const hr2d_sky_piece *piece, size_t pieces,
                    const double *value) {
  ck_assert_int_eq(hr2d_scene_set_sky(scene, piece, pieces, value, 1), HR2D_OK);
}

static hr2d_solution *solve_to(hr2d_scene *scene, double error, hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  test_commit(scene);
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, account), HR2D_OK);
  return solution;
}

/* Pieces all round of one radiosity are a background, and so are pieces beside a background of
   the same radiosity. */
START_TEST(a_uniform_sky_is_a_background) {
  static const hr2d_sky_piece all[] = {{-90, 30}, {30, 101}, {101, 270}}, some[] = {{-30, 40}};
  static const double value[] = {.7, .7, .7};
  double h[3][WALLS];
  for (int kind = 0; kind < 3; kind++) {
    hr2d_scene *scene = make_walls(0.3, 1);
    const double background = .7;
    hr2d_account account;
    if (kind != 1) ck_assert_int_eq(hr2d_scene_set_background(scene, &background, 1), HR2D_OK);
    if (kind == 1) set_sky(scene, all, 3, value);
    if (kind == 2) set_sky(scene, some, 1, value);
    hr2d_solution *solution = solve_to(scene, 1e-11, &account);
    for (size_t k = 0; k < WALLS; k++) h[kind][k] = hr2d_solution_irradiance(solution, k, 0);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  for (size_t k = 0; k < WALLS; k++) {
    ck_assert_double_eq_tol(h[1][k], h[0][k], 1e-10);
    ck_assert_double_eq_tol(h[2][k], h[0][k], 1e-10);
  }
}
END_TEST

/* Nothing stands in the way: H = ½ Σ L Δ sin φ, exactly, for a panel of any tilt.  A sky of 1
   above the horizon gives (1 + cos β)/2. */
START_TEST(open_panels_see_sines) {
  for (int k = 0; k <= 12; k++) {
    const double beta = k * PI / 12;
    hr2d_scene *scene = test_new_scene(NULL);
    const hr2d_segment panel = {{0, 0}, {cos(beta), sin(beta)}};
    static const hr2d_sky_piece dome[] = {{-90, 90}};
    const double one = 1;
    ck_assert_int_eq(test_add_patch(scene, panel, 0, 0, HR2D_SIDES_FRONT), HR2D_OK);
    set_sky(scene, dome, 1, &one);
    hr2d_account account;
    hr2d_solution *solution = solve_to(scene, 1e-9, &account);
    double at, t = .3;
    ck_assert_double_eq_tol(hr2d_solution_irradiance(solution, 0, 0), (1 + cos(beta)) / 2,
                            1e-14);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, 0, &t, 1, &at), HR2D_OK);
    ck_assert_double_eq_tol(at, (1 + cos(beta)) / 2, 1e-14);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

static const hr2d_sky_piece four[] = {{-90, -50}, {-50, -10}, {-10, 35}, {60, 90}};
static const double value[] = {3, .5, 2, 1};

/* ½ ∫ L cos φ dφ by many rays. */
static double by_rays(const hr2d_scene *scene, size_t patch, double t, size_t rays) {
  const double *w = walls[patch], x = w[0] + t * (w[2] - w[0]), y = w[1] + t * (w[3] - w[1]);
  const double length = hypot(w[2] - w[0], w[3] - w[1]);
  const hr2d_point u = {(w[2] - w[0]) / length, (w[3] - w[1]) / length}, n = {-u.y, u.x};
  double sum = 0;
  for (size_t k = 0; k < rays; k++) {
    const double s = -1 + 2 * ((double)k + .5) / (double)rays, c = sqrt(1 - s * s);
    const hr2d_point d = {s * u.x + c * n.x, s * u.y + c * n.y};
    int hidden = 0;
    for (size_t j = 0; j < WALLS && !hidden; j++) {
      const double *v = walls[j], vx = v[2] - v[0], vy = v[3] - v[1];
      const double at = ((x - v[0]) * d.y - (y - v[1]) * d.x) / (vx * d.y - vy * d.x);
      const double along = (v[0] + at * vx - x) * d.x + (v[1] + at * vy - y) * d.y;
      hidden = j != patch && at > 0 && at < 1 && along > 1e-9;
    }
    if (!hidden) sum += hr2d_scene_sky(scene, atan2(d.x, d.y) * 180 / PI, 0);
  }
  return sum / (double)rays;
}

START_TEST(points_see_what_rays_see) {
  hr2d_scene *scene = make_walls(0, 0);
  set_sky(scene, four, 4, value);
  hr2d_account account;
  hr2d_solution *solution = solve_to(scene, 1e-6, &account);
  for (size_t k = 0; k < WALLS; k++) {
    double mean = 0;
    for (int m = 0; m < 50; m++) {
      const double t = (m + .5) / 50;
      double h;
      ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, k, &t, 1, &h), HR2D_OK);
      ck_assert_double_eq_tol(h, by_rays(scene, k, t, 4000), 3e-3);
      mean += h / 50;
    }
    ck_assert_double_eq_tol(hr2d_solution_irradiance(solution, k, 0), mean, 3e-3);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Averages are integrals of points, to the target: elements end at kinks. */
START_TEST(averages_are_integrals_of_points) {
  hr2d_scene *scene = make_walls(0, 0);
  set_sky(scene, four, 4, value);
  hr2d_account account;
  hr2d_solution *solution = solve_to(scene, 1e-10, &account);
  for (size_t k = 0; k < WALLS; k++) {
    enum { CELLS = 20000 };
    double sum = 0;
    static double t[CELLS], h[CELLS];
    for (int m = 0; m < CELLS; m++) t[m] = (m + .5) / CELLS;
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, k, t, CELLS, h), HR2D_OK);
    for (int m = 0; m < CELLS; m++) sum += h[m] / CELLS;
    ck_assert_double_eq_tol(hr2d_solution_irradiance(solution, k, 0), sum, 1e-7);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

static void solve_pieces(double angle, const double *of, double *h) {
  hr2d_scene *scene = make_walls(angle, 1);
  hr2d_sky_piece turned[4];
  hr2d_account account;
  for (int k = 0; k < 4; k++) {
    const double back = angle * 180 / PI;
    turned[k] = (hr2d_sky_piece){four[k].from - back, four[k].to - back};
  }
  set_sky(scene, turned, 4, of);
  hr2d_solution *solution = solve_to(scene, 1e-10, &account);
  for (size_t k = 0; k < WALLS; k++) h[k] = hr2d_solution_irradiance(solution, k, 0);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}

START_TEST(skies_add_up_and_turn) {
  double all[WALLS], turned[WALLS], sum[WALLS] = {0};
  solve_pieces(0, value, all);
  solve_pieces(2.1, value, turned);
  for (int k = 0; k < 4; k++) {
    double one[4] = {0}, part[WALLS];
    one[k] = value[k];
    solve_pieces(0, one, part);
    for (size_t m = 0; m < WALLS; m++) sum[m] += part[m];
  }
  for (size_t m = 0; m < WALLS; m++) {
    ck_assert_double_eq_tol(turned[m], all[m], 1e-9);
    ck_assert_double_eq_tol(sum[m], all[m], 1e-9);
  }
  /* Negative control: another sky is another light. */
  const double other[] = {1, 2, .5, 3};
  solve_pieces(0, other, turned);
  for (size_t m = 0; m < WALLS; m++) ck_assert_double_gt(fabs(turned[m] / all[m] - 1), 1e-3);
}
END_TEST

/* A ground and a plate above it, both black. */
static hr2d_scene *make_plate(void) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_segment ground = {{0, 0}, {10, 0}}, plate = {{2.1, 1}, {2.4, 1}};
  ck_assert_int_eq(test_add_patch(scene, ground, 0, 0, HR2D_SIDES_FRONT), HR2D_OK);
  ck_assert_int_eq(test_add_patch(scene, plate, 0, 0, HR2D_SIDES_BOTH), HR2D_OK);
  return scene;
}

/* A narrow bright piece throws a shadow that may lie between the points of any rule.  The plate
   takes what the ground lacks: H = ½LΔ sin φ (1 − 0.3/10). */
START_TEST(narrow_pieces_throw_shadows_at_any_target) {
  for (double error = .3; error > 1e-9; error /= 10)
    for (double from = -50; from < 40; from += 12.5) {
      const hr2d_sky_piece piece = {from, from + .01};
      const double bright = 1e4, to = sin(piece.to * PI / 180);
      const double open = .5 * bright * (to - sin(from * PI / 180));
      hr2d_scene *scene = make_plate();
      hr2d_account account;
      set_sky(scene, &piece, 1, &bright);
      hr2d_solution *solution = solve_to(scene, error, &account);
      ck_assert_double_eq_tol(hr2d_solution_irradiance(solution, 0, 0), open * (1 - .03),
                              open * fmin(error, account.irradiance.bound + 1e-12));
      hr2d_solution_destroy(solution);
      hr2d_scene_destroy(scene);
    }
}
END_TEST

/* Pieces that differ in nothing are one, and bearings that are sums may overlap by roundings:
   a sky of 600 pieces costs what one of 3 does. */
START_TEST(equal_pieces_are_one) {
  enum { MANY = 600 };
  hr2d_sky_piece piece[MANY + 1];
  double of[MANY + 1], h[2];
  hr2d_account account[2];
  for (int kind = 0; kind < 2; kind++) {
    const size_t left = kind ? 200 : 1, right = kind ? 400 : 1;
    size_t count = 0;
    for (size_t k = 0; k < left; k++)
      piece[count++] = (hr2d_sky_piece){-90 + 60. / (double)left * (double)k,
                                        -90 + 60. / (double)left * (double)(k + 1)};
    piece[count++] = (hr2d_sky_piece){-30, -29.9};
    for (size_t k = 0; k < right; k++)
      piece[count++] = (hr2d_sky_piece){-29.9 + 119.9 / (double)right * (double)k,
                                        119.9 / (double)right * (double)(k + 1) - 29.9};
    for (size_t k = 0; k < count; k++) of[k] = k == left ? 300 : 1;
    hr2d_scene *scene = make_plate();
    set_sky(scene, piece, count, of);
    hr2d_solution *solution = solve_to(scene, 1e-8, &account[kind]);
    h[kind] = hr2d_solution_irradiance(solution, 0, 0);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  ck_assert_double_eq_tol(h[1], h[0], 1e-8 * h[0]);
  ck_assert_uint_eq(account[1].elements, account[0].elements);
}
END_TEST

/* Of many different pieces the smallest jumps are left inside elements: the errors that are
   told hold, beside the mean of points. */
START_TEST(many_pieces_have_their_errors) {
  enum { MOST = 700, CELLS = 20000 };
  static double t[CELLS], at[CELLS];
  randoms r = randoms_stream(test_seed(), 17);
  for (int m = 0; m < CELLS; m++) t[m] = (m + .5) / CELLS;
  for (size_t pieces = 20; pieces <= MOST; pieces *= 3) {
    hr2d_sky_piece piece[MOST];
    double of[MOST], mean = 0;
    for (size_t k = 0; k < pieces; k++) {
      piece[k] = (hr2d_sky_piece){-90 + 180. / (double)pieces * (double)k,
                                  -90 + 180. / (double)pieces * (double)(k + 1)};
      of[k] = k == pieces / 3 ? 50 : random_between(&r, 0, 1);
    }
    hr2d_scene *scene = make_plate();
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_account account;
    hr2d_solution *solution = NULL;
    set_sky(scene, piece, pieces, of);
    test_commit(scene);
    target.error = 1e-4;
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
    ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, 0, t, CELLS, at), HR2D_OK);
    for (int m = 0; m < CELLS; m++) mean += at[m] / CELLS;
    ck_assert_double_eq_tol(hr2d_solution_irradiance(solution, 0, 0), mean,
                            mean * (account.irradiance.bound + 1e-6));
    ck_assert_double_lt(account.irradiance.bound, .05);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* The error that is told holds, for each target. */
START_TEST(targets_hold) {
  double best[WALLS];
  solve_pieces(0, value, best);
  for (double error = 1e-2; error > 1e-9; error *= 1e-2) {
    hr2d_scene *scene = make_walls(0, 1);
    hr2d_account account;
    set_sky(scene, four, 4, value);
    hr2d_solution *solution = solve_to(scene, error, &account);
    for (size_t k = 0; k < WALLS; k++) {
      const double off = fabs(hr2d_solution_irradiance(solution, k, 0) / best[k] - 1);
      ck_assert_double_le(off, error);
      ck_assert_double_le(off, account.irradiance.bound + 1e-10);
    }
    const hr2d_power p = hr2d_solution_power(solution, 0);
    ck_assert_double_eq_tol(p.emitted + p.received, p.absorbed + p.escaped, 1e-11);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* M and Φ under a sky without anything else: of a half sky of 1 the mean is ½. */
START_TEST(fields_have_arcs) {
  static const hr2d_sky_piece left[] = {{-180, 0}};
  const double one = 1;
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_black(scene, (const double[]){0, -1e-3, 1e-9, -1e-3});
  set_sky(scene, left, 1, &one);
  hr2d_account account;
  hr2d_solution *solution = solve_to(scene, 1e-3, &account);
  const hr2d_point at = {3, 4};
  double mean, flux[2];
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  values.mean = &mean;
  values.flux = flux;
  ck_assert_int_eq(hr2d_field_at(solution, &at, 1, NULL, &values), HR2D_OK);
  ck_assert_double_eq_tol(mean, .5, 1e-9);
  ck_assert_double_eq_tol(flux[0], -1, 1e-9);
  ck_assert_double_eq_tol(flux[1], 0, 1e-9);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(what_is_no_sky_is_refused) {
  static const hr2d_sky_piece bad[][2] = {{{0, 0}, {1, 2}},     {{0, 361}, {1, 2}},
                                          {{0, NAN}, {1, 2}},   {{0, 10}, {9, 20}},
                                          {{350, 370}, {0, 5}}, {{-90, 90}, {269, 271}}};
  const double good[] = {1, 2}, wrong[] = {1, -2};
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
    ck_assert_int_eq(hr2d_scene_set_sky(scene, bad[k], 2, good, 1), HR2D_ESCENE);
  ck_assert_int_eq(hr2d_scene_set_sky(scene, four, 2, wrong, 1), HR2D_ESCENE);
  ck_assert_int_eq(hr2d_scene_set_sky(scene, NULL, 2, good, 1), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_scene_set_sky(scene, four, 2, good, 1), HR2D_OK);
  ck_assert_uint_gt(hr2d_scene_sky_pieces(scene), 1);
  ck_assert_double_eq(hr2d_scene_sky(scene, -90, 0), 1);
  ck_assert_double_eq(hr2d_scene_sky(scene, 310, 0), 2);
  ck_assert_double_eq(hr2d_scene_sky(scene, 10, 0), 0);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("sky") {
  ADD_TESTS("sky", a_uniform_sky_is_a_background, open_panels_see_sines,
            points_see_what_rays_see, averages_are_integrals_of_points, skies_add_up_and_turn,
            targets_hold, fields_have_arcs);
  ADD_TESTS("pieces", narrow_pieces_throw_shadows_at_any_target, equal_pieces_are_one,
            many_pieces_have_their_errors);
  ADD_TESTS("calls", what_is_no_sky_is_refused);
}
