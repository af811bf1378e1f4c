/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A budget always returns an answer: down to one constant per patch over the factors that were
   ready, whose error is unknown. */
#include <math.h>

#include "support/support.h"

/* A room with three boxes. */
enum { PATCHES = 16 };
static const double room[PATCHES][6] = {
    {0, 0, 4, 0, 0, .5},      {4, 0, 4, 3, 0, .7},      {4, 3, 0, 3, 1, .8},
    {0, 3, 0, 0, 0, .6},      {1, 1, 1, 1.5, 0, .3},    {1, 1.5, 1.5, 1.5, 0, .3},
    {1.5, 1.5, 1.5, 1, 0, 0}, {1.5, 1, 1, 1, 0, .3},    {2.5, 1, 2.5, 1.4, 0, .3},
    {2.5, 1.4, 3, 1.4, 0, 1}, {3, 1.4, 3, 1, 0, .3},    {3, 1, 2.5, 1, 0, .3},
    {2, 2, 2, 2.2, 0, .3},    {2, 2.2, 2.2, 2.2, 0, 0}, {2.2, 2.2, 2.2, 2, 0, .3},
    {2.2, 2, 2, 2, 0, .3}};

static void check_answer(const hr2d_solution *solution, const hr2d_account *a) {
  ck_assert_ptr_nonnull(solution);
  ck_assert_str_ne(a->reason, "");
  const hr2d_power p = hr2d_solution_power(solution, 0);
  ck_assert_double_eq_tol(p.emitted + p.received, p.absorbed + p.escaped,
                          1e-4 * (p.emitted + p.received));
  for (size_t k = 0; k < PATCHES; k++) {
    const double b = hr2d_solution_average(solution, k, 0);
    ck_assert_double_ge(b, room[k][4]);
    ck_assert_double_eq_tol(
        b, room[k][4] + room[k][5] * hr2d_solution_irradiance(solution, k, 0), 1e-5);
  }
}

/* Links for a part of the pairs. */
START_TEST(some_factors) {
  const uint64_t links[] = {2, 7, 40};
  hr2d_scene *scene = test_scene(room, PATCHES);
  double last = 0;
  for (int k = 0; k < 3; k++) {
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *solution;
    hr2d_account a;
    target.max_links = links[k];
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &a), HR2D_EACCURACY);
    check_answer(solution, &a);
    ck_assert_uint_le(a.links, links[k]);
    ck_assert(isinf(a.average.estimate) && isinf(a.average.bound) && isinf(a.sup.bound));
    ck_assert(isinf(a.irradiance.bound) && isinf(a.irradiance_sup.bound));
    double sum = 0;
    for (size_t p = 0; p < PATCHES; p++) sum += hr2d_solution_average(solution, p, 0);
    ck_assert_double_gt(sum, last);
    last = sum;
    hr2d_solution_destroy(solution);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* What takes less than a millisecond is done even without any time. */
START_TEST(no_time) {
  hr2d_scene *scene = test_scene(room, PATCHES);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  hr2d_account a;
  target.seconds = 1e-9;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &a), HR2D_EACCURACY);
  check_answer(solution, &a);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* With all factors the answer is that of whole patches without closure.  An error at points
   takes more links than that; one of averages does not. */
START_TEST(all_factors) {
  hr2d_scene *scene = test_scene(room, PATCHES);
  hr2d_hierarchy *h;
  hr2d_linkset *l;
  hr2d_solution *whole, *solution;
  hr2d_account a;
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_target target = HR2D_TARGET_INIT;
  refine.max_level = HR2D_NO_SUBDIVISION;
  options.closure = HR2D_CLOSURE_OFF;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(h, NULL, NULL, NULL, NULL, &l), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(l, &refine), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(l, &options, &whole), HR2D_OK);
  target.max_links = hr2d_linkset_size(l);
  target.norm = HR2D_NORM_SUP;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &a), HR2D_EACCURACY);
  ck_assert_uint_eq(a.links, target.max_links);
  for (size_t k = 0; k < PATCHES; k++)
    ck_assert_double_eq_tol(hr2d_solution_average(solution, k, 0),
                            hr2d_solution_average(whole, k, 0), 1e-4);
  hr2d_solution_destroy(solution);
  hr2d_solution_destroy(whole);
  hr2d_linkset_destroy(l);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Where the patches themselves are too many there is no answer. */
START_TEST(too_small_for_patches) {
  hr2d_scene *scene = test_scene(room, PATCHES);
  for (int k = 0; k < 2; k++) {
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *solution;
    hr2d_account a;
    target.max_elements = k == 0 ? PATCHES - 1 : 0;
    target.max_bytes = k == 1 ? PATCHES : 0;
    ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &a), HR2D_EACCURACY);
    ck_assert_ptr_null(solution);
    ck_assert_str_ne(a.reason, "");
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Blocks of a solve whose error is measured have two coefficients more. */
static uint64_t bytes_of_blocks(const hr2d_account *a) {
  const uint64_t order = a->order + 2;
  return a->links * (order * order * sizeof(double) + 1);
}

/* With half of the bytes of one that is not limited there is a coarser answer, and at most as
   many bytes are in blocks as there may be. */
START_TEST(bytes_are_for_blocks) {
  hr2d_scene *scene = test_scene(room, PATCHES);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  hr2d_account free, a;
  target.error = 1e-10;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &free), HR2D_OK);
  hr2d_solution_destroy(solution);
  ck_assert_uint_gt(bytes_of_blocks(&free), 20000);
  int coarser = 0;
  for (uint64_t most = 2 * bytes_of_blocks(&free) + 1000000; most > 20000; most -= most / 8) {
    target.max_bytes = most;
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &a);
    ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    if (solution && a.average.estimate <= 1) ck_assert_uint_le(bytes_of_blocks(&a), most);
    coarser += status == HR2D_EACCURACY && solution;
    hr2d_solution_destroy(solution);
  }
  ck_assert_int_gt(coarser, 0);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("budgets") {
  ADD_TESTS("answers", some_factors, no_time, all_factors, too_small_for_patches,
            bytes_are_for_blocks);
}
