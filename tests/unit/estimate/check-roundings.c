/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bounds hold where all that is left of an error is rounding, and H is small beside what the
   roundings are of: on a lamp that sees the dark, on a floor under a sky that is nearly hidden,
   far from the origin.  References have closed forms, or Simpson's rule in long double.
   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER change the scenes. */
#include <float.h>
#include <math.h>

#include "support/support.h"

typedef long double real;
typedef struct vector {
  real x, y;
} vector;

static vector of(hr2d_point p) {
  return (vector){p.x, p.y};
}

static vector minus(vector a, vector b) {
  return (vector){a.x - b.x, a.y - b.y};
}

static real cross(vector a, vector b) {
  return a.x * b.y - a.y * b.x;
}

static real length(vector a) {
  return hypotl(a.x, a.y);
}

/* The form factor of a point before a segment, ½(sin θ_d − sin θ_c), as a quotient in which
   nothing cancels: h_c and h_d are the heights of the ends above the line of the point. */
static real point_factor(vector x, vector along, hr2d_segment s) {
  const vector c = minus(of(s.a), x), d = minus(of(s.b), x);
  const real h_c = cross(along, c) / length(along), h_d = cross(along, d) / length(along);
  const real product = cross(c, minus(of(s.b), of(s.a)));
  return product * (h_c / length(c) + h_d / length(d)) /
         (2 * (length(c) * length(d) + c.x * d.x + c.y * d.y));
}

/* H on a lamp of E = 1 and ρ = 0 by light that a patch of reflectance ρ sends back. The rule
   has an error below 1e-18 where the patches are as far apart as below. */
static real returned(hr2d_segment lamp, hr2d_segment mirror, real rho) {
  enum { PARTS = 512 };
  const vector from = of(mirror.a), along = minus(of(mirror.b), from);
  real sum = 0;
  for (int k = 0; k <= PARTS; k++) {
    const real t = (real)k / PARTS;
    const vector y = {from.x + t * along.x, from.y + t * along.y};
    const real f = point_factor(y, along, lamp);
    sum += (k == 0 || k == PARTS ? 1 : k % 2 ? 4 : 2) * f * f;
  }
  return rho * sum / (3 * PARTS) * length(along) / length(minus(of(lamp.b), of(lamp.a)));
}

static hr2d_solution *solve(const hr2d_scene *scene, double error, double floor,
                            hr2d_account *a) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  target.error = error;
  target.floor = floor;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, a);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s", a->reason);
  return solution;
}

/* The stated absolute error of the average H of patch 0 in band 0. */
static double stated(const hr2d_scene *scene, const hr2d_solution *s, const hr2d_account *a,
                     double floor) {
  double max = 0;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
    max = fmax(max, hr2d_solution_irradiance(s, k, 0));
  ck_assert_double_lt(a->irradiance.bound, 1);
  return a->irradiance.bound / (1 - a->irradiance.bound) *
         fmax(hr2d_solution_irradiance(s, 0, 0), floor * max);
}

/* The segment of this length with its middle `apart` from the origin, turned off the direction
   to there; it faces the origin if `left` is set. */
static hr2d_segment before(double apart, double size, double turned, int left) {
  const double x = 0.5 * size * sin(turned), y = 0.5 * size * cos(turned);
  const hr2d_segment s = {{apart + x, -y}, {apart - x, y}};
  return left ? s : (hr2d_segment){s.b, s.a};
}

static void add(hr2d_scene *scene, hr2d_segment at, double emission, double reflectance) {
  ck_assert_int_eq(test_add_patch(scene, at, emission, reflectance, HR2D_SIDES_FRONT), HR2D_OK);
}

/* A lamp of 1e-6 to 1e-2 before a wall of 1, up to 64 apart: it gets back 1e-7 or less of what
   it sends. One rounding of the row sum of the lamp, times B = 1 on it, was 1e-11 of H and
   more. */
START_TEST(a_lamp_before_a_dark_wall) {
  const size_t count = test_rounds(100, 20);
  randoms r = randoms_stream(test_seed(), 1);
  double sharpest = 1, rounding = 0;
  for (size_t k = 0; k < count; k++) {
    const hr2d_segment lamp = before(0, random_power(&r, -6, -2), random_between(&r, -1, 1), 0);
    const hr2d_segment wall = before(random_between(&r, 16, 64), random_between(&r, 0.25, 1),
                                     random_between(&r, -1.4, 1.4), 1);
    const double rho = random_between(&r, 0.1, 0.9);
    const double is = (double)returned(lamp, wall, rho);
    hr2d_scene *scene = test_new_scene(NULL);
    add(scene, lamp, 1, 0);
    add(scene, wall, 0, rho);
    test_commit(scene);
    hr2d_account a;
    hr2d_solution *solution = solve(scene, 1e-12, 1e-12, &a);
    const double h = hr2d_solution_irradiance(solution, 0, 0);
    const double error = stated(scene, solution, &a, 1e-12);
    ck_assert_msg(fabs(h - is) <= error, "%zu: %.17g and not %.17g, stated %.2g", k, h, is,
                  error);
    sharpest = fmin(sharpest, error / is);
    rounding = fmax(rounding, DBL_EPSILON * hr2d_solution_irradiance(solution, 1, 0) / is);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  /* A rounding of the wall's H is noticed. */
  ck_assert_double_lt(sharpest, 1e-12);
  ck_assert_double_gt(rounding, sharpest);
}
END_TEST

/* A number of that size with few digits: sums with it have no rounding. */
static double shift_of(randoms *r, int min, int max) {
  return ldexp(1 + random_below(r, 8) / 8., min + random_below(r, max - min + 1));
}

/* A patch that is black in band 0 and shines if it is the first one.  In band 1 something
   reflects, so that there is closure. */
static void add_coloured(hr2d_scene *scene, randoms *r, hr2d_segment at) {
  const double emission[] = {hr2d_scene_patches(scene) == 0, random_between(r, 0, 1)};
  const double reflectance[] = {0, random_between(r, 0.2, 0.8)};
  const hr2d_patch patch = {.a = at.a,
                            .b = at.b,
                            .emission = emission,
                            .emission_bands = 2,
                            .reflectance = reflectance,
                            .reflectance_bands = 2};
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
}

/* A lamp that hangs in a closed black room.  Nothing comes back to it.  Its row sum is closed
   by what the rounded ends of elements leave of 1, some roundings of its B, but these are not
   of its H. */
START_TEST(a_lamp_in_a_black_room_far_away) {
  const size_t count = test_rounds(40, 12);
  randoms r = randoms_stream(test_seed(), 2);
  double noise = 0;
  for (size_t k = 0; k < count; k++) {
    const double x = shift_of(&r, 10, 18), y = shift_of(&r, 10, 18);
    const double w = x + 2 + random_below(&r, 16) / 4., h = y + 2 + random_below(&r, 16) / 4.;
    const hr2d_point from = {x + 1.375, y + 1.25}, to = {x + 0.8125, y + 1.25};
    const hr2d_segment at[] = {{from, to},       {to, from},       {{x, y}, {w, y}},
                               {{w, y}, {w, h}}, {{w, h}, {x, h}}, {{x, h}, {x, y}}};
    hr2d_scene *scene = test_new_scene(NULL);
    for (int side = 0; side < 6; side++) add_coloured(scene, &r, at[side]);
    test_commit(scene);
    hr2d_account a;
    hr2d_solution *solution = solve(scene, 1e-9, 1e-6, &a);
    const double is = hr2d_solution_irradiance(solution, 0, 0);
    const double error = stated(scene, solution, &a, 1e-6);
    ck_assert_msg(is <= error, "%zu: %.2g and not 0, stated %.2g", k, is, error);
    noise = fmax(noise, is);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  /* There is something to be stated: roundings of the mean of all light, which is below 0.1. */
  ck_assert_double_gt(noise, 0);
  ck_assert_double_lt(noise, 0.5 * DBL_EPSILON);
}
END_TEST

/* A black plate of the same width w = 1 over a floor, at distance g, under a sky of
   radiosity 1. The floor gets 1 − F = 2g/(w + g + √(w² + g²)) of it, which is known to a
   rounding of 1. */
START_TEST(a_floor_under_a_plate) {
  const size_t count = test_rounds(40, 8);
  randoms r = randoms_stream(test_seed(), 3);
  double noise = 0;
  for (size_t k = 0; k < count; k++) {
    const double g = ldexp(1, -random_below(&r, 13)), light = 1;
    const double x = random_below(&r, 2) ? shift_of(&r, 0, 16) : 0;
    const hr2d_segment floor = {{x, x}, {x + 1, x}}, plate = {{x + 1, x + g}, {x, x + g}};
    const real is = 2 * (real)g / (1 + g + hypotl(1, g));
    hr2d_scene *scene = test_new_scene(NULL);
    add(scene, floor, 0, random_between(&r, 0.1, 0.9));
    add(scene, plate, 0, 0);
    ck_assert_int_eq(hr2d_scene_set_background(scene, &light, 1), HR2D_OK);
    test_commit(scene);
    hr2d_account a;
    hr2d_solution *solution = solve(scene, 1e-13, 1e-12, &a);
    const double h = hr2d_solution_irradiance(solution, 0, 0);
    const double error = stated(scene, solution, &a, 1e-12), off = (double)fabsl(h - is);
    ck_assert_msg(off <= error, "%zu, g = %g, from %g: %.17g and not %.17Lg, stated %.2g", k, g,
                  x, h, is, error);
    noise = fmax(noise, off / h);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  ck_assert_double_gt(noise, 16 * DBL_EPSILON);
}
END_TEST

/* A room of black walls with a slit and a floor of two pieces, of which one shines: the other
   one sees nothing but black, and B = H = 0 on it.  As little escapes, both are differences
   from the level of the room, and have its roundings; a bound that forgot them was 100 times
   too low. */
START_TEST(a_dark_piece_of_floor) {
  const size_t count = test_rounds(200, 40);
  randoms r = randoms_stream(test_seed(), 4);
  size_t rounded = 0;
  for (size_t k = 0; k < count; k++) {
    const double height = random_power(&r, -1, 0), end = random_between(&r, 0.3, 0.8);
    const double slit = random_power(&r, -6, -2), floor = random_power(&r, -12, -6);
    const hr2d_point corner[] = {{0, 0},      {end, 0},       {1, 0},
                                 {1, height}, {slit, height}, {0, height}};
    hr2d_scene *scene = test_new_scene(NULL);
    add(scene, (hr2d_segment){corner[1], corner[2]}, 0, random_between(&r, 0.1, 0.9));
    add(scene, (hr2d_segment){corner[0], corner[1]}, 1, random_between(&r, 0.1, 0.9));
    add(scene, (hr2d_segment){corner[2], corner[3]}, 0, 0);
    add(scene, (hr2d_segment){corner[3], corner[4]}, 0, 0);
    add(scene, (hr2d_segment){corner[5], corner[0]}, 0, 0);
    test_commit(scene);
    hr2d_account a;
    hr2d_solution *solution = solve(scene, random_power(&r, -10, -2), floor, &a);
    const double b = hr2d_solution_average(solution, 0, 0);
    rounded += b != 0;
    ck_assert_double_lt(a.average.bound, 1);
    ck_assert_double_le(fabs(b), a.average.bound / (1 - a.average.bound) * floor);
    ck_assert_double_le(fabs(hr2d_solution_irradiance(solution, 0, 0)),
                        stated(scene, solution, &a, floor));
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  ck_assert_uint_gt(rounded, count / 10);
}
END_TEST

TEST_SUITE("roundings") {
  ADD_TESTS("a balance", a_dark_piece_of_floor);
  ADD_TESTS("irradiance", a_lamp_before_a_dark_wall, a_lamp_in_a_black_room_far_away,
            a_floor_under_a_plate);
}
