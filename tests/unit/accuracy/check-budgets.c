/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A budget always returns an answer: down to one constant per patch over the factors that were
   ready, whose error is unknown. */
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "support/memory.h"
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
    target.points = 1;
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
  for (uint64_t max = 2 * bytes_of_blocks(&free) + 1000000; max > 20000; max -= max / 8) {
    target.max_bytes = max;
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &a);
    ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    if (solution && a.average.estimate <= 1) ck_assert_uint_le(bytes_of_blocks(&a), max);
    coarser += status == HR2D_EACCURACY && solution;
    hr2d_solution_destroy(solution);
  }
  ck_assert_int_gt(coarser, 0);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_scene *room_of_bands(size_t bands, const hr2d_allocator *alloc) {
  enum { PER_WALL = 8, MOST_BANDS = 256 };
  static const double x[] = {0, 1, 1, 0, 0}, y[] = {0, 0, 1, 1, 0};
  double emission[MOST_BANDS], reflectance[MOST_BANDS];
  hr2d_scene *scene;
  ck_assert_uint_le(bands, MOST_BANDS);
  for (size_t b = 0; b < bands; b++) {
    emission[b] = (double)(1 + b % 7);
    reflectance[b] = 0.5 + 0.4 * (double)(b % 5) / 5;
  }
  ck_assert_int_eq(hr2d_scene_create(alloc, &scene), HR2D_OK);
  for (int k = 0; k < 4 * PER_WALL; k++) {
    const int w = k / PER_WALL;
    const double from = (double)(k % PER_WALL) / PER_WALL, to = from + 1.0 / PER_WALL;
    const double dx = x[w + 1] - x[w], dy = y[w + 1] - y[w];
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = (hr2d_point){x[w] + from * dx, y[w] + from * dy};
    patch.b = (hr2d_point){x[w] + to * dx, y[w] + to * dy};
    patch.reflectance = reflectance;
    patch.reflectance_bands = bands;
    if (k == 0) patch.emission = emission;
    if (k == 0) patch.emission_bands = bands;
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

/* Fields of many bands are in the budget, and the reason names them; with a budget of four
   times what is refused there is an answer of the target. */
START_TEST(bytes_are_for_fields) {
  enum { SLACK = 300000 }; /* for what is not counted: the survey and lists of a refinement */
  const size_t bands = 256;
  test_meter meter = {0};
  const hr2d_allocator hooks = test_metered(&meter);
  hr2d_scene *scene = room_of_bands(bands, &hooks);
  const long long before = atomic_load(&meter.held);
  int refused = 0, reached = 0;
  for (uint64_t max = 1000000; max < 100000000; max *= 2) {
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *solution;
    hr2d_account a;
    target.error = 1e-4;
    target.max_bytes = max;
    target.no_error = _i;
    atomic_store(&meter.peak, before);
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &a);
    ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
    ck_assert_int_le(atomic_load(&meter.peak) - before, (long long)max + SLACK);
    if (status) ck_assert_msg(strstr(a.reason, "for fields of 256 bands"), "%s", a.reason);
    refused += status == HR2D_EACCURACY;
    reached += status == HR2D_OK;
    hr2d_solution_destroy(solution);
  }
  ck_assert_int_gt(refused, 0);
  ck_assert_int_gt(reached, 0);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("budgets") {
  ADD_TESTS("answers", some_factors, no_time, all_factors, too_small_for_patches,
            bytes_are_for_blocks);
  REPEAT_TESTS(2, "fields", bytes_are_for_fields);
}
