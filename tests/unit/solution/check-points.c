/* SPDX-License-Identifier: GPL-3.0-or-later */
/* B, H and B − H at points, where they are known: at the edge of a wedge, in rooms in which
   B = 1, and on black walls, where H is a sum of angles.  Ends of patches and the feet of walls
   have the limit from the inside of their patch. */
#include <math.h>

#include "support/plane.h"
#include "support/support.h"

/* The scene, solved to a target. */
static hr2d_solution *solve(const hr2d_scene *scene, double error) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  target.error = error;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, NULL), HR2D_OK);
  return solution;
}

/* The paper's algorithm. */
static hr2d_solution *solve_by_size(hr2d_scene *scene, hr2d_hierarchy **hierarchy,
                                    hr2d_linkset **links) {
  hr2d_solution *solution;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(*hierarchy, NULL, NULL, NULL, NULL, links), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(*links, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(*links, NULL, &solution), HR2D_OK);
  return solution;
}

static double radiosity_at(const hr2d_solution *solution, size_t patch, double t) {
  double value;
  ck_assert_int_eq(hr2d_solution_gather(solution, patch, &t, 1, &value), HR2D_OK);
  return value;
}

static double irradiance_at(const hr2d_solution *solution, size_t patch, double t) {
  double value;
  ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, patch, &t, 1, &value), HR2D_OK);
  return value;
}

/* Two patches that meet at the origin under an angle, p along x and q beyond it. */
enum { P, Q };
static const double emission[] = {1, 0.25}, reflectance[] = {0.7, 0.9};

static hr2d_scene *make_wedge(double angle) {
  const hr2d_point end = plane_polar((hr2d_point){0, 0}, 0.8, angle);
  return test_scene((const double[][6]){{0, 0, 1, 0, emission[P], reflectance[P]},
                                        {end.x, end.y, 0, 0, emission[Q], reflectance[Q]}},
                    2);
}

/* The limits of B at the edge solve b_p = E_p + ρ_p k b_q and b_q = E_q + ρ_q k b_p, where each
   patch fills k = ½(1 + cos α) of the other's directions. */
static void expect_wedge(const hr2d_solution *solution, double angle) {
  const double k = 0.5 * (1 + cos(angle));
  const double both = 1 - reflectance[P] * reflectance[Q] * k * k;
  const double b[] = {(emission[P] + reflectance[P] * k * emission[Q]) / both,
                      (emission[Q] + reflectance[Q] * k * emission[P]) / both};
  ck_assert_double_eq_tol(radiosity_at(solution, P, 0), b[P], 1e-14 * b[P]);
  ck_assert_double_eq_tol(radiosity_at(solution, Q, 1), b[Q], 1e-14 * b[Q]);
  ck_assert_double_eq_tol(irradiance_at(solution, P, 0), k * b[Q], 1e-14 * b[Q]);
  ck_assert_double_eq_tol(irradiance_at(solution, Q, 1), k * b[P], 1e-14 * b[P]);
  /* The test sees a wedge that is not closed: without q there is no H. */
  ck_assert_double_gt(fabs(emission[P] - b[P]), 1e-3);
}

START_TEST(edges_of_wedges) {
  for (int degrees = 10; degrees < 180; degrees += 20) {
    const double angle = degrees * (acos(-1) / 180);
    hr2d_scene *scene = make_wedge(angle);
    hr2d_hierarchy *hierarchy;
    hr2d_linkset *links;
    hr2d_solution *fine = solve(scene, 1e-6), *coarse = solve(scene, 0.1);
    hr2d_solution *by_size = solve_by_size(scene, &hierarchy, &links);
    expect_wedge(fine, angle);
    expect_wedge(coarse, angle);
    expect_wedge(by_size, angle);
    hr2d_solution_destroy(by_size);
    hr2d_linkset_destroy(links);
    hr2d_hierarchy_destroy(hierarchy);
    hr2d_solution_destroy(coarse);
    hr2d_solution_destroy(fine);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A wall with two sides stands on a floor under an angle, and all is turned: at its foot each
   side makes a wedge with the floor, whose part beside the foot sees nothing else. */
START_TEST(feet_of_walls) {
  for (int degrees = 15; degrees < 180; degrees += 30) {
    const double turn = 0.3 * _i, angle = degrees * (acos(-1) / 180);
    const hr2d_point start = {0.1, 0.2}, end = plane_polar(start, 2, turn);
    const hr2d_point foot = plane_along((hr2d_segment){start, end}, 0.35);
    const hr2d_segment wall = {foot, plane_polar(foot, 0.8, turn + angle)};
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){start, end}, emission[P],
                                    reflectance[P], HR2D_SIDES_FRONT),
                     HR2D_OK);
    ck_assert_int_eq(test_add_patch(scene, wall, emission[Q], reflectance[Q], HR2D_SIDES_BOTH),
                     HR2D_OK);
    test_commit(scene);
    hr2d_solution *solution = solve(scene, 1e-3);
    for (size_t side = 0; side < 2; side++) {
      const double k = 0.5 * (1 + (side ? cos(angle) : -cos(angle)));
      const double h = k * (emission[P] + reflectance[P] * k * emission[Q]) /
                       (1 - reflectance[P] * reflectance[Q] * k * k);
      ck_assert_double_eq_tol(irradiance_at(solution, 1 + side, (double)side), h, 1e-11);
    }
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* B changes by no jump towards the edge: the limit is that of points just before it.  Near it
   B − B(0) ~ x^γ with γ above ½ for this wedge. */
START_TEST(points_beside_an_edge) {
  hr2d_scene *scene = make_wedge(1.2);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  target.error = 1e-9;
  target.norm = HR2D_NORM_SUP;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, NULL), HR2D_OK);
  const double limit = radiosity_at(solution, P, 0);
  double before = HUGE_VAL;
  for (int k = 6; k < 60; k += 4) {
    const double apart = fabs(radiosity_at(solution, P, ldexp(1, -k)) - limit);
    ck_assert_double_lt(apart, 2 * ldexp(1, -k / 2) + 1e-9);
    ck_assert_double_lt(apart, before + 1e-9);
    before = apart;
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A partition hangs from a ceiling, which is bright on one side of it and dark on the other:
   points of the partition beside its foot do not see the other side.  B has no jump there, and
   changes as x^γ with γ above ½. */
START_TEST(points_beside_a_foot) {
  hr2d_scene *scene = test_new_scene(NULL);
  const double room[][6] = {{0, 0, 1.25, 0, 0, .5},
                            {1.25, 0, 1.25, 1, 0, .5},
                            {1.25, 1, 0, 1, 0, .5},
                            {0, 1, 0, 0, 1, .9}};
  for (int k = 0; k < 4; k++)
    test_add_patch(scene, (hr2d_segment){{room[k][0], room[k][1]}, {room[k][2], room[k][3]}},
                   room[k][4], room[k][5], HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{.25, .5}, {.25, 1}}, 0, .5, HR2D_SIDES_BOTH);
  test_commit(scene);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  target.error = 1e-6;
  target.norm = HR2D_NORM_SUP;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, NULL), HR2D_OK);
  for (size_t side = 4; side < 6; side++) { /* the foot ends the front, and begins the back */
    const double limit = radiosity_at(solution, side, side == 4 ? 1 : 0);
    for (int k = 1; k < 400; k += k < 40 ? 1 : 20) {
      const double x = k * 0x1p-53, t = side == 4 ? 1 - x : x;
      ck_assert_double_eq_tol(radiosity_at(solution, side, t), limit, 2e-7);
    }
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A room of E = 0.2 and ρ = 0.8 with a wall that stands on its slanted floor and one that
   stands in the air: B = H = 1 at every point of each patch. */
static hr2d_scene *make_furnace(double turn, double x, double y) {
  static const double at[][4] = {{0, 0, 3, 0.1},   {3, 0.1, 3.1, 2},      {3.1, 2, 0.1, 2.2},
                                 {0.1, 2.2, 0, 0}, {1.5, 0.05, 1.2, 1.1}, {2.2, 1, 2.6, 1.4}};
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
    const double c = cos(turn), s = sin(turn), *p = at[k];
    const hr2d_segment turned = {{x + c * p[0] - s * p[1], y + s * p[0] + c * p[1]},
                                 {x + c * p[2] - s * p[3], y + s * p[2] + c * p[3]}};
    ck_assert_int_eq(
        test_add_patch(scene, turned, 0.2, 0.8, k < 4 ? HR2D_SIDES_FRONT : HR2D_SIDES_BOTH),
        HR2D_OK);
  }
  test_commit(scene);
  return scene;
}

START_TEST(ends_and_feet_in_furnaces) {
  static const double t[] = {0,   1e-300, 1e-16,    1e-14,     1e-12,       1e-9, 0.1,
                             0.5, 0.9,    1 - 1e-9, 1 - 1e-14, 1 - 0x1p-53, 1};
  const double moved = _i == 2 ? 1000 : 0, tolerance = _i == 2 ? 1e-11 : 1e-13;
  hr2d_scene *scene = make_furnace(_i ? 0.7 : 0, moved, moved);
  hr2d_solution *solution = solve(scene, 1e-3);
  for (size_t patch = 0; patch < hr2d_scene_patches(scene); patch++)
    for (size_t k = 0; k < sizeof t / sizeof *t; k++) {
      ck_assert_double_eq_tol(radiosity_at(solution, patch, t[k]), 1, tolerance);
      ck_assert_double_eq_tol(irradiance_at(solution, patch, t[k]), 1, tolerance);
    }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A black room with a lamp in its ceiling, and a table in the way. */
enum { LAMP, FLOOR, TABLE = 5, TABLE_BACK };
static const double black_room[][6] = {
    {2, 3, 1, 3, 1, 0}, {0, 0, 4, 0, 0, 0},   {4, 0, 4, 3, 0, 0},   {4, 3, 2, 3, 0, 0},
    {0, 3, 0, 0, 0, 0}, {1, 1, 2, 1.2, 0, 0}, {2, 1.2, 1, 1, 0, 0}, {1, 3, 0, 3, 0, 0}};

/* The sine of the direction from a point of the floor, to the right of its normal. */
static double sine(double x, double px, double py) {
  return (px - x) / hypot(px - x, py);
}

/* H on the floor is ½ ∫ cos θ over the directions of the lamp without those of the table. */
static double floor_irradiance(double x) {
  const double low = sine(x, 1, 3), high = sine(x, 2, 3);
  const double from = fmax(low, fmin(sine(x, 1, 1), sine(x, 2, 1.2)));
  const double to = fmin(high, fmax(sine(x, 1, 1), sine(x, 2, 1.2)));
  return 0.5 * (high - low - fmax(to - from, 0));
}

START_TEST(irradiance_on_black_walls) {
  hr2d_scene *scene = test_scene(black_room, sizeof black_room / sizeof *black_room);
  hr2d_solution *solution = solve(scene, 1e-3);
  double largest = 0, received = 0;
  for (int k = 0; k <= 1000; k++) {
    const double t = k / 1000.0, h = irradiance_at(solution, FLOOR, t);
    ck_assert_double_eq_tol(h, floor_irradiance(4 * t), 1e-14);
    largest = fmax(largest, fabs(hr2d_solution_irradiance_at(solution, FLOOR, t, 0) - h));
  }
  /* One polynomial for the floor is far off: the test tells them apart. */
  ck_assert_double_gt(largest, 1e-3);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    received += hr2d_scene_length(scene, k) * hr2d_solution_irradiance(solution, k, 0);
  ck_assert_double_eq_tol(received, 1, 1e-15);
  ck_assert_double_eq_tol(hr2d_solution_power(solution, 0).escaped, 0, 1e-15);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* What is seen as points is what is averaged, by the midpoint rule. */
START_TEST(averages_of_irradiance) {
  hr2d_scene *scene = test_scene(black_room, sizeof black_room / sizeof *black_room);
  hr2d_solution *solution = solve(scene, 1e-3);
  enum { POINTS = 4000 };
  for (size_t patch = 0; patch < hr2d_scene_patches(scene); patch++) {
    double sum = 0;
    for (int k = 0; k < POINTS; k++) sum += irradiance_at(solution, patch, (k + .5) / POINTS);
    ck_assert_double_eq_tol(sum / POINTS, hr2d_solution_irradiance(solution, patch, 0), 1e-6);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(net_flux_at_points) {
  static const double t[] = {0, 0.3, 1};
  hr2d_scene *scene = make_wedge(1);
  hr2d_solution *solution = solve(scene, 1e-6);
  for (size_t patch = 0; patch < 2; patch++) {
    double b[3], h[3], q[3];
    ck_assert_int_eq(hr2d_solution_gather(solution, patch, t, 3, b), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, patch, t, 3, h), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather_net_flux(solution, patch, t, 3, q), HR2D_OK);
    for (int k = 0; k < 3; k++) {
      ck_assert_double_eq_tol(b[k], emission[patch] + reflectance[patch] * h[k], 1e-15);
      ck_assert_double_eq_tol(q[k], b[k] - h[k], 1e-15);
    }
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("points") {
  ADD_TESTS("ends", edges_of_wedges, points_beside_an_edge, points_beside_a_foot);
  REPEAT_TESTS(5, "ends", feet_of_walls);
  REPEAT_TESTS(3, "ends", ends_and_feet_in_furnaces);
  ADD_TESTS("irradiance", irradiance_on_black_walls, averages_of_irradiance,
            net_flux_at_points);
}
