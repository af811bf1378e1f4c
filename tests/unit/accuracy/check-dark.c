/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dark rooms, rooms without reflection, rooms far from the origin: what is printed of them is
   right, not negative, and has finite bounds. */
#include <math.h>

#include "support/support.h"

typedef struct stage {
  size_t count;
  double patch[16][6]; /* ax ay bx by E ρ */
  int both[16];
} stage;

/* A lit room of 3.7 × 3 and an unlit one of 4.3 × 3 behind a wall on a common floor; rounded to
   `digits` decimals, and moved. */
static stage two_rooms(double shift, double grain) {
  stage s = {5,
             {{0, 0, 8, 0, 0, .5},
              {8, 0, 8, 3, 0, .7},
              {8, 3, 0, 3, 0, .7},
              {0, 3, 0, 0, 1, .7},
              {3.7, 0, 3.7, 3, 0, .7}},
             {0, 0, 0, 0, 1}};
  const double turn = shift > 0 || grain > 0 ? 0.3 : 0;
  for (size_t k = 0; k < s.count; k++)
    for (int end = 0; end < 4; end += 2) {
      double *p = s.patch[k] + end;
      const double x = p[0] * cos(turn) - p[1] * sin(turn) + shift;
      const double y = p[0] * sin(turn) + p[1] * cos(turn) + 8 * shift;
      p[0] = grain > 0 ? round(x / grain) * grain : x;
      p[1] = grain > 0 ? round(y / grain) * grain : y;
    }
  return s;
}

static hr2d_scene *make(const stage *s) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < s->count; k++) {
    const double *p = s->patch[k];
    const hr2d_patch patch = {.a = {p[0], p[1]},
                              .b = {p[2], p[3]},
                              .emission = &p[4],
                              .emission_bands = 1,
                              .reflectance = &p[5],
                              .reflectance_bands = 1,
                              .sides = s->both[k] ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

static hr2d_solution *solve(const hr2d_scene *scene, double error, hr2d_account *a) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  target.error = error;
  target.points = 1;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, a);
  const double bound = fmax(a->average.bound, a->irradiance.bound);
  ck_assert_msg(status == HR2D_OK || (status == HR2D_EACCURACY && bound > error), "%g: %s",
                error, a->reason);
  if (status == HR2D_OK)
    ck_assert_double_le(fmax(a->average.estimate, a->irradiance.estimate), error);
  const hr2d_error all[] = {a->average, a->sup, a->irradiance, a->irradiance_sup};
  for (int k = 0; k < 4; k++) {
    ck_assert_double_ge(all[k].estimate, 0);
    ck_assert_double_le(all[k].estimate, all[k].bound);
    ck_assert(isfinite(all[k].bound));
  }
  return solution;
}

static void check_signs(const hr2d_scene *scene, const hr2d_solution *solution) {
  for (size_t p = 0; p < hr2d_scene_patches(scene); p++) {
    ck_assert_double_ge(hr2d_solution_average(solution, p, 0), 0);
    ck_assert_double_ge(hr2d_solution_irradiance(solution, p, 0), 0);
    for (int k = 0; k <= 64; k++) {
      const double t = k / 64.;
      double value;
      ck_assert_double_ge(hr2d_solution_at(solution, p, t, 0), 0);
      ck_assert_double_ge(hr2d_solution_irradiance_at(solution, p, t, 0), 0);
      ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, p, &t, 1, &value), HR2D_OK);
      ck_assert_double_ge(value, 0);
    }
  }
}

/* The rooms as they are, and two whose corners are off by roundings, so that light leaks in. */
START_TEST(a_dark_room_is_dark) {
  const stage stages[] = {two_rooms(0, 0), two_rooms(0, 1e-9), two_rooms(5e5, 0)};
  hr2d_scene *scene = make(&stages[_i]), *exact = make(&stages[0]);
  hr2d_account a, b;
  hr2d_solution *truth = solve(exact, 1e-9, &b);
  for (double error = 1e-3; error > 1e-10; error *= 1e-3) {
    hr2d_solution *solution = solve(scene, error, &a);
    check_signs(scene, solution);
    const double max = hr2d_solution_average(truth, 3, 0);
    for (size_t p = 0; p < 6; p++) {
      const double is = hr2d_solution_average(solution, p, 0);
      const double right = hr2d_solution_average(truth, p, 0);
      const double off = fabs(is - right) / fmax(right, HR2D_FLOOR * max);
      /* The corners of the last two are off themselves, by 1e-9 and 1e-10 of 3. */
      ck_assert_double_le(off, fmax(error, _i ? 3e-3 : 0) + 1e-9);
      if (_i == 0) ck_assert_double_le(off, a.average.bound + 1e-9);
    }
    hr2d_solution_destroy(solution);
  }
  ck_assert_double_le(hr2d_solution_average(truth, 1, 0), 1e-15);
  hr2d_solution_destroy(truth);
  hr2d_scene_destroy(exact);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The same rooms with walls of so many pieces that shares of the error choose elements.  Far
   from the origin the wall between them ends behind the others by roundings, where B jumps. */
START_TEST(a_crowd_beside_a_dark_room) {
  enum { PIECES = 14 };
  static const double shift[] = {5e5, 3e5, 1e6, 2e5, 7e5, 4e5};
  const stage s = two_rooms(shift[_i], 0);
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < s.count * PIECES; k++) {
    const double *p = s.patch[k / PIECES];
    double end[2][2];
    for (int m = 0; m < 4; m++) {
      const size_t n = k % PIECES + (size_t)(m / 2);
      end[m / 2][m % 2] = n == PIECES
                              ? p[2 + m % 2]
                              : p[m % 2] + (double)n / PIECES * (p[2 + m % 2] - p[m % 2]);
    }
    const hr2d_patch patch = {.a = {end[0][0], end[0][1]},
                              .b = {end[1][0], end[1][1]},
                              .emission = &p[4],
                              .emission_bands = 1,
                              .reflectance = &p[5],
                              .reflectance_bands = 1,
                              .sides = s.both[k / PIECES] ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  for (double error = 1e-1; error > 1e-4; error *= 1e-1) {
    hr2d_account a;
    hr2d_solution *solution = solve(scene, error, &a);
    const double lamp = hr2d_solution_average(solution, 3 * PIECES, 0);
    const double bound = fmax(a.average.bound, error) * HR2D_FLOOR * lamp;
    for (size_t p = PIECES; p < 2 * PIECES; p++)
      ck_assert_double_le(hr2d_solution_average(solution, p, 0), bound + 1e-8);
    hr2d_solution_destroy(solution);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Averages relative to themselves are harder than relative to a part of the brightest. */
START_TEST(the_floor_counts) {
  const stage s = two_rooms(0, 1e-9);
  hr2d_scene *scene = make(&s);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_account a;
  hr2d_solution *solution;
  double bound[3];
  const double floors[] = {1e-12, 0, 1};
  for (int k = 0; k < 3; k++) {
    target.floor = floors[k];
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &a);
    ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    bound[k] = a.average.bound;
    hr2d_solution_destroy(solution);
  }
  ck_assert_double_gt(bound[0], 10 * bound[1]);
  ck_assert_double_ge(bound[1], bound[2]);
  const double bad[] = {-1e-6, 1.5, NAN};
  for (int k = 0; k < 3; k++) {
    target.floor = bad[k];
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, NULL), HR2D_EINVAL);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* A lamp over a table in a black room: B = E without error; H has an error that is told. The
   irradiance of the floor is elementary, by crossed strings. */
START_TEST(a_black_room_has_irradiance) {
  const stage s = {
      3, {{0, 0, 4, 0, 0, 0}, {2.5, 3, 1.5, 3, 1, 0}, {1, 1, 2, 1, 0, 0}}, {0, 0, 1}};
  hr2d_scene *scene = make(&s);
  hr2d_account a;
  hr2d_solution *solution = solve(scene, 1e-9, &a);
  ck_assert_double_le(a.average.bound, 1e-14);
  ck_assert_double_gt(a.irradiance.bound, 0);
  ck_assert_double_le(a.irradiance.bound, 1e-9 + 1e-12); /* what kinks may hide, and more */
  check_signs(scene, solution);
  /* Of the floor at x the lamp has ½(sin θ_b − sin θ_a), what the table leaves of it. */
  for (int k = 0; k <= 40; k++) {
    const double t = k / 40., x = 4 * t;
    double from = 1.5, to = 2.5, value;
    const double left = x + 3 * (1 - x), right = x + 3 * (2 - x); /* the table's shadow */
    double lit = (to - x) / hypot(to - x, 3) - (from - x) / hypot(from - x, 3);
    const double low = fmin(fmax(left, from), to), high = fmin(fmax(right, from), to);
    lit -= (high - x) / hypot(high - x, 3) - (low - x) / hypot(low - x, 3);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, 0, &t, 1, &value), HR2D_OK);
    ck_assert_double_le(fabs(value - 0.5 * lit), 1e-14);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A rotation by the Gaussian integer 4 + 3i, whose length is 5, is exact on integers below
   2^50: both scenes are the same, and their coordinates are rounded differently. */
static stage far_room(double shift, int turned) {
  const double at[][2] = {{0, 0}, {900, -40}, {1000, 500}, {350, 801}, {-90, 333}};
  stage s = {.count = 5};
  for (size_t k = 0; k < 5; k++) {
    const double light[2] = {k == 1, k == 3 ? .9 : .6};
    for (int end = 0; end < 2; end++) {
      const double *p = at[(k + (size_t)end) % 5];
      const double x = p[0] + 1024 * shift, y = p[1] - 1024 * shift;
      s.patch[k][2 * end] = (turned ? 4 * x - 3 * y : x) / 1024;
      s.patch[k][2 * end + 1] = (turned ? 3 * x + 4 * y : y) / 1024;
    }
    s.patch[k][4] = light[0];
    s.patch[k][5] = light[1];
  }
  return s;
}

START_TEST(offsets_are_in_the_bound) {
  for (double shift = 0; shift <= 0x1p+30; shift = shift > 0 ? 32 * shift : 32) {
    const stage one = far_room(shift, 0), other = far_room(shift, 1);
    hr2d_scene *scene[] = {make(&one), make(&other)};
    for (double error = 1e-6; error > 1e-10; error *= 1e-3) {
      hr2d_target target = HR2D_TARGET_INIT;
      hr2d_solution *solution[2];
      hr2d_account a[2];
      target.error = error;
      for (int k = 0; k < 2; k++) {
        const hr2d_status status = hr2d_solve_to(scene[k], &target, &solution[k], &a[k]);
        ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
        ck_assert_ptr_nonnull(solution[k]);
      }
      for (size_t p = 0; p < one.count; p++) {
        const double b = hr2d_solution_average(solution[0], p, 0);
        const double apart = fabs(hr2d_solution_average(solution[1], p, 0) / b - 1);
        ck_assert_msg(apart <= a[0].average.bound + a[1].average.bound,
                      "shift %g, %g: apart by %g, bounds %g %g", shift, error, apart,
                      a[0].average.bound, a[1].average.bound);
      }
      for (int k = 0; k < 2; k++) hr2d_solution_destroy(solution[k]);
    }
    for (int k = 0; k < 2; k++) hr2d_scene_destroy(scene[k]);
  }
}
END_TEST

/* A room with a chair, or plates for ever, with a chair or without, between which light of the
   sky cannot come. */
static hr2d_scene *make_closed(int endless, double brightest) {
  const double wall[][4] = {{0, 0, 3, 0},   {3, 0, 3, 1.7},   {3, 1.7, 0, 1.7},
                            {0, 1.7, 0, 0}, {1, .1, 1.6, .3}, {1.6, .3, 1, .1}};
  const double reflectance = .4;
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < 6; k++) {
    const double *w = wall[k];
    if ((endless && (k == 1 || k == 3)) || (endless == 2 && k > 3)) continue;
    const hr2d_patch patch = {.a = {w[0], w[1]},
                              .b = {w[2], w[3]},
                              .reflectance = &reflectance,
                              .reflectance_bands = 1};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  if (endless) ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){3, 0}), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &brightest, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

/* Nothing of a sky that nobody sees is at points, so that they have bounds. */
START_TEST(nothing_of_a_hidden_sky_arrives) {
  hr2d_scene *scene = make_closed(_i, 1000);
  for (double error = 1e-3; error > 1e-10; error *= 1e-3) {
    hr2d_account a;
    hr2d_solution *solution = solve(scene, error, &a);
    for (size_t p = 0; p < hr2d_scene_patches(scene); p++)
      for (int k = 0; k <= 64; k++) {
        const double t = k / 64.;
        double value;
        ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, p, &t, 1, &value), HR2D_OK);
        ck_assert(value == 0);
        ck_assert_int_eq(hr2d_solution_gather(solution, p, &t, 1, &value), HR2D_OK);
        ck_assert(value == 0);
      }
    hr2d_solution_destroy(solution);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("dark") {
  REPEAT_TESTS(3, "hidden sky", nothing_of_a_hidden_sky_arrives);
  REPEAT_TESTS(3, "rooms", a_dark_room_is_dark);
  REPEAT_TESTS(6, "rooms", a_crowd_beside_a_dark_room);
  ADD_TESTS("rooms", the_floor_counts, a_black_room_has_irradiance, offsets_are_in_the_bound);
}
