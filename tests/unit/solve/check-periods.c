/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes that repeat for ever: against closed forms, against many copies, against cells of
   several periods, and against mirrors that make the same scene. */
#include <math.h>
#include <string.h>

#include "support/support.h"

/* Patches are ax ay bx by E ρ, turned by an angle. */
typedef struct turn {
  double c, s;
} turn;

static turn turn_by(double angle) {
  return (turn){cos(angle), sin(angle)};
}

static hr2d_point turned(turn t, double x, double y) {
  return (hr2d_point){t.c * x - t.s * y, t.s * x + t.c * y};
}

static void add_cell(hr2d_scene *scene, const double (*patch)[6], size_t count, double shift,
                     turn t) {
  for (size_t k = 0; k < count; k++) {
    const double *p = patch[k];
    const hr2d_segment at = {turned(t, p[0] + shift, p[1]), turned(t, p[2] + shift, p[3])};
    ck_assert_int_eq(test_add_patch(scene, at, p[4], p[5], HR2D_SIDES_FRONT), HR2D_OK);
  }
}

/* A committed scene of `cells` cells side by side; with a period of all of them, if `repeats`.
 */
static hr2d_scene *make(const double (*patch)[6], size_t count, double step, int cells,
                        int repeats, double background, turn t) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < cells; k++) add_cell(scene, patch, count, (k - cells / 2) * step, t);
  if (repeats)
    ck_assert_int_eq(hr2d_scene_set_period(scene, turned(t, cells * step, 0)), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &background, 1), HR2D_OK);
  test_commit(scene);
  return scene;
}

typedef struct run {
  hr2d_scene *scene;
  hr2d_solution *solution;
  hr2d_account account;
} run;

static run solve(hr2d_scene *scene, double error, hr2d_status expected) {
  run r = {.scene = scene};
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = error;
  const hr2d_status status = hr2d_solve_to(scene, &target, &r.solution, &r.account);
  ck_assert_msg(status == expected, "%d: %s", status, r.account.reason);
  return r;
}

static void end(run *r) {
  hr2d_solution_destroy(r->solution);
  hr2d_scene_destroy(r->scene);
}

static double relative(double is, double should) {
  return fabs(is / should - 1);
}

static const double plates[][6] = {{0, 0, 1, 0, 1, .5}, {1, 1, 0, 1, 0, .7}};

/* F = 1: B₁ = E/(1 − ρ₁ρ₂), B₂ = ρ₂B₁. */
static void expect_plates(run *r) {
  const double b[2] = {1 / (1 - .35), .7 / (1 - .35)};
  for (size_t k = 0; k < 2; k++) {
    const double off = relative(hr2d_solution_average(r->solution, k, 0), b[k]);
    ck_assert_msg(off <= 1e-8 && off <= r->account.average.bound, "%g off, bound %g", off,
                  r->account.average.bound);
  }
  ck_assert_double_eq_tol(hr2d_solution_power(r->solution, 0).absorbed, 1, 1e-8);
}

START_TEST(parallel_plates_are_infinite) {
  for (int k = 0; k < 3; k++) {
    run r = solve(make(plates, 2, 1, 1, 1, 0, turn_by(.9 * k)), 1e-6, HR2D_OK);
    expect_plates(&r);
    end(&r);
  }
}
END_TEST

START_TEST(mirrors_side_by_side_make_them_infinite_too) {
  hr2d_scene *scene = test_new_scene(NULL);
  add_cell(scene, plates, 2, 0, turn_by(0));
  hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 0}, {0, 1}});
  hr2d_scene_add_mirror(scene, (hr2d_segment){{1, 3}, {1, 2}});
  test_commit(scene);
  run r = solve(scene, 1e-6, HR2D_OK);
  expect_plates(&r);
  end(&r);
}
END_TEST

START_TEST(plates_see_nothing_but_each_other) {
  hr2d_scene *scene = make(plates, 2, 1, 1, 1, 0, turn_by(.3));
  double area[4];
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
  ck_assert(area[1] == area[2]);
  for (int k = 0; k < 4; k += 3) ck_assert_double_eq_tol(area[k], 0, 1e-12);
  ck_assert_double_eq_tol(area[1], 1, 3e-8); /* 1.2e-8 of what is cut off on each side */
  hr2d_scene_destroy(scene);
}
END_TEST

/* At order 1 closure closes the rows that the last images leave open. */
START_TEST(plates_without_a_target_are_near_it) {
  hr2d_scene *scene = make(plates, 2, 1, 1, 1, 0, turn_by(0));
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(links, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_validate(links), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(links, NULL, &solution), HR2D_OK);
  ck_assert_double_eq_tol(hr2d_solution_average(solution, 0, 0), 1 / .65, 1e-7);
  ck_assert_double_eq_tol(hr2d_solution_average(solution, 1, 0), .7 / .65, 1e-7);
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Of a plate and what is behind K images on both sides: crossed strings to a line across the
   gap at a distance of K periods. */
START_TEST(what_is_cut_off_is_told_exactly) {
  hr2d_scene *scene = make(plates, 2, 1, 1, 1, 0, turn_by(0));
  const double k = .5 * ((double)hr2d_scene_images(scene) - 1);
  const double strings = k + 1 + hypot(k, 1) - (k + hypot(k + 1, 1));
  ck_assert_double_eq_tol(hr2d_scene_cut_off(scene), strings, 1e-14);
  hr2d_scene_destroy(scene);
}
END_TEST

enum { CANYON = 5 };
#define WIDE 1.2
#define HIGH 1.7
static const double canyon[CANYON][6] = {{0, 0, WIDE, 0, 0, 0},
                                         {WIDE, 0, WIDE, HIGH, 0, 0},
                                         {WIDE, HIGH, 2, HIGH, 0, 0},
                                         {2, HIGH, 2, 0, 0, 0},
                                         {0, HIGH, 0, HIGH / 2, 0, 0}};

/* Streets between roofs: the wall on the left of the floor belongs to the cell before. */
START_TEST(streets_have_their_sky_view_factors) {
  for (int k = 0; k < 3; k++) {
    run r = solve(make(canyon, CANYON - 1, 2, 1, 1, 1, turn_by(1.3 * k)), 1e-10, HR2D_OK);
    const double diagonal = hypot(WIDE, HIGH), middle = .5;
    double h;
    ck_assert(hr2d_scene_cut_off(r.scene) == 0);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(r.solution, 0, &middle, 1, &h), HR2D_OK);
    ck_assert_double_eq_tol(h, .5 * WIDE / hypot(.5 * WIDE, HIGH), 1e-14);
    ck_assert_double_eq_tol(hr2d_solution_irradiance(r.solution, 0, 0),
                            (diagonal - HIGH) / WIDE, 1e-12);
    for (size_t wall = 1; wall < 4; wall += 2)
      ck_assert_double_eq_tol(hr2d_solution_irradiance(r.solution, wall, 0),
                              (WIDE + HIGH - diagonal) / (2 * HIGH), 1e-12);
    ck_assert_double_eq_tol(hr2d_solution_irradiance(r.solution, 2, 0), 1, 1e-14);
    end(&r);
  }
}
END_TEST

/* Without the period the wall of the next street is missing. */
START_TEST(the_period_matters) {
  run r = solve(make(canyon, CANYON - 1, 2, 1, 0, 1, turn_by(0)), 1e-6, HR2D_OK);
  const double exact = (hypot(WIDE, HIGH) - HIGH) / WIDE;
  ck_assert_double_gt(fabs(hr2d_solution_irradiance(r.solution, 0, 0) - exact), .1);
  end(&r);
}
END_TEST

enum { FENCES = 3, ROWS = 3, SLATS = 4, MOST = 4 };
/* Panels that stand on the ground, and panels above it. */
static const double fences[FENCES][6] = {
    {0, 0, 1.5, 0, .1, .6}, {0, 0, .8, .9, 1, .5}, {.8, .9, 0, 0, 0, .7}};
static const double rows[ROWS][6] = {
    {0, 0, 3, 0, 0, .6}, {0, .5, 1.7, 1.4, 1, .5}, {1.7, 1.4, 0, .5, 0, .7}};
/* Slats between two plates, which reach over the end of their cell. */
static const double slats[SLATS][6] = {{0, 0, 1, 0, 1, .5},
                                       {1, 2, 0, 2, 0, .7},
                                       {.2, .8, 1.15, 1.2, .3, .6},
                                       {1.15, 1.2, .2, .8, .3, .6}};

/* Nothing is seen beyond the next panels, and light comes no farther than a few of them. */
START_TEST(rows_on_the_ground_are_the_middle_of_many) {
  run whole = solve(make(fences, FENCES, 1.5, 41, 0, 1, turn_by(.4)), 1e-9, HR2D_OK);
  run cell = solve(make(fences, FENCES, 1.5, 1, 1, 1, turn_by(.4)), 1e-9, HR2D_OK);
  ck_assert(hr2d_scene_cut_off(cell.scene) == 0);
  for (size_t k = 0; k < FENCES; k++) {
    const double b = hr2d_solution_average(whole.solution, 20 * FENCES + k, 0);
    ck_assert_double_le(relative(hr2d_solution_average(cell.solution, k, 0), b), 2e-9);
  }
  end(&whole);
  end(&cell);
}
END_TEST

/* Under the panels the ground is seen for ever: 41 copies lack some 1/20² of what is. */
START_TEST(rows_above_the_ground_are_nearly_the_middle_of_many) {
  run whole = solve(make(rows, ROWS, 3, 41, 0, 1, turn_by(0)), 1e-7, HR2D_OK);
  run half = solve(make(rows, ROWS, 3, 21, 0, 1, turn_by(0)), 1e-7, HR2D_OK);
  run cell = solve(make(rows, ROWS, 3, 1, 1, 1, turn_by(0)), 1e-6, HR2D_OK);
  ck_assert_double_gt(hr2d_scene_cut_off(cell.scene), 0);
  for (size_t k = 0; k < ROWS; k++) {
    const double b = hr2d_solution_average(cell.solution, k, 0);
    const double off = b - hr2d_solution_average(whole.solution, 20 * ROWS + k, 0);
    const double more = b - hr2d_solution_average(half.solution, 10 * ROWS + k, 0);
    ck_assert_double_le(fabs(off), 1e-3 * b);
    ck_assert_msg(fabs(off) < .45 * fabs(more), "%g off, and %g with half as many", off, more);
  }
  end(&whole);
  end(&half);
  end(&cell);
}
END_TEST

/* Cells of 1 and 3 periods cut off at places that are three times as far: the same scene, and
   errors as they are told. */
static void expect_same_cells(const double (*patch)[6], size_t count, double step, double error,
                              double background) {
  run one = solve(make(patch, count, step, 1, 1, background, turn_by(0)), error, HR2D_OK);
  run three = solve(make(patch, count, step, 3, 1, background, turn_by(0)), error, HR2D_OK);
  for (size_t k = 0; k < count; k++) {
    const double b = hr2d_solution_average(one.solution, k, 0);
    const double bounds = one.account.average.bound + three.account.average.bound;
    for (size_t cell = 0; cell < 3; cell++) {
      const double other = hr2d_solution_average(three.solution, cell * count + k, 0);
      ck_assert_msg(relative(other, b) <= fmin(bounds, 2 * error),
                    "patch %zu: %g off, bounds of %g", k, relative(other, b), bounds);
    }
  }
  end(&one);
  end(&three);
}

START_TEST(cells_of_several_periods_are_the_same_scene) {
  const double times = test_multiplier() < 0.1 ? 100 : 1;
  expect_same_cells(fences, FENCES, 1.5, times * 1e-9, 1);
  expect_same_cells(rows, ROWS, 3, times * 1e-6, 1);
  expect_same_cells(slats, SLATS, 1, times * 1e-5, 0);
}
END_TEST

/* Nothing of a background comes between endless plates. */
START_TEST(plates_under_a_background_are_dark) {
  static const double dark[][6] = {
      {0, 0, .5, 0, 0, 0}, {.5, 0, 1, 0, 0, 0}, {1, 1, .25, 1, 0, .2}, {.25, 1, 0, 1, 0, .3}};
  for (int k = 4; k <= 9; k++) {
    run r = solve(make(dark, 4, 1, 1, 1, 1, turn_by(0)), pow(10, -k), HR2D_OK);
    for (size_t p = 0; p < 4; p++) {
      ck_assert(hr2d_solution_average(r.solution, p, 0) == 0);
      ck_assert(hr2d_solution_irradiance(r.solution, p, 0) == 0);
    }
    end(&r);
  }
}
END_TEST

/* What is extrapolated stands before the background, also where it is black.  H of the ground
   is what 80,000 points see between the 101 nearest rows. */
START_TEST(black_rows_hide_the_background) {
  static const double black[][6] = {
      {0, 0, 3, 0, 0, 0}, {0, .5, 1.7, 1.4, 0, 0}, {1.7, 1.4, 0, .5, 0, 0}};
  run one = solve(make(black, 3, 3, 1, 1, 1, turn_by(0)), 1e-3, HR2D_OK);
  run three = solve(make(black, 3, 3, 4, 1, 1, turn_by(0)), 1e-3, HR2D_OK);
  const double ground = hr2d_solution_irradiance(one.solution, 0, 0);
  ck_assert_double_le(relative(ground, 0.41990941056), one.account.irradiance.bound);
  ck_assert_double_gt(one.account.irradiance.estimate, 1e-10);
  for (size_t k = 0; k < 3; k++) {
    const double h = hr2d_solution_irradiance(three.solution, k, 0);
    ck_assert_double_le(relative(hr2d_solution_irradiance(one.solution, k, 0), h),
                        one.account.irradiance.bound + three.account.irradiance.bound);
  }
  end(&one);
  end(&three);
}
END_TEST

/* Images that are cut off are the reason, and not that elements are coarse. */
START_TEST(targets_beyond_what_is_cut_off_are_not_met) {
  run r = solve(make(slats, SLATS, 1, 1, 1, 0, turn_by(0)), 1e-10, HR2D_EACCURACY);
  ck_assert_ptr_nonnull(strstr(r.account.reason, "images"));
  run far = solve(make(slats, SLATS, 1, 3, 1, 0, turn_by(0)), 1e-6, HR2D_OK);
  for (size_t k = 0; k < SLATS; k++) {
    const double off = relative(hr2d_solution_average(r.solution, k, 0),
                                hr2d_solution_average(far.solution, SLATS + k, 0));
    ck_assert_double_le(off, r.account.average.bound + far.account.average.bound);
  }
  end(&r);
  end(&far);
}
END_TEST

/* Half of a cell between two mirrors, with its own image. */
START_TEST(parallel_mirrors_are_a_period_with_reflections) {
  static const double half[][6] = {{0, 0, 1.1, 0, .2, .5},
                                   {.25, .4, .7, .95, 1, .4},
                                   {.7, .95, .25, .4, 0, .8},
                                   {1.1, 2, 0, 2, 0, .3}};
  enum { HALF = sizeof half / sizeof *half };
  double both[2 * HALF][6];
  for (size_t k = 0; k < HALF; k++)
    for (size_t m = 0; m < 6; m++) {
      both[k][m] = half[k][m];
      both[HALF + k][m] =
          m < 4 ? (m % 2 ? half[k][(m + 2) % 4] : -half[k][(m + 2) % 4]) : half[k][m];
    }
  hr2d_scene *scene = test_new_scene(NULL);
  add_cell(scene, half, HALF, 0, turn_by(0));
  hr2d_scene_add_mirror(scene, (hr2d_segment){{1.1, 0}, {1.1, 1}});
  hr2d_scene_add_mirror(scene, (hr2d_segment){{0, 0}, {0, 1}});
  test_commit(scene);
  const double error = test_multiplier() < 0.1 ? 1e-3 : 2e-6;
  run mirrors = solve(scene, error, HR2D_OK);
  run period =
      solve(make((const double(*)[6])both, 2 * HALF, 2.2, 1, 1, 0, turn_by(0)), error, HR2D_OK);
  for (size_t k = 0; k < HALF; k++)
    ck_assert_double_le(relative(hr2d_solution_average(mirrors.solution, k, 0),
                                 hr2d_solution_average(period.solution, k, 0)),
                        2 * error);
  end(&mirrors);
  end(&period);
}
END_TEST

/* A sun so low that shadows reach over several rows. */
START_TEST(suns_shine_past_images) {
  for (int k = 0; k < 2; k++) {
    hr2d_scene *scene[2];
    const hr2d_sun sun = {{k ? -1 : 1, -.12}, 7};
    for (int m = 0; m < 2; m++) {
      scene[m] = test_new_scene(NULL);
      const int cells = m ? 41 : 1;
      for (int c = 0; c < cells; c++)
        add_cell(scene[m], fences, FENCES, (c - cells / 2) * 1.5, turn_by(0));
      if (!m) ck_assert_int_eq(hr2d_scene_set_period(scene[m], (hr2d_point){1.5, 0}), HR2D_OK);
      ck_assert_int_eq(hr2d_scene_set_sun(scene[m], &sun, 1), HR2D_OK);
      test_commit(scene[m]);
    }
    for (size_t p = 0; p < FENCES; p++)
      ck_assert_double_eq_tol(hr2d_scene_sunlight(scene[0], p, 0),
                              hr2d_scene_sunlight(scene[1], 20 * FENCES + p, 0), 1e-12);
    hr2d_scene_destroy(scene[0]);
    hr2d_scene_destroy(scene[1]);
  }
}
END_TEST

/* What a period has of a point in a street; check-past-ends.c has what is above it. */
START_TEST(points_in_streets_have_light) {
  run r = solve(make(canyon, CANYON - 1, 2, 1, 1, 1, turn_by(0)), 1e-8, HR2D_OK);
  const hr2d_point at[] = {{.6, .5}, {.6, 1e-9}};
  double mean[2];
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  values.mean = mean;
  ck_assert_int_eq(hr2d_field_at(r.solution, at, 2, NULL, &values), HR2D_OK);
  ck_assert_double_eq_tol(mean[0], atan2(.6, HIGH - .5) / 3.14159265358979323846, 1e-12);
  ck_assert(!isnan(mean[1]));
  end(&r);
}
END_TEST

/* A floor under a row of slabs with gaps and a sky of 1, in which B = 1 everywhere: through a
   gap comes, and leaves, as much as it is wide. */
static const double slabs[][6] = {{0, 0, 1, 0, .5, .5}, {1, 1.8, .4, 1.8, 1, 0}};

static double check_gap(const hr2d_solution *solution) {
  const hr2d_power p = hr2d_solution_power(solution, 0);
  const double cut_off = hr2d_solution_power_cut_off(solution, 0),
               off = fmax(fabs(p.received - .4), fabs(p.escaped - .4));
  ck_assert_double_le(off, cut_off + 1e-13);
  ck_assert_double_le(cut_off, 1e-4);
  return off;
}

START_TEST(powers_tell_what_is_cut_off) {
  run r = solve(make(slabs, 2, 1, 1, 1, 1, turn_by(.2)), 1e-5, HR2D_OK);
  ck_assert_double_ge(check_gap(r.solution), 1e-12); /* more than rounding */
  end(&r);
  hr2d_scene *scene = make(slabs, 2, 1, 1, 1, 1, turn_by(.2));
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(links, NULL), HR2D_OK);
  for (unsigned order = 1; order < 4; order += 2) {
    hr2d_solution *solution;
    ck_assert_int_eq(hr2d_hierarchy_set_order(hierarchy, order), HR2D_OK);
    ck_assert_int_eq(hr2d_solve(links, NULL, &solution), HR2D_OK);
    check_gap(solution);
    hr2d_solution_destroy(solution);
  }
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("periods") {
  ADD_TESTS("plates", parallel_plates_are_infinite, mirrors_side_by_side_make_them_infinite_too,
            plates_see_nothing_but_each_other, plates_without_a_target_are_near_it,
            what_is_cut_off_is_told_exactly, powers_tell_what_is_cut_off);
  ADD_TESTS("streets", streets_have_their_sky_view_factors, points_in_streets_have_light,
            the_period_matters);
  ADD_TESTS("rows", rows_on_the_ground_are_the_middle_of_many,
            rows_above_the_ground_are_nearly_the_middle_of_many, suns_shine_past_images);
  ADD_TESTS("cells", cells_of_several_periods_are_the_same_scene,
            targets_beyond_what_is_cut_off_are_not_met, plates_under_a_background_are_dark,
            black_rows_hide_the_background, parallel_mirrors_are_a_period_with_reflections);
}
