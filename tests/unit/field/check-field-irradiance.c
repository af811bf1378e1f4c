/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The irradiance of planes of any tilt at points: closed forms, what patches gather, the flux
   and the mean that it is a part of, and its error.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change points and planes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/accuracy-scenes.h"
#include "support/support.h"
#include "support/symmetric-scenes.h"

#define PI 3.14159265358979323846

enum { POINTS = 100, TILTS = 720, BANDS = 3 };

static hr2d_solution *solve(const hr2d_scene *scene, double error, hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  target.error = error;
  target.points = account != NULL;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
  ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
  return solution;
}

static hr2d_point turned(double angle) {
  return (hr2d_point){cos(angle), sin(angle)};
}

/* H(n) at points, with a normal for all or for each of them. */
static void look(const hr2d_solution *solution, const hr2d_point *at, size_t count,
                 const hr2d_point *normal, size_t normals, double *irradiance) {
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  options.normal = normal;
  options.normals = normals;
  values.irradiance = irradiance;
  ck_assert_int_eq(hr2d_field_at(solution, at, count, &options, &values), HR2D_OK);
}

static double look_once(const hr2d_solution *solution, hr2d_point at, hr2d_point normal) {
  double irradiance;
  look(solution, &at, 1, &normal, 0, &irradiance);
  return irradiance;
}

/* A plane over black ground from −1 to 1 with B = 1, under a background of 2 and a sun, whose
   direction is of any length: the ends of the ground are at angles from n whose sines count,
   and the sun has a cosine. */
START_TEST(tilted_planes_over_ground) {
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_patch(scene, (hr2d_segment){{-1, 0}, {1, 0}}, 1, 0, HR2D_SIDES_FRONT);
  const double sky = 2;
  ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
  const double size = ((const double[]){1, 1e-200, 1e200})[_i];
  const hr2d_sun sun = {.direction = {-0.6 * size, -0.8 * size}, .irradiance = 3};
  ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  test_commit(scene);
  hr2d_solution *solution = solve(scene, 1e-9, NULL);
  randoms r = randoms_stream(test_seed(), 1);
  for (int k = test_count(1000); k > 0; k--) {
    const hr2d_point x = {random_between(&r, -1, 1), random_power(&r, -3, 1)};
    const double tilt =
        k == 1 ? 0 : random_between(&r, -PI, PI); /* of n, from up to the left */
    /* Directions by their angles from n, those above the plane. */
    const double west = atan2(-x.y, -1 - x.x) + 2 * PI, east = atan2(-x.y, 1 - x.x) + 2 * PI;
    const double up = PI / 2 + tilt;
    double ground = 0;
    for (int turn = -1; turn <= 1; turn++) {
      const double low = fmax(west - up + 2 * PI * turn, -PI / 2),
                   high = fmin(east - up + 2 * PI * turn, PI / 2);
      if (high > low) ground += (sin(high) - sin(low)) / 2;
    }
    const hr2d_point n = turned(up);
    const double is = look_once(solution, x, (hr2d_point){7 * n.x, 7 * n.y}),
                 right = ground + sky * (1 - ground) + 3 * fmax(0, 0.6 * n.x + 0.8 * n.y);
    ck_assert_msg(fabs(is - right) <= 1e-13, "at %g %g, tilt %g: %.17g, not %.17g", x.x, x.y,
                  tilt, is, right);
    ck_assert_double_gt(fabs(is - look_once(solution, x, (hr2d_point){-n.x, -n.y})) + fabs(n.y),
                        1e-9); /* negative control */
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A plane along a patch gets what the patch gathers. */
START_TEST(planes_on_patches) {
  for (int k = test_count(20); k > 0; k--) {
    accuracy_scene drawn = accuracy_draw(test_seed(), k, .9);
    hr2d_scene *scene = accuracy_make(&drawn);
    hr2d_solution *solution = solve(scene, 1e-4, NULL);
    const size_t bands = hr2d_scene_bands(scene);
    for (size_t p = 0; p < hr2d_scene_patches(scene); p++) {
      const hr2d_segment s = hr2d_scene_segment(scene, p);
      const double t = 0.4, along_x = s.b.x - s.a.x, along_y = s.b.y - s.a.y;
      const hr2d_point front = {-along_y,
                                along_x}; /* just off the patch, as it may touch others */
      const hr2d_point at = {s.a.x + t * along_x + 1e-9 * front.x,
                             s.a.y + t * along_y + 1e-9 * front.y};
      double is[BANDS], right[BANDS];
      look(solution, &at, 1, &front, 1, is);
      ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, p, &t, 1, right), HR2D_OK);
      for (size_t b = 0; b < bands; b++)
        ck_assert_msg(fabs(is[b] - right[b]) <= 1e-7 * (1 + right[b]) || isnan(is[b]),
                      "scene %d, %s, patch %zu: %.17g, not %.17g", k, drawn.shape, p, is[b],
                      right[b]);
    }
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
    accuracy_free(&drawn);
  }
}
END_TEST

static hr2d_scene *symmetric(int kind) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(symmetric_add(scene, (symmetric_kind)kind), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* What is known at points of a solution that is taken for exact: what is left is the error of
   light past the ends of a period. */
typedef struct known {
  double mean[POINTS * BANDS], flux[2 * POINTS * BANDS], error[POINTS * BANDS];
  double irradiance[POINTS * BANDS], irradiance_error[POINTS * BANDS];
} known;

static void know(const hr2d_solution *solution, const hr2d_point *at, const hr2d_point *normal,
                 size_t patches, known *to) {
  double *none = calloc(patches * BANDS, sizeof *none);
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  ck_assert_ptr_nonnull(none);
  options.patch_error = none;
  options.normal = normal;
  options.normals = POINTS;
  const hr2d_field_values values = {.struct_size = sizeof values,
                                    .mean = to->mean,
                                    .flux = to->flux,
                                    .error = to->error,
                                    .irradiance = to->irradiance,
                                    .irradiance_error = to->irradiance_error};
  ck_assert_int_eq(hr2d_field_at(solution, at, POINTS, &options, &values), HR2D_OK);
  free(none);
}

/* Under mirrors, periods, suns and skies: H(n) − H(−n) is n·Φ. */
START_TEST(both_sides_are_the_flux) {
  hr2d_scene *scene = symmetric(1 + _i);
  hr2d_solution *solution = solve(scene, 1e-3, NULL);
  const size_t bands = hr2d_scene_bands(scene), patches = hr2d_scene_patches(scene);
  randoms r = randoms_stream(test_seed(), 100 + _i);
  hr2d_point at[POINTS], normal[POINTS], back[POINTS];
  static known front, behind;
  for (int k = 0; k < POINTS; k++) {
    at[k] = (hr2d_point){random_between(&r, -1, 3), random_between(&r, -.2, 2)};
    normal[k] = turned(random_between(&r, 0, 2 * PI));
    back[k] = (hr2d_point){-normal[k].x, -normal[k].y};
  }
  know(solution, at, normal, patches, &front);
  know(solution, at, back, patches, &behind);
  int lit = 0;
  for (size_t k = 0; k < POINTS * bands; k++) {
    const hr2d_point n = normal[k / bands];
    const double along = n.x * front.flux[2 * k] + n.y * front.flux[2 * k + 1],
                 off = fabs(front.irradiance[k] - behind.irradiance[k] - along),
                 error = front.irradiance_error[k] + behind.irradiance_error[k] +
                         PI * front.error[k];
    if (isnan(front.mean[k])) {
      ck_assert(isnan(front.irradiance[k]) && isnan(front.irradiance_error[k]));
      continue;
    }
    ck_assert_double_ge(front.irradiance[k], 0);
    ck_assert_msg(off <= error + 1e-13 * front.irradiance[k] + 1e-13 * behind.irradiance[k],
                  "kind %d: off by %g, error %g", 1 + _i, off, error);
    lit++;
  }
  ck_assert_int_gt(lit, 10);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Between endless plates, at tilts at which the horizon of the plane is among images that the
   series takes: the plane sees one of them under all directions but a wedge. */
START_TEST(small_tilts_between_endless_plates) {
  hr2d_scene *scene = symmetric(SYMMETRIC_PLATES);
  hr2d_solution *solution = solve(scene, 1e-9, NULL);
  double B[2];
  symmetric_plates_answer(B);
  for (int k = -100; k <= 100; k++) {
    const double tilt = 1e-3 * k;
    for (int side = 0; side < 2; side++) {
      const hr2d_point n = turned(PI / 2 + tilt + side * PI);
      const double above = B[1 - side], below = B[side],
                   right = (above * (1 + cos(tilt)) + below * (1 - cos(tilt))) / 2;
      const double is = look_once(solution, (hr2d_point){.3, .6}, n);
      ck_assert_msg(fabs(is - right) <= 1e-6, "tilt %g: %.9g, not %.9g", tilt, is, right);
    }
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* ∫ H(n) over all n is 2π M: each direction counts with ∫ max(0, n·ω)/2 = 1.  On a grid with
   one normal, so that the same numbers come from both calls. */
START_TEST(all_tilts_are_the_mean) {
  hr2d_scene *scene = symmetric(1 + _i);
  hr2d_solution *solution = solve(scene, 1e-2, NULL);
  const size_t bands = hr2d_scene_bands(scene);
  const hr2d_field_grid grid = {sizeof grid, {.3, .2}, {.7, .6}, 5, 4, 0};
  double mean[20 * BANDS], sum[20 * BANDS] = {0}, irradiance[20 * BANDS];
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  values.mean = mean;
  values.irradiance = irradiance;
  options.normals = 1;
  for (int k = 0; k < TILTS; k++) {
    const hr2d_point normal = turned(2 * PI * (k + .5) / TILTS);
    options.normal = &normal;
    ck_assert_int_eq(hr2d_field_on_grid(solution, &grid, &options, &values, NULL), HR2D_OK);
    for (size_t p = 0; p < 20 * bands; p++) sum[p] += irradiance[p] / TILTS;
  }
  for (size_t p = 0; p < 20 * bands; p++)
    ck_assert_msg(isnan(mean[p]) || fabs(sum[p] - mean[p]) <= 2e-4 * mean[p],
                  "kind %d: %.9g, not %.9g", 1 + _i, sum[p], mean[p]);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* H(n) is as near to that of a much better solution as it says. */
START_TEST(irradiances_are_within_their_errors) {
  int coarse = 0;
  for (int k = (int)test_some(40, 4); k > 0; k--) {
    randoms r = randoms_stream(test_seed(), 200 + k);
    accuracy_scene drawn = accuracy_draw(test_seed(), k, .9);
    hr2d_scene *scene = accuracy_make(&drawn);
    const size_t bands = hr2d_scene_bands(scene);
    hr2d_account account[2];
    hr2d_solution *solution[2] = {solve(scene, random_power(&r, -6, -2), &account[0]),
                                  solve(scene, 1e-9, &account[1])};
    hr2d_point at[POINTS], normal[POINTS];
    double is[2][POINTS * BANDS], error[2][POINTS * BANDS];
    for (int p = 0; p < POINTS; p++) {
      const hr2d_segment s =
          hr2d_scene_segment(scene, (size_t)random_below(&r, (int)hr2d_scene_patches(scene)));
      const double t = random_unit(&r), d = random_power(&r, -4, 0);
      at[p] = (hr2d_point){s.a.x + t * (s.b.x - s.a.x) - d * (s.b.y - s.a.y),
                           s.a.y + t * (s.b.y - s.a.y) + d * (s.b.x - s.a.x)};
      normal[p] = turned(random_between(&r, 0, 2 * PI));
    }
    for (int m = 0; m < 2; m++) {
      hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
      hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
      options.account = &account[m];
      options.normal = normal;
      options.normals = POINTS;
      values.irradiance = is[m];
      values.irradiance_error = error[m];
      ck_assert_int_eq(hr2d_field_at(solution[m], at, POINTS, &options, &values), HR2D_OK);
    }
    for (size_t p = 0; p < POINTS * bands; p++) {
      if (isnan(is[0][p])) continue;
      const double off = fabs(is[0][p] - is[1][p]), sum = error[0][p] + error[1][p];
      ck_assert_msg(off <= sum, "scene %d, %s: off by %g, with an error of %g", k, drawn.shape,
                    off, sum);
      coarse += off > error[1][p]; /* negative control: the finer one's alone is too small */
    }
    for (int m = 0; m < 2; m++) hr2d_solution_destroy(solution[m]);
    hr2d_scene_destroy(scene);
    accuracy_free(&drawn);
  }
  ck_assert_int_gt(coarse, 0);
}
END_TEST

/* Threads change no bit; what lacks a normal is refused, and so is a tolerance. */
START_TEST(calls) {
  hr2d_scene *scene = symmetric(SYMMETRIC_SUNNY);
  hr2d_solution *solution = solve(scene, 1e-2, NULL);
  const size_t bands = hr2d_scene_bands(scene);
  hr2d_point at[POINTS], normal[2] = {{1e-300, 2e-300}, {1e300, 2e300}};
  double one[POINTS * BANDS], other[POINTS * BANDS];
  for (int k = 0; k < POINTS; k++) at[k] = (hr2d_point){.01 * k, .5};
  hr2d_field_options options = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  options.normal = normal;
  values.irradiance = one;
  ck_assert_int_eq(hr2d_field_at(solution, at, POINTS, &options, &values), HR2D_OK);
  options.normal = &normal[1];
  options.threads = 4;
  values.irradiance = other;
  ck_assert_int_eq(hr2d_field_at(solution, at, POINTS, &options, &values), HR2D_OK);
  for (size_t k = 0; k < POINTS * bands; k++)
    ck_assert(isnan(one[k]) ? isnan(other[k]) : fabs(one[k] - other[k]) <= 1e-15 * one[k]);
  ck_assert_int_eq(memcmp(one, other, POINTS * bands * sizeof *one), 0);

  options.normals = 2; /* for 100 points */
  ck_assert_int_eq(hr2d_field_at(solution, at, POINTS, &options, &values), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_field_at(solution, at, 2, &options, &values), HR2D_OK);
  normal[1] = (hr2d_point){0, 0};
  ck_assert_int_eq(hr2d_field_at(solution, at, 2, &options, &values), HR2D_EINVAL);
  normal[1] = (hr2d_point){NAN, 1};
  ck_assert_int_eq(hr2d_field_at(solution, at, 2, &options, &values), HR2D_EINVAL);
  options.normals = 0;
  options.normal = NULL;
  ck_assert_int_eq(hr2d_field_at(solution, at, 2, &options, &values), HR2D_EINVAL);
  hr2d_field_grid grid = {sizeof grid, {0, 0}, {1, 1}, 5, 5, 1e-2};
  options.normal = normal;
  ck_assert_int_eq(hr2d_field_on_grid(solution, &grid, &options, &values, NULL), HR2D_EINVAL);
  grid.tolerance = 0;
  ck_assert_int_eq(hr2d_field_on_grid(solution, &grid, &options, &values, NULL), HR2D_OK);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("irradiance of planes at points") {
  REPEAT_TESTS(3, "irradiance and sun", tilted_planes_over_ground);
  ADD_TESTS("irradiance", planes_on_patches, small_tilts_between_endless_plates,
            irradiances_are_within_their_errors, calls);
  REPEAT_TESTS(SYMMETRIC_KINDS - 1, "under symmetries", both_sides_are_the_flux,
               all_tilts_are_the_mean);
}
