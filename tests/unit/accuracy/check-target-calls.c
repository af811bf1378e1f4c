/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a call with a target may ask for, and how it ends: refusals, budgets, memory, callbacks,
   importance and predictions. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "support/accuracy-scenes.h"
#include "support/accuracy-tally.h"
#include "support/support.h"

START_TEST(targets_without_meaning_are_refused) {
  hr2d_scene *scene = test_named_scene("par0.1"), *open = NULL;
  hr2d_solution *solution = (hr2d_solution *)scene;
  hr2d_prediction prediction;
  const size_t beyond[] = {0, 2};
  enum { BAD = 13 };
  hr2d_target bad[BAD];
  for (int k = 0; k < BAD; k++) bad[k] = (hr2d_target)HR2D_TARGET_INIT;
  bad[0].error = -1e-6;
  bad[1].error = NAN;
  bad[2].seconds = -1;
  bad[3].seconds = NAN;
  bad[4].norm = (hr2d_norm)2;
  bad[5].norm = (hr2d_norm)-1;
  bad[6].important = beyond;
  bad[6].important_count = 2;
  bad[7].important_count = 1; /* of no patches */
  bad[8].floor = -1e-6;
  bad[9].floor = 1.5;
  bad[10].floor = NAN;
  bad[11].struct_size = 0;
  bad[12].struct_size = sizeof(size_t) - 1;
  for (int k = 0; k < BAD; k++) {
    hr2d_account account = {.order = 7};
    solution = (hr2d_solution *)scene;
    ck_assert_int_eq(hr2d_solve_to(scene, &bad[k], &solution, &account), HR2D_EINVAL);
    ck_assert_ptr_null(solution);
    ck_assert_uint_eq(account.order, 0);
  }
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, NULL), HR2D_OK);
  for (int k = 0; k < BAD; k++) {
    hr2d_error error = {7, 7};
    ck_assert_int_eq(hr2d_predict(scene, &bad[k], &prediction), HR2D_EINVAL);
    ck_assert_int_eq(hr2d_solution_error(solution, &bad[k], &error, NULL), HR2D_EINVAL);
    ck_assert_double_eq(error.bound, 7);
  }
  hr2d_solution_destroy(solution);
  /* Negative control: the patches that exist. */
  bad[6].important_count = 1;
  ck_assert_int_eq(hr2d_solve_to(scene, &bad[6], &solution, NULL), HR2D_OK);
  hr2d_solution_destroy(solution);
  ck_assert_int_eq(hr2d_scene_create(NULL, &open), HR2D_OK);
  ck_assert_int_eq(hr2d_solve_to(open, NULL, &solution, NULL), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_predict(open, NULL, &prediction), HR2D_ESTATE);
  hr2d_scene_destroy(open);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Kernels that an answer without an account takes: those of one hr2d_solve() on its links. */
START_TEST(without_an_account_nothing_is_spent_on_the_error) {
  hr2d_scene *scene = test_named_scene("square_rho0.9");
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_account with, without;
  hr2d_solution *measured, *plain;
  hr2d_prediction all, part;
  target.error = 1e-8;
  target.points = 1;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &measured, &with), HR2D_OK);
  ck_assert_int_eq(hr2d_predict(scene, &target, &all), HR2D_OK);
  target.no_error = 1;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &plain, &without), HR2D_OK);
  ck_assert_int_eq(hr2d_predict(scene, &target, &part), HR2D_OK);
  ck_assert_uint_eq(without.solves, 1);
  ck_assert_double_eq(without.error_seconds, 0);
  ck_assert_uint_eq(without.kernels, hr2d_solution_work(plain).kernels);
  ck_assert(isinf(without.average.estimate) && isinf(without.irradiance_sup.bound));
  for (size_t k = 0; k < 4; k++) {
    const double b = hr2d_solution_average(measured, k, 0);
    ck_assert_double_eq_tol(hr2d_solution_average(plain, k, 0), b, 1e-8 * b);
  }
  ck_assert_uint_lt(part.bytes, all.bytes);
  /* Negative control: the account takes kernels, and is finite. */
  ck_assert_uint_gt(with.kernels, without.kernels);
  ck_assert_double_gt(with.error_seconds, 0);
  ck_assert_double_le(with.average.estimate, 1e-8);
  hr2d_solution_destroy(plain);
  hr2d_solution_destroy(measured);
  target.error = HR2D_SMALLEST_ERROR;
  target.seconds = 0.05;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &plain, &without), HR2D_OK);
  ck_assert_uint_gt(without.order, 1);
  hr2d_solution_destroy(plain);
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
  target.important_count = 99;
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

/* What little time there is, there is a status and a reason, and a solution if it is OK. */
START_TEST(time_runs_out) {
  const double seconds[] = {1e-12, 1e-4, 1e-3, 5e-3, 2e-2};
  const size_t first[] = {0};
  for (int k = 0; k < 5; k++)
    for (int none = 0; none < 4; none++) {
      hr2d_scene *scene = test_named_scene("occ_square_walls0.5_occ0.5");
      hr2d_target target = HR2D_TARGET_INIT;
      hr2d_account a;
      hr2d_solution *solution;
      target.seconds = seconds[k];
      target.error = none & 1 ? HR2D_SMALLEST_ERROR : 1e-13;
      if (none & 2) target.important = first, target.important_count = 1;
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

/* Patches of 2^-1008 of the scene, whose squares underflow; and of 2^-816, one of which
   touches a patch as long as the scene. */
START_TEST(dust_is_not_divided_for_ever) {
  const hr2d_allocator hooks = {get_some, change_some, release_some, NULL};
  const hr2d_segment wall[] = {{{-1, -1}, {1, -1}}, {{1, -1}, {1, .5}}, {{1, .5}, {-1, -1}}};
  const hr2d_segment endless[] = {{{-0x1p+1009, -1}, {-2, -2}},
                                  {{-1, -1}, {-.5, 0x1.0e30cfa0000f1p+817}}};
  hr2d_scene *scene = test_new_scene(&hooks);
  hr2d_solution *solution = NULL;
  hr2d_account a;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 0.25;
  target.max_elements = 300;
  for (int k = 0; k < 4; k++) {
    const hr2d_segment at = k < 3 ? wall[k] : endless[_i];
    ck_assert_int_eq(test_add_patch(scene, at, 1, 0.5, HR2D_SIDES_FRONT), HR2D_OK);
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

START_TEST(importance_spares_links) {
  hr2d_scene *scene = accuracy_enfilade(6, 0.5);
  hr2d_account all, one;
  hr2d_solution *truth = accuracy_solve(scene, 1e-11, HR2D_NORM_AVERAGE, &one);
  hr2d_solution *every = accuracy_solve(scene, 1e-8, HR2D_NORM_AVERAGE, &all);
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-8;
  target.important_count = 1;
  for (size_t p = 0; p < 3; p++) {
    hr2d_solution *solution;
    target.important = &p;
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &one), HR2D_OK);
    const double right = hr2d_solution_average(truth, p, 0);
    const double error = fabs(hr2d_solution_average(solution, p, 0) / right - 1);
    ck_assert_double_le(error, 1e-8);
    ck_assert_double_le(error, one.average.bound + 1e-11);
    ck_assert_uint_lt(4 * one.links, 3 * all.links);
    hr2d_solution_destroy(solution);
  }
  hr2d_solution_destroy(every);
  hr2d_solution_destroy(truth);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A prediction gives the elements and links of the first solve. */
START_TEST(predictions_count_right) {
  const radiosity_scenes all = accuracy_reference();
  int compared = 0;
  for (size_t k = 0; k < all.count; k++)
    for (double error = 1e-3; error > 1e-10; error *= 1e-3) {
      hr2d_scene *scene = radiosity_scene_make(&all.scene[k], NULL);
      hr2d_target target = HR2D_TARGET_INIT;
      hr2d_prediction p;
      hr2d_account a;
      target.error = error;
      ck_assert_int_eq(hr2d_predict(scene, &target, &p), HR2D_OK);
      hr2d_solution *solution = accuracy_solve(scene, error, HR2D_NORM_AVERAGE, &a);
      if (a.solves == 1) {
        compared++;
        ck_assert_uint_eq(p.order, a.order);
        ck_assert_uint_eq(p.elements, a.elements);
        ck_assert_uint_eq(p.leaves, a.leaves);
        ck_assert_uint_eq(p.links, a.links);
        ck_assert_uint_ge(p.bytes, a.bytes);
        ck_assert_uint_le(p.bytes, 50 * a.bytes);
        ck_assert_double_gt(p.least_seconds, 0);
        ck_assert_double_lt(p.least_seconds, p.seconds);
        ck_assert_double_lt(p.seconds, p.most_seconds);
      }
      hr2d_solution_destroy(solution);
      hr2d_scene_destroy(scene);
    }
  ck_assert_int_gt(compared, 5);
}
END_TEST

/* Everything that allocates, on a scene with a corner and with something in the way. */
static hr2d_status do_all(const hr2d_scene *scene) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  hr2d_prediction prediction;
  hr2d_error error;
  double value[2];
  const size_t second = 1;
  target.error = 1e-3;
  target.important = &second;
  target.important_count = 1;
  hr2d_status status = hr2d_predict(scene, &target, &prediction);
  if (!status) status = hr2d_solve_to(scene, &target, &solution, NULL);
  if (status) ck_assert_ptr_null(solution);
  if (!status) status = hr2d_solution_gather(solution, 0, (const double[]){.3, .6}, 2, value);
  target.important_count = 0;
  if (!status) status = hr2d_solution_error(solution, &target, &error, NULL);
  hr2d_solution_destroy(solution);
  return status;
}

/* The scene itself is made while there is memory.  What a patch sees is kept where there is
   memory for it; without it the call goes on. */
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
    long failed = 0, spared = 0;
    memory.failures = 1;
    for (long k = 0; memory.failures > 0; k += step) {
      memory.until_failure = k;
      memory.failures = 0;
      const hr2d_status status = do_all(scene);
      ck_assert_msg(status == HR2D_ENOMEM || !status, "allocation %ld: %s", k,
                    hr2d_strerror(status));
      ck_assert(!status || memory.failures > 0);
      failed += status == HR2D_ENOMEM;
      spared += !status && memory.failures > 0;
      ck_assert_int_eq(memory.live, before);
    }
    ck_assert_int_gt(failed, 20 * spared);
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

TEST_SUITE("target calls") {
  ADD_TESTS("options", targets_without_meaning_are_refused, defaults_and_older_structs,
            importance_spares_links, predictions_count_right,
            without_an_account_nothing_is_spent_on_the_error);
  ADD_TESTS("budgets", time_runs_out, other_budgets_hold, memory_may_run_out,
            a_callback_stops_it_anywhere);
  REPEAT_TESTS(2, "budgets", dust_is_not_divided_for_ever);
}
