/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is promised about errors: targets are met, estimates are close, bounds hold; against
   reference tables, an independent method, much finer solves, and rooms in which B = 1. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "independent/accuracy-nystrom.h"
#include "support/accuracy-scenes.h"
#include "support/radiosity-scenes.h"
#include "support/support.h"

/* Relative errors below this much of κ are rounding. */
#define ROUNDING (50 * DBL_EPSILON)

/* How estimates compare with errors: all that are above rounding, and those within a factor of
   2; what lies below its bound is asserted at once. */
typedef struct tally {
  int compared, close;
} tally;

/* `known` is how well the truth is known. */
static int is_bounded(hr2d_error e, double error, double known, double rounding) {
  return error <= e.bound + known + rounding;
}

static void compare(tally *t, hr2d_error e, double error, double known, double rounding) {
  if (!(error > rounding) || !(error > 10 * known)) return;
  t->compared++;
  t->close += e.estimate >= 0.5 * error && e.estimate <= 2 * error;
}

static int is_fair(const tally *t) {
  return t->close >= 0.95 * t->compared;
}

static hr2d_solution *solve_to(const hr2d_scene *scene, double error, hr2d_norm norm,
                               hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  target.norm = norm;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s: %s", hr2d_strerror(status),
                account->reason);
  ck_assert_int_eq(status == HR2D_EACCURACY, account->reason[0] != '\0');
  ck_assert_ptr_nonnull(solution);
  return solution;
}

/* An account against the solution it is of. */
static void check_account(const hr2d_account *a, const hr2d_solution *solution) {
  const hr2d_linkset *links = hr2d_solution_links(solution);
  const hr2d_hierarchy *hierarchy = hr2d_linkset_hierarchy(links);
  const hr2d_hierarchy_counts counts = hr2d_hierarchy_count(hierarchy);
  ck_assert_uint_eq(a->order, hr2d_hierarchy_order(hierarchy));
  ck_assert_uint_eq(a->elements, counts.elements);
  ck_assert_uint_eq(a->leaves, counts.leaves);
  ck_assert_uint_eq(a->links, hr2d_linkset_size(links));
  ck_assert_uint_ge(a->solves, 1);
  ck_assert(a->kernels > 0 || a->links == 0);
  ck_assert_uint_ge(a->bytes, a->links * a->order * a->order * sizeof(double));
  const double parts[] = {a->refine_seconds, a->coefficients_seconds, a->solve_seconds,
                          a->error_seconds};
  double sum = 0;
  for (int k = 0; k < 4; k++) {
    ck_assert_double_ge(parts[k], 0);
    sum += parts[k];
  }
  ck_assert_double_le(sum, a->seconds * 1.001);
  const hr2d_error errors[] = {a->average, a->sup};
  for (int k = 0; k < 2; k++) {
    ck_assert_double_ge(errors[k].estimate, 0);
    ck_assert_double_le(errors[k].estimate, errors[k].bound * (1 + 1e-6) + 1e-15);
  }
}

static radiosity_scenes read_scenes(void) {
  const char *folder = getenv("HR2D_TEST_DATA");
  char path[4096];
  radiosity_scenes all;
  snprintf(path, sizeof path, "%s/radiosity_fine.csv",
           folder ? folder : "tests/data/reference");
  ck_assert_int_eq(radiosity_scenes_read(path, &all), 0);
  return all;
}

static double kappa_of(const double (*patch)[6], size_t count) {
  double most = 0;
  for (size_t k = 0; k < count; k++) most = fmax(most, patch[k][5]);
  return 1 / (1 - most);
}

/* B at ¼ and ½ after one more gather. */
static double point_error(const radiosity_scene *s, const hr2d_solution *solution) {
  double worst = 0;
  for (size_t k = 0; k < s->patches; k++) {
    double value[2];
    ck_assert_int_eq(hr2d_solution_gather(solution, k, (const double[]){.25, .5}, 2, value),
                     HR2D_OK);
    worst = fmax(worst, fabs(value[0] / s->quarter[k] - 1));
    worst = fmax(worst, fabs(value[1] / s->half[k] - 1));
  }
  return worst;
}

START_TEST(targets_are_met_on_reference_scenes) {
  const double target[] = {1e-3, 1e-6, 1e-9, 1e-12};
  const radiosity_scenes all = read_scenes();
  tally t = {0, 0};
  for (size_t k = 0; k < all.count; k++) {
    const radiosity_scene *s = &all.scene[k];
    const double rounding = ROUNDING * kappa_of(s->patch, s->patches);
    hr2d_scene *scene = radiosity_scene_make(s, NULL);
    ck_assert_ptr_nonnull(scene);
    for (int q = 0; q < 4; q++) {
      hr2d_account a;
      hr2d_solution *solution = solve_to(scene, target[q], HR2D_NORM_AVERAGE, &a);
      const double error = radiosity_average_error(s, solution);
      check_account(&a, solution);
      ck_assert_msg(error <= fmax(target[q], rounding), "%s at %g: error %g", s->name,
                    target[q], error);
      ck_assert_msg(is_bounded(a.average, error, 1e-14, rounding), "%s at %g: %g above %g",
                    s->name, target[q], error, a.average.bound);
      compare(&t, a.average, error, 1e-14, rounding);
      if (q == 3) ck_assert_double_le(point_error(s, solution), s->patches > 4 ? 1e-10 : 1e-12);
      hr2d_solution_destroy(solution);
    }
    hr2d_scene_destroy(scene);
  }
  ck_assert_int_gt(t.compared, 10);
  ck_assert_msg(is_fair(&t), "%d of %d", t.close, t.compared);
}
END_TEST

static void check_nystrom_at(const nystrom *n, double target, double known, tally *t) {
  const double rounding = ROUNDING * kappa_of(n->patch, 2);
  hr2d_scene *scene = test_scene(n->patch, 2);
  hr2d_account a;
  hr2d_solution *solution = solve_to(scene, target, HR2D_NORM_AVERAGE, &a);
  double error = 0;
  for (size_t k = 0; k < 2; k++)
    error = fmax(error, fabs(hr2d_solution_average(solution, k, 0) / n->average[k] - 1));
  const double *w = n->patch[1];
  ck_assert_msg(error <= target + known + rounding,
                "(%g %g)-(%g %g), rho %g, target %g: error %g", w[0], w[1], w[2], w[3], w[5],
                target, error);
  ck_assert_msg(is_bounded(a.average, error, known, rounding),
                "(%g %g)-(%g %g), rho %g, target %g: error %g above %g", w[0], w[1], w[2], w[3],
                w[5], target, error, a.average.bound);
  compare(t, a.average, error, known, rounding);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}

/* Averages are known so well, and points as the other method integrates G beside a thin gap. */
static void check_nystrom(const nystrom *n, double known, double points, tally *t) {
  for (double target = 1e-3; target > 1e-13; target *= 1e-3)
    check_nystrom_at(n, target, known, t);
  hr2d_scene *scene = test_scene(n->patch, 2);
  hr2d_account a;
  hr2d_solution *solution = solve_to(scene, 1e-14, HR2D_NORM_AVERAGE, &a);
  for (size_t k = 0; k < 2; k++) {
    double value[3];
    ck_assert_int_eq(hr2d_solution_gather(solution, k, n->place, 3, value), HR2D_OK);
    for (int q = 0; q < 3; q++)
      ck_assert_double_le(fabs(value[q] / n->value[k][q] - 1), points);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}

static const double reflectances[] = {.5, .9, .999};

START_TEST(corners_agree_with_another_method) {
  const double angle[] = {20, 30, 60, 90, 120, 150}, rho = reflectances[_i];
  tally t = {0, 0};
  for (int k = 0; k < 6; k++) {
    const nystrom n = nystrom_corner(angle[k], k ? 1 : .3, rho);
    check_nystrom(&n, 1e-14, 1e-12, &t);
  }
  ck_assert_msg(is_fair(&t), "%d of %d", t.close, t.compared);
}
END_TEST

START_TEST(a_narrow_corner_agrees_with_another_method) {
  tally t = {0, 0};
  const double rho = reflectances[_i];
  const nystrom n = nystrom_corner(10, 1, rho);
  check_nystrom(&n, rho > .99 ? 1e-12 : 1e-13, 1e-12, &t);
  ck_assert_msg(is_fair(&t), "%d of %d", t.close, t.compared);
}
END_TEST

/* A floor much wider than the ceiling: what an end does to the floor comes back to its patch.
 */
START_TEST(gaps_agree_with_another_method) {
  const double gap[][3] = {{.1, 0, 1}, {.01, .3, .7}, {.02, .1, 2}, {1, -.3, .7}, {10, 0, 1}};
  tally t = {0, 0};
  for (int k = 0; k < 5; k++) {
    const nystrom n = nystrom_parallel(gap[k][0], gap[k][1], gap[k][2], reflectances[_i]);
    check_nystrom(&n, 1e-14, 1e-10, &t);
  }
  ck_assert_msg(is_fair(&t), "%d of %d", t.close, t.compared);
}
END_TEST

/* Walls on a floor of one patch, or of three that end where walls stand. */
static hr2d_scene *make_flooring(int cut, double rho) {
  const double foot[] = {0, 1, 2, 8};
  double patch[8][6];
  size_t count = 0;
  for (int k = 0; k < (cut ? 3 : 1); k++) {
    const double floor[6] = {foot[k], 0, cut ? foot[k + 1] : 8, 0, .6, rho};
    memcpy(patch[count++], floor, sizeof floor);
  }
  const double wall[][6] = {{1, 0, 4.2, 2.6, 0, .9},
                            {4.2, 2.6, 1, 0, 0, .8},
                            {2, 0, 7.8, 5.3, .1, .9},
                            {7.8, 5.3, 2, 0, 0, .7}};
  for (int k = 0; k < 4; k++) memcpy(patch[count++], wall[k], sizeof wall[k]);
  return test_scene((const double(*)[6])patch, count);
}

static void compare_floorings(double rho, double target) {
  const double rounding = 10 * ROUNDING;
  hr2d_scene *scene[] = {make_flooring(0, rho), make_flooring(1, rho)};
  hr2d_solution *solution[2];
  hr2d_account a[2];
  for (int m = 0; m < 2; m++)
    solution[m] = solve_to(scene[m], target, HR2D_NORM_AVERAGE, &a[m]);
  ck_assert_str_eq(a[0].reason, "");
  for (size_t w = 1; w < 5; w++) {
    const double one = hr2d_solution_average(solution[0], w, 0);
    const double error = fabs(one / hr2d_solution_average(solution[1], w + 2, 0) - 1);
    ck_assert_double_le(error, 2 * target + rounding);
    ck_assert_double_le(error, a[0].average.bound + a[1].average.bound + rounding);
  }
  for (int m = 0; m < 2; m++) {
    hr2d_solution_destroy(solution[m]);
    hr2d_scene_destroy(scene[m]);
  }
}

START_TEST(feet_of_walls_are_as_corners) {
  for (double target = 1e-2; target > 1e-13; target *= 1e-2) {
    compare_floorings(0, target);
    compare_floorings(.9, target);
  }
}
END_TEST

/* Where patches face no other but the surroundings, and hide these from each other: events of
   the background alone. */
static hr2d_scene *make_backs(void) {
  const double light = .5, rho = .9, sky = 1;
  const hr2d_segment at[] = {{{0, 0}, {1, 0}}, {{.1, .5}, {.5, .6}}, {{.4, .9}, {.9, .8}}};
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (int k = 0; k < 3; k++) {
    const hr2d_patch patch = {.a = at[k].a,
                              .b = at[k].b,
                              .emission = &light,
                              .emission_bands = 1,
                              .reflectance = &rho,
                              .reflectance_bands = 1};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  /* The floor's light comes back from a wall. */
  const hr2d_patch wall = {
      .a = {-1, 1}, .b = {-1, 0}, .reflectance = &rho, .reflectance_bands = 1};
  ck_assert_int_eq(hr2d_scene_add(scene, &wall, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

/* A wall whose end hangs just above a floor; a narrow room with much reflection, in which few
   coefficients make light. */
static hr2d_scene *make_hard(int k) {
  const double hanging[][6] = {
      {0, 0, 1, 0, 1, .9}, {.45, .01, .45, 1, 0, .9}, {.45, 1, .45, .01, 0, .9}};
  const double narrow[][6] = {{.94264477929416823, .33379757349245182, -.99903169207574294,
                               .043996343351213753, .3615, .999},
                              {-.99903169207574294, .043996343351213753, -.46774801041040093,
                               -.88386186633269315, .65, .999},
                              {-.46774801041040093, -.88386186633269315, .94264477929416823,
                               .33379757349245182, 0, .999}};
  return k == 2 ? make_backs() : test_scene(k ? narrow : hanging, 3);
}

START_TEST(hard_places_are_met) {
  hr2d_scene *scene = make_hard(_i);
  hr2d_account a;
  hr2d_solution *truth = solve_to(scene, 1e-13, HR2D_NORM_AVERAGE, &a);
  for (double target = 1e-2; target > 1e-9; target *= .1)
    for (int norm = 0; norm < (target < 1e-4 ? 1 : 2); norm++) {
      hr2d_solution *solution = solve_to(scene, target, (hr2d_norm)norm, &a);
      ck_assert_str_eq(a.reason, "");
      for (size_t p = 0; p < hr2d_scene_patches(scene); p++) {
        const double right = hr2d_solution_average(truth, p, 0);
        const double error = fabs(hr2d_solution_average(solution, p, 0) / right - 1);
        ck_assert(norm == 1 || error <= target);
        ck_assert_double_le(error, a.average.bound);
      }
      hr2d_solution_destroy(solution);
    }
  hr2d_solution_destroy(truth);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A random scene and what is known of it. */
typedef struct trial {
  accuracy_scene drawn;
  hr2d_scene *scene;
  size_t patches;
  double kappa;
} trial;

/* ‖(I − ρK)⁻¹‖∞, roughly. */
static double measure_kappa(uint64_t seed, int k, double most) {
  accuracy_scene s = accuracy_draw(seed, k, most);
  hr2d_account a;
  double kappa = 1;
  accuracy_set_uniform(&s);
  hr2d_scene *scene = accuracy_make(&s);
  hr2d_solution *solution = solve_to(scene, .1, HR2D_NORM_AVERAGE, &a);
  for (size_t p = 0; p < hr2d_scene_patches(scene); p++)
    kappa = fmax(kappa, hr2d_solution_average(solution, p, 0));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  accuracy_free(&s);
  return kappa;
}

static trial make_trial(uint64_t seed, int k, double most) {
  trial t = {.drawn = accuracy_draw(seed, k, most)};
  t.scene = accuracy_make(&t.drawn);
  t.patches = hr2d_scene_patches(t.scene);
  t.kappa = measure_kappa(seed, k, most);
  return t;
}

static void end_trial(trial *t) {
  hr2d_scene_destroy(t->scene);
  accuracy_free(&t->drawn);
}

static double largest_average(const trial *t, const hr2d_solution *solution, size_t band) {
  double most = 0;
  for (size_t p = 0; p < t->patches; p++)
    most = fmax(most, hr2d_solution_average(solution, p, band));
  return most;
}

/* The largest relative error of an average, without what rounding explains: patches so dark
   that this is all there is to see have no digits. */
static double average_distance(const trial *t, const hr2d_solution *one,
                               const hr2d_solution *other, double *rounding) {
  double worst = 0;
  *rounding = ROUNDING * t->kappa;
  for (size_t b = 0; b < t->drawn.bands; b++) {
    const double most = largest_average(t, other, b);
    for (size_t p = 0; p < t->patches; p++) {
      const double right = hr2d_solution_average(other, p, b);
      const double error = fabs(hr2d_solution_average(one, p, b) - right);
      if (!(right > 1e-9 * most) || !(error > worst * right)) continue;
      worst = error / right;
      *rounding = ROUNDING * t->kappa * most / right;
    }
  }
  return worst;
}

enum { PLACES = 24 };

/* Of B at points, relative to the largest of the band. */
static double sup_distance(const trial *t, const hr2d_solution *one,
                           const hr2d_solution *other) {
  double place[PLACES], value[2][PLACES * ACCURACY_BANDS], worst[ACCURACY_BANDS] = {0},
                                                           most[ACCURACY_BANDS] = {0}, all = 0;
  const size_t bands = t->drawn.bands;
  for (int k = 0; k < PLACES; k++) place[k] = (k + .37) / PLACES;
  place[0] = 1e-3, place[PLACES - 1] = 1 - 1e-3;
  for (size_t p = 0; p < t->patches; p++) {
    ck_assert_int_eq(hr2d_solution_gather(one, p, place, PLACES, value[0]), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather(other, p, place, PLACES, value[1]), HR2D_OK);
    for (size_t k = 0; k < PLACES * bands; k++) {
      worst[k % bands] = fmax(worst[k % bands], fabs(value[0][k] - value[1][k]));
      most[k % bands] = fmax(most[k % bands], value[1][k]);
    }
  }
  for (size_t b = 0; b < bands; b++)
    if (worst[b] > 0) all = fmax(all, worst[b] / most[b]);
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
static double most_of(int k) {
  const double most[] = {.5, .9, .99, .999};
  return most[k % 4];
}

static int trials(int count) {
  const int wanted = (int)(count * test_multiplier());
  return wanted > 3 ? wanted : 3;
}

START_TEST(averages_of_random_scenes) {
  const double target[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
  const uint64_t seed = test_seed();
  tally all = {0, 0};
  for (int k = 0; k < trials(100); k++) {
    trial t = make_trial(seed, k, most_of(k));
    hr2d_account a, b;
    double rounding;
    hr2d_solution *solution = solve_to(t.scene, target[k % 5], HR2D_NORM_AVERAGE, &a);
    hr2d_solution *truth =
        solve_to(t.scene, fmax(1e-2 * a.average.estimate, 1e-14), HR2D_NORM_AVERAGE, &b);
    const double error = average_distance(&t, solution, truth, &rounding);
    const double known = 2 * b.average.estimate;
    if ((!a.reason[0] && error > target[k % 5] + known + rounding) ||
        !is_bounded(a.average, error, known, rounding))
      fail_trial(&t, seed, k, target[k % 5], error, a.average);
    compare(&all, a.average, error, known, rounding);
    check_account(&a, solution);
    hr2d_solution_destroy(truth);
    hr2d_solution_destroy(solution);
    end_trial(&t);
  }
  ck_assert_msg(is_fair(&all), "HR2D_TEST_SEED=%llu: %d of %d", (unsigned long long)seed,
                all.close, all.compared);
}
END_TEST

/* Points are few, so that the largest error may lie between them: only what is below an error
   that was found is wrong. */
START_TEST(points_of_random_scenes) {
  const double target[] = {1e-2, 1e-3, 1e-4};
  const uint64_t seed = test_seed();
  for (int k = 0; k < trials(30); k++) {
    trial t = make_trial(seed, k + 1000, most_of(k));
    hr2d_account a, b;
    const double rounding = ROUNDING * t.kappa;
    hr2d_solution *solution = solve_to(t.scene, target[k % 3], HR2D_NORM_SUP, &a);
    hr2d_solution *truth = solve_to(t.scene, 1e-2 * target[k % 3], HR2D_NORM_SUP, &b);
    const double error = sup_distance(&t, solution, truth), known = 2 * b.sup.estimate;
    if ((!a.reason[0] && error > target[k % 3] + known) ||
        !is_bounded(a.sup, error, known, rounding) || 2 * a.sup.estimate < error - known)
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

/* Closed rooms and open scenes in surroundings of 1, at whatever order. */
START_TEST(furnaces_are_exact) {
  const double target[] = {1e-1, 1e-3, 1e-6, 1e-9};
  const uint64_t seed = test_seed();
  for (int k = 0; k < trials(60); k++) {
    trial t = make_trial(seed, k + 2000, k % 3 ? .9 : .999);
    hr2d_account a;
    hr2d_scene_destroy(t.scene);
    accuracy_set_isothermal(&t.drawn);
    t.scene = accuracy_make(&t.drawn);
    hr2d_solution *solution = solve_to(t.scene, target[k % 4], HR2D_NORM_AVERAGE, &a);
    const double error = furnace_error(t.scene, solution);
    if (!(error <= 1e-14 * fmax(t.kappa, 10)))
      fail_trial(&t, seed, k + 2000, target[k % 4], error, a.average);
    hr2d_solution_destroy(solution);
    end_trial(&t);
  }
}
END_TEST

START_TEST(targets_without_meaning_are_refused) {
  hr2d_scene *scene = test_named_scene("par0.1"), *open = NULL;
  hr2d_solution *solution = (hr2d_solution *)scene;
  hr2d_prediction prediction;
  hr2d_target bad[7];
  for (int k = 0; k < 7; k++) bad[k] = (hr2d_target)HR2D_TARGET_INIT;
  bad[0].error = -1e-6;
  bad[1].error = NAN;
  bad[2].seconds = -1;
  bad[3].seconds = NAN;
  bad[4].norm = (hr2d_norm)2;
  bad[5].norm = (hr2d_norm)-1;
  bad[6].importance = 2;
  for (int k = 0; k < 7; k++) {
    hr2d_account account = {.order = 7};
    solution = (hr2d_solution *)scene;
    ck_assert_int_eq(hr2d_solve_to(scene, &bad[k], &solution, &account), HR2D_EINVAL);
    ck_assert_ptr_null(solution);
    ck_assert_uint_eq(account.order, 0);
  }
  for (int k = 0; k < 2; k++)
    ck_assert_int_eq(hr2d_predict(scene, &bad[k], &prediction), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_scene_create(NULL, &open), HR2D_OK);
  ck_assert_int_eq(hr2d_solve_to(open, NULL, &solution, NULL), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_predict(open, NULL, &prediction), HR2D_ESTATE);
  hr2d_scene_destroy(open);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(defaults_and_older_structs) {
  hr2d_scene *scene = test_named_scene("square_rho0.9");
  hr2d_solution *plain, *small;
  hr2d_account a, b;
  hr2d_target target = HR2D_TARGET_INIT;
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &plain, NULL), HR2D_OK);
  /* A struct that ends behind `error`: nothing behind that is looked at. */
  target.struct_size = offsetof(hr2d_target, norm);
  target.norm = (hr2d_norm)77;
  target.seconds = NAN;
  target.importance = 99;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &small, &a), HR2D_OK);
  for (size_t k = 0; k < 4; k++)
    ck_assert_double_eq(hr2d_solution_average(plain, k, 0), hr2d_solution_average(small, k, 0));
  hr2d_solution_destroy(small);
  target.error = 1e-9;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &small, &b), HR2D_OK);
  ck_assert_uint_gt(b.order, a.order);
  ck_assert_int_eq(hr2d_solution_error(plain, NULL, NULL, NULL), HR2D_OK);
  hr2d_solution_destroy(small);
  hr2d_solution_destroy(plain);
  hr2d_scene_destroy(scene);
}
END_TEST

/* As small as can be had. */
START_TEST(an_error_of_nothing_takes_what_doubles_give) {
  const char *name[] = {"par_d0.1_rho0.9", "orth_touch_rho0.7", "square_rho0.9"};
  const radiosity_scenes all = read_scenes();
  for (int k = 0; k < 3; k++) {
    const radiosity_scene *s = radiosity_scenes_find(&all, name[k]);
    hr2d_scene *scene = test_named_scene(name[k]);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_account a;
    hr2d_solution *solution;
    target.error = 0;
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &a), HR2D_OK);
    ck_assert_double_le(a.average.estimate, 1e-13);
    if (s) ck_assert_double_le(radiosity_average_error(s, solution), 2e-13);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* What little time there is, there is a status and a reason, and a solution if it is OK. */
START_TEST(time_runs_out) {
  const double seconds[] = {1e-12, 1e-4, 1e-3, 5e-3, 2e-2};
  for (int k = 0; k < 5; k++)
    for (int none = 0; none < 4; none++) {
      hr2d_scene *scene = test_named_scene("occ_square_walls0.5_occ0.5");
      hr2d_target target = HR2D_TARGET_INIT;
      hr2d_account a;
      hr2d_solution *solution;
      target.seconds = seconds[k];
      target.error = none & 1 ? 0 : 1e-13;
      if (none & 2) target.importance = 0;
      const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &a);
      ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
      if (status == HR2D_OK) ck_assert_ptr_nonnull(solution);
      if (status == HR2D_EACCURACY) ck_assert_int_ne(a.reason[0], 0);
      if (!solution) ck_assert_uint_eq(a.order, 0);
      if (solution) ck_assert_double_gt(hr2d_solution_average(solution, 0, 0), 0.9);
      hr2d_solution_destroy(solution);
      hr2d_scene_destroy(scene);
    }
}
END_TEST

static void *get_some(void *ctx, size_t bytes) {
  (void)ctx;
  return bytes < 1u << 26 ? malloc(bytes ? bytes : 1) : NULL;
}

static void *change_some(void *ctx, void *block, size_t bytes) {
  (void)ctx;
  return bytes < 1u << 26 ? realloc(block, bytes ? bytes : 1) : NULL;
}

static void release_some(void *ctx, void *block) {
  (void)ctx;
  free(block);
}

/* Patches of 2^-1008 of the scene, whose squares no double has; and of 2^-816, one of which
   touches what is so long. */
START_TEST(dust_is_not_divided_for_ever) {
  const hr2d_allocator hooks = {get_some, change_some, release_some, NULL};
  const double one = 1, half = 0.5;
  const hr2d_segment wall[] = {{{-1, -1}, {1, -1}}, {{1, -1}, {1, .5}}, {{1, .5}, {-1, -1}}};
  const hr2d_segment endless[] = {{{-0x1p+1009, -1}, {-2, -2}},
                                  {{-1, -1}, {-.5, 0x1.0e30cfa0000f1p+817}}};
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  hr2d_account a;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 0.25;
  target.max_elements = 300;
  ck_assert_int_eq(hr2d_scene_create(&hooks, &scene), HR2D_OK);
  for (int k = 0; k < 4; k++) {
    const hr2d_segment *at = k < 3 ? &wall[k] : &endless[_i];
    const hr2d_patch patch = {.a = at->a,
                              .b = at->b,
                              .emission = &one,
                              .emission_bands = 1,
                              .reflectance = &half,
                              .reflectance_bands = 1};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &a);
  ck_assert_msg(status == HR2D_OK || status == HR2D_EACCURACY, "%s", hr2d_strerror(status));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(other_budgets_hold) {
  hr2d_scene *scene = test_named_scene("square_rho0.9");
  for (int k = 0; k < 3; k++) {
    const uint64_t budget[] = {30, 100, 30000};
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_account a;
    hr2d_solution *solution;
    target.error = 1e-12;
    if (k == 0) target.max_elements = budget[k];
    if (k == 1) target.max_links = budget[k];
    if (k == 2) target.max_bytes = budget[k];
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &a);
    ck_assert_int_eq(status, HR2D_EACCURACY);
    ck_assert_int_ne(a.reason[0], 0);
    if (solution) {
      const uint64_t used[] = {a.elements, a.links, a.bytes};
      ck_assert_uint_le(used[k], budget[k]);
      ck_assert_double_gt(a.average.estimate, 1e-12);
    }
    hr2d_solution_destroy(solution);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Rooms in a row, with doors that are not in line; light in the first. */
static hr2d_scene *enfilade(int rooms) {
  const double light = 1, rho = .5;
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (int k = 0; k < rooms; k++) {
    const double door = .25 + .1 * (k % 3);
    const hr2d_segment wall[] = {{{k, 0}, {k + 1, 0}},
                                 {{k + 1, 1}, {k, 1}},
                                 {{k, k ? 0 : 1}, {k, k ? door : 0}},
                                 {{k, door + .1}, {k, 1}}};
    for (int w = 0; w < (k ? 4 : 3); w++) {
      const hr2d_patch patch = {.a = wall[w].a,
                                .b = wall[w].b,
                                .emission = &light,
                                .emission_bands = k == 0 && w == 1,
                                .reflectance = &rho,
                                .reflectance_bands = 1,
                                .sides = w < 2 || k == 0 ? HR2D_SIDES_FRONT : HR2D_SIDES_BOTH};
      ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
    }
  }
  const hr2d_patch last = {
      .a = {rooms, 0}, .b = {rooms, 1}, .reflectance = &rho, .reflectance_bands = 1};
  ck_assert_int_eq(hr2d_scene_add(scene, &last, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

START_TEST(importance_spares_links) {
  hr2d_scene *scene = enfilade(6);
  hr2d_account all, one;
  hr2d_solution *truth = solve_to(scene, 1e-11, HR2D_NORM_AVERAGE, &one);
  hr2d_solution *every = solve_to(scene, 1e-8, HR2D_NORM_AVERAGE, &all);
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-8;
  for (target.importance = 0; target.importance < 3; target.importance++) {
    hr2d_solution *solution;
    const size_t p = target.importance;
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &one), HR2D_OK);
    const double right = hr2d_solution_average(truth, p, 0);
    const double error = fabs(hr2d_solution_average(solution, p, 0) / right - 1);
    ck_assert_double_le(error, 1e-8);
    ck_assert_double_le(error, one.average.bound + 1e-11);
    ck_assert_uint_lt(one.links, all.links / 2);
    hr2d_solution_destroy(solution);
  }
  hr2d_solution_destroy(every);
  hr2d_solution_destroy(truth);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The paper's algorithm against the tables. */
START_TEST(errors_of_other_solutions_are_known) {
  const radiosity_scenes all = read_scenes();
  for (size_t k = 0; k < all.count; k++) {
    const radiosity_scene *s = &all.scene[k];
    for (int closure = 0; closure < 2; closure++) {
      test_links t = test_make_links(radiosity_scene_make(s, NULL), NULL, NULL, NULL, NULL);
      hr2d_error average, sup;
      test_refine(&t, .1, 8);
      hr2d_solution *solution = test_solve(&t, closure);
      const double error = radiosity_average_error(s, solution);
      ck_assert_int_eq(hr2d_solution_error(solution, NULL, &average, &sup), HR2D_OK);
      if (error > 1e-12)
        ck_assert_msg(fabs(average.estimate / error - 1) < .05, "%s: %g for %g", s->name,
                      average.estimate, error);
      ck_assert_double_ge(average.bound * (1 + 1e-9) + 1e-13, error);
      ck_assert_double_ge(sup.bound, sup.estimate);
      hr2d_solution_destroy(solution);
      test_free_links(&t);
    }
  }
}
END_TEST

/* Elements and links are those of the first solve. */
START_TEST(predictions_count_right) {
  const radiosity_scenes all = read_scenes();
  int compared = 0;
  for (size_t k = 0; k < all.count; k++)
    for (double error = 1e-3; error > 1e-10; error *= 1e-3) {
      hr2d_scene *scene = radiosity_scene_make(&all.scene[k], NULL);
      hr2d_target target = HR2D_TARGET_INIT;
      hr2d_prediction p;
      hr2d_account a;
      target.error = error;
      ck_assert_int_eq(hr2d_predict(scene, &target, &p), HR2D_OK);
      hr2d_solution *solution = solve_to(scene, error, HR2D_NORM_AVERAGE, &a);
      if (a.solves == 1) {
        compared++;
        ck_assert_uint_eq(p.order, a.order);
        ck_assert_uint_eq(p.elements, a.elements);
        ck_assert_uint_eq(p.leaves, a.leaves);
        ck_assert_uint_eq(p.links, a.links);
        ck_assert_uint_ge(p.bytes, a.bytes);
        ck_assert_uint_le(p.bytes, 50 * a.bytes);
        ck_assert_double_gt(p.seconds, 0);
      }
      hr2d_solution_destroy(solution);
      hr2d_scene_destroy(scene);
    }
  ck_assert_int_gt(compared, 5);
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

/* Everything that allocates, on a scene with a corner and with something in the way. */
static hr2d_status do_all(const hr2d_scene *scene) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  hr2d_prediction prediction;
  hr2d_error error;
  double value[2];
  target.error = 1e-3;
  target.importance = 1;
  hr2d_status status = hr2d_predict(scene, &target, &prediction);
  if (!status) status = hr2d_solve_to(scene, &target, &solution, NULL);
  if (status) ck_assert_ptr_null(solution);
  if (!status) status = hr2d_solution_gather(solution, 0, (const double[]){.3, .6}, 2, value);
  target.importance = HR2D_ALL_PATCHES;
  if (!status) status = hr2d_solution_error(solution, &target, &error, NULL);
  hr2d_solution_destroy(solution);
  return status;
}

/* The scene itself is made while there is memory. */
START_TEST(memory_may_run_out) {
  const radiosity_scene s = {.patches = 4,
                             .patch = {{0, 0, 1, 0, 1, .5},
                                       {1, 0, 1, 1, 0, .5},
                                       {.4, .3, .6, .3, 0, .5},
                                       {.6, .3, .4, .3, 0, .5}},
                             .label = {"floor", "wall", "upper", "lower"}};
  for (int for_good = 0; for_good < 2; for_good++) {
    test_memory memory = {.until_failure = -1, .for_good = for_good};
    const hr2d_allocator hooks = test_hooks(&memory);
    hr2d_scene *scene = radiosity_scene_make(&s, &hooks);
    const long before = memory.live;
    const long step = test_multiplier() < 1 ? 7 : 1;
    hr2d_status status = HR2D_ENOMEM;
    for (long k = 0; status; k += step) {
      memory.until_failure = k;
      memory.failures = 0;
      status = do_all(scene);
      ck_assert_msg(status == HR2D_ENOMEM || (!status && !memory.failures),
                    "allocation %ld: %s, %ld failed", k, hr2d_strerror(status),
                    memory.failures);
      ck_assert_int_eq(memory.live, before);
    }
    memory.until_failure = -1;
    hr2d_scene_destroy(scene);
    ck_assert_int_eq(memory.live, 0);
  }
}
END_TEST

typedef struct stopper {
  int left, calls;
  hr2d_status status;
} stopper;

static hr2d_status stop(void *ctx, const hr2d_progress *progress) {
  stopper *s = ctx;
  s->calls++;
  ck_assert_ptr_nonnull(progress->phase);
  ck_assert(progress->fraction >= 0 && progress->fraction <= 1);
  return s->left-- > 0 ? HR2D_OK : s->status;
}

START_TEST(a_callback_stops_it_anywhere) {
  const hr2d_status asked[] = {HR2D_STOPPED, HR2D_ECALLBACK};
  hr2d_scene *scene = test_named_scene("occ_square_walls0.5_occ0.5");
  for (int seconds = 0; seconds < 2; seconds++) {
    hr2d_status status = HR2D_STOPPED;
    for (int k = 0; status; k++) {
      stopper s = {k, 0, asked[k % 2]};
      hr2d_target target = HR2D_TARGET_INIT;
      hr2d_solution *solution;
      hr2d_account a;
      target.error = 1e-4;
      target.seconds = seconds ? 1e6 : 0;
      target.progress = stop;
      target.progress_ctx = &s;
      status = hr2d_solve_to(scene, &target, &solution, &a);
      ck_assert_int_eq(status, s.calls > k ? asked[k % 2] : HR2D_OK);
      ck_assert_int_eq(solution != NULL, status == HR2D_OK);
      hr2d_solution_destroy(solution);
    }
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Against the truth of another scene neither bound nor estimate can stand. */
START_TEST(a_wrong_truth_is_noticed) {
  const radiosity_scenes all = read_scenes();
  const radiosity_scene *s = radiosity_scenes_find(&all, "square_rho0.9");
  radiosity_scene wrong = *s;
  tally t = {0, 0};
  wrong.average[2] *= 1 + 1e-5;
  hr2d_scene *scene = radiosity_scene_make(s, NULL);
  hr2d_account a;
  hr2d_solution *solution = solve_to(scene, 1e-9, HR2D_NORM_AVERAGE, &a);
  ck_assert(is_bounded(a.average, radiosity_average_error(s, solution), 1e-14, 1e-12));
  const double error = radiosity_average_error(&wrong, solution);
  ck_assert(!is_bounded(a.average, error, 1e-14, 1e-12));
  compare(&t, a.average, error, 1e-14, 1e-12);
  ck_assert_int_eq(t.compared, 1);
  ck_assert(!is_fair(&t));
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("accuracy");
  TCase *known = tcase_create("known radiosities");
  tcase_add_test(known, targets_are_met_on_reference_scenes);
  tcase_add_loop_test(known, corners_agree_with_another_method, 0, 3);
  tcase_add_loop_test(known, a_narrow_corner_agrees_with_another_method, 0, 3);
  tcase_add_loop_test(known, gaps_agree_with_another_method, 0, 3);
  tcase_add_test(known, feet_of_walls_are_as_corners);
  tcase_add_loop_test(known, hard_places_are_met, 0, 3);
  tcase_add_test(known, an_error_of_nothing_takes_what_doubles_give);
  tcase_add_test(known, errors_of_other_solutions_are_known);
  tcase_add_test(known, a_wrong_truth_is_noticed);
  suite_add_tcase(suite, known);
  TCase *drawn = tcase_create("random scenes");
  tcase_add_test(drawn, averages_of_random_scenes);
  tcase_add_test(drawn, points_of_random_scenes);
  tcase_add_test(drawn, furnaces_are_exact);
  tcase_add_test(drawn, threads_change_no_bit);
  suite_add_tcase(suite, drawn);
  TCase *calls = tcase_create("calls");
  tcase_add_test(calls, targets_without_meaning_are_refused);
  tcase_add_test(calls, defaults_and_older_structs);
  tcase_add_test(calls, time_runs_out);
  tcase_add_test(calls, other_budgets_hold);
  tcase_add_loop_test(calls, dust_is_not_divided_for_ever, 0, 2);
  tcase_add_test(calls, importance_spares_links);
  tcase_add_test(calls, predictions_count_right);
  tcase_add_test(calls, memory_may_run_out);
  tcase_add_test(calls, a_callback_stops_it_anywhere);
  suite_add_tcase(suite, calls);
  return test_run(suite);
}
