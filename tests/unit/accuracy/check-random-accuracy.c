/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors in random scenes: targets are met and bounds hold, against much finer solves and in
   rooms in which B = 1. */
#include <math.h>
#include <string.h>

#include "support/accuracy-scenes.h"
#include "support/accuracy-tally.h"
#include "support/support.h"

/* A random scene, and its condition number κ. */
typedef struct trial {
  accuracy_scene drawn;
  hr2d_scene *scene;
  size_t patches;
  double kappa;
} trial;

/* ‖(I − ρK)⁻¹‖∞, roughly. */
static double measure_kappa(uint64_t seed, int k, double max) {
  accuracy_scene s = accuracy_draw(seed, k, max);
  hr2d_account a;
  double kappa = 1;
  accuracy_set_uniform(&s);
  hr2d_scene *scene = accuracy_make(&s);
  hr2d_solution *solution = accuracy_solve(scene, .1, HR2D_NORM_AVERAGE, &a);
  for (size_t p = 0; p < hr2d_scene_patches(scene); p++)
    kappa = fmax(kappa, hr2d_solution_average(solution, p, 0));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  accuracy_free(&s);
  return kappa;
}

static trial make_trial(uint64_t seed, int k, double max) {
  trial t = {.drawn = accuracy_draw(seed, k, max)};
  t.scene = accuracy_make(&t.drawn);
  t.patches = hr2d_scene_patches(t.scene);
  t.kappa = measure_kappa(seed, k, max);
  return t;
}

static void end_trial(trial *t) {
  hr2d_scene_destroy(t->scene);
  accuracy_free(&t->drawn);
}

static double largest_average(const trial *t, const hr2d_solution *solution, size_t band) {
  double max = 0;
  for (size_t p = 0; p < t->patches; p++)
    max = fmax(max, hr2d_solution_average(solution, p, band));
  return max;
}

/* The largest relative error of an average, without what rounding explains: patches so dark
   that this is all there is to see have no digits. */
static double average_distance(const trial *t, const hr2d_solution *one,
                               const hr2d_solution *other, double *rounding) {
  double worst = 0;
  *rounding = ACCURACY_ROUNDING * t->kappa;
  for (size_t b = 0; b < t->drawn.bands; b++) {
    const double max = largest_average(t, other, b);
    for (size_t p = 0; p < t->patches; p++) {
      const double right = hr2d_solution_average(other, p, b);
      const double error = fabs(hr2d_solution_average(one, p, b) - right);
      if (!(right > 1e-9 * max) || !(error > worst * right)) continue;
      worst = error / right;
      *rounding = ACCURACY_ROUNDING * t->kappa * max / right;
    }
  }
  return worst;
}

enum { PLACES = 24 };

/* Of B at points, relative to the largest of the band. */
static double sup_distance(const trial *t, const hr2d_solution *one,
                           const hr2d_solution *other) {
  double place[PLACES], value[2][PLACES * ACCURACY_BANDS], worst[ACCURACY_BANDS] = {0},
                                                           max[ACCURACY_BANDS] = {0}, all = 0;
  const size_t bands = t->drawn.bands;
  for (int k = 0; k < PLACES; k++) place[k] = (k + .37) / PLACES;
  place[0] = 1e-3, place[PLACES - 1] = 1 - 1e-3;
  for (size_t p = 0; p < t->patches; p++) {
    ck_assert_int_eq(hr2d_solution_gather(one, p, place, PLACES, value[0]), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather(other, p, place, PLACES, value[1]), HR2D_OK);
    for (size_t k = 0; k < PLACES * bands; k++) {
      worst[k % bands] = fmax(worst[k % bands], fabs(value[0][k] - value[1][k]));
      max[k % bands] = fmax(max[k % bands], value[1][k]);
    }
  }
  for (size_t b = 0; b < bands; b++)
    if (worst[b] > 0) all = fmax(all, worst[b] / max[b]);
  return all;
}

static void fail_trial(const trial *t, uint64_t seed, int k, double target, double error,
                       hr2d_error e) {
  accuracy_print(stderr, &t->drawn);
  ck_abort_msg("HR2D_TEST_SEED=%llu, scene %d, %s, kappa %g, target %g: error %g, estimate %g, "
               "bound %g",
               (unsigned long long)seed, k, t->drawn.shape, t->kappa, target, error, e.estimate,
               e.bound);
}

/* Reflectances at most 0.9 or 0.999, or 1 for some patches but not for all. */
static double max_of(int k) {
  const double max[] = {.5, .9, .99, .999};
  return max[k % 4];
}

static int trials(int count) {
  const int wanted = (int)(count * test_multiplier());
  return wanted > 3 ? wanted : 3;
}

START_TEST(averages_of_random_scenes) {
  const double target[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
  const uint64_t seed = test_seed();
  accuracy_tally all = {0, 0};
  for (int k = 0; k < trials(100); k++) {
    trial t = make_trial(seed, k, max_of(k));
    hr2d_account a, b;
    double rounding;
    hr2d_solution *solution = accuracy_solve(t.scene, target[k % 5], HR2D_NORM_AVERAGE, &a);
    hr2d_solution *truth =
        accuracy_solve(t.scene, fmax(1e-2 * a.average.estimate, 1e-14), HR2D_NORM_AVERAGE, &b);
    const double error = average_distance(&t, solution, truth, &rounding);
    const double known = 2 * b.average.estimate;
    if ((!a.reason[0] && error > target[k % 5] + known + rounding) ||
        !accuracy_is_bounded(a.average, error, known, rounding))
      fail_trial(&t, seed, k, target[k % 5], error, a.average);
    accuracy_compare(&all, a.average, error, known, rounding,
                     accuracy_min_estimate(t.scene, target[k % 5]));
    accuracy_check_account(&a, solution);
    hr2d_solution_destroy(truth);
    hr2d_solution_destroy(solution);
    end_trial(&t);
  }
  printf("%d of %d estimates are close\n", all.close, all.compared);
  ck_assert_msg(accuracy_is_fair(&all), "HR2D_TEST_SEED=%llu: %d of %d",
                (unsigned long long)seed, all.close, all.compared);
}
END_TEST

/* There are few points, so that the largest error may lie between them.  Only an estimate or
   bound below an error that was found is wrong. */
START_TEST(points_of_random_scenes) {
  const double target[] = {1e-2, 1e-3, 1e-4};
  const uint64_t seed = test_seed();
  for (int k = 0; k < trials(30); k++) {
    trial t = make_trial(seed, k + 1000, max_of(k));
    hr2d_account a, b;
    const double rounding = ACCURACY_ROUNDING * t.kappa;
    hr2d_solution *solution = accuracy_solve(t.scene, target[k % 3], HR2D_NORM_SUP, &a);
    hr2d_solution *truth = accuracy_solve(t.scene, 1e-2 * target[k % 3], HR2D_NORM_SUP, &b);
    const double error = sup_distance(&t, solution, truth), known = 2 * b.sup.estimate;
    if ((!a.reason[0] && error > target[k % 3] + known) ||
        !accuracy_is_bounded(a.sup, error, known, rounding) ||
        2 * a.sup.estimate < error - known)
      fail_trial(&t, seed, k + 1000, target[k % 3], error, a.sup);
    hr2d_solution_destroy(truth);
    hr2d_solution_destroy(solution);
    end_trial(&t);
  }
}
END_TEST

/* |B − 1| of averages, elements' polynomials and points. */
static double furnace_error(const hr2d_scene *scene, const hr2d_solution *solution) {
  const double place[] = {0.0103, 0.2071, 0.5057, 0.7703, 0.9907}; /* where nothing stands */
  double worst = 0, value[5 * ACCURACY_BANDS];
  const size_t bands = hr2d_scene_bands(scene);
  for (size_t p = 0; p < hr2d_scene_patches(scene); p++) {
    ck_assert_int_eq(hr2d_solution_gather(solution, p, place, 5, value), HR2D_OK);
    for (size_t b = 0; b < bands; b++) {
      worst = fmax(worst, fabs(hr2d_solution_average(solution, p, b) - 1));
      for (size_t k = 0; k < 5; k++) {
        worst = fmax(worst, fabs(value[k * bands + b] - 1));
        worst = fmax(worst, fabs(hr2d_solution_at(solution, p, place[k], b) - 1));
      }
    }
  }
  return worst;
}

/* Closed rooms and open scenes with a background of 1, at any order. */
START_TEST(furnaces_are_exact) {
  const double target[] = {1e-1, 1e-3, 1e-6, 1e-9};
  const uint64_t seed = test_seed();
  for (int k = 0; k < trials(60); k++) {
    trial t = make_trial(seed, k + 2000, k % 3 ? .9 : .999);
    hr2d_account a;
    hr2d_scene_destroy(t.scene);
    accuracy_set_isothermal(&t.drawn);
    t.scene = accuracy_make(&t.drawn);
    hr2d_solution *solution = accuracy_solve(t.scene, target[k % 4], HR2D_NORM_AVERAGE, &a);
    const double error = furnace_error(t.scene, solution);
    if (!(error <= 1e-14 * fmax(t.kappa, 10)))
      fail_trial(&t, seed, k + 2000, target[k % 4], error, a.average);
    hr2d_solution_destroy(solution);
    end_trial(&t);
  }
}
END_TEST

START_TEST(threads_change_no_bit) {
  const unsigned threads[] = {1, 2, 4};
  const uint64_t seed = test_seed();
  for (int k = 0; k < trials(8); k++) {
    accuracy_scene drawn = accuracy_draw(seed, k + 3000, .9);
    hr2d_scene *scene = accuracy_make(&drawn);
    hr2d_solution *solution[3];
    hr2d_account a[3];
    for (int m = 0; m < 3; m++) {
      hr2d_target target = HR2D_TARGET_INIT;
      target.threads = threads[m];
      target.points = 1;
      const hr2d_status status = hr2d_solve_to(scene, &target, &solution[m], &a[m]);
      ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    }
    for (int m = 1; m < 3; m++) {
      ck_assert_double_eq(a[m].average.estimate, a[0].average.estimate);
      ck_assert_double_eq(a[m].average.bound, a[0].average.bound);
      ck_assert_double_eq(a[m].sup.bound, a[0].sup.bound);
      for (size_t p = 0; p < hr2d_scene_patches(scene); p++)
        for (size_t b = 0; b < drawn.bands; b++)
          ck_assert_double_eq(hr2d_solution_average(solution[m], p, b),
                              hr2d_solution_average(solution[0], p, b));
    }
    for (int m = 0; m < 3; m++) hr2d_solution_destroy(solution[m]);
    hr2d_scene_destroy(scene);
    accuracy_free(&drawn);
  }
}
END_TEST

TEST_SUITE("random accuracy") {
  ADD_TESTS("random scenes", averages_of_random_scenes, points_of_random_scenes,
            furnaces_are_exact, threads_change_no_bit);
}
