/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of floats: they round those of doubles, solutions stay within the bound of roundings,
   no bit depends on threads, and targets have them where they suffice.  HR2D_TEST_SEED and
   HR2D_TEST_MULTIPLIER change the scenes. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/strategy.h"
#include "estimate/error-estimate.h"
#include "links/linkset-impl.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/solve-how.h"
#include "support/accuracy-scenes.h"
#include "support/slow-scenes.h"
#include "support/support.h"

#define AIM 1e-3

static hr2d_scene *slow(slow_kind kind, size_t patches) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(slow_add(scene, kind, patches), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* A solve of a scene, with its links and errors. */
typedef struct answer {
  hr2di_graded graded;
  hr2di_error_pair errors;
  size_t values;    /* patches × bands */
  double *value[2]; /* averages of B and of H */
} answer;

static void solve(const hr2d_scene *scene, int single, unsigned threads, answer *a) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2di_message message;
  hr2di_survey survey;
  hr2di_watch watch;
  target.threads = threads;
  target.floor = HR2D_FLOOR;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "refine");
  ck_assert_int_eq(hr2di_strategy_survey(scene, NULL, 1, &watch, &survey), HR2D_OK);
  hr2di_resolution f = hr2di_strategy_for(scene, &survey, AIM, &target, NULL);
  f.a_posteriori = 0;
  f.single = single;
  ck_assert_int_eq(hr2di_graded_refine(&a->graded, scene, &f, &target, &message), HR2D_OK);
  ck_assert_int_eq(hr2di_graded_solve(&a->graded, &f, &target, &message), HR2D_OK);
  if (hr2d_linkset_size(a->graded.links) > 0)
    ck_assert_int_eq(a->graded.links->blocks.single, single);
  ck_assert_int_eq(hr2di_error_estimate(&a->graded, &f, &target, &a->errors, &message),
                   HR2D_OK);
  const size_t bands = hr2d_scene_bands(scene);
  a->values = hr2d_scene_patches(scene) * bands;
  for (int h = 0; h < 2; h++) a->value[h] = malloc(a->values * sizeof *a->value[h]);
  for (size_t k = 0; k < a->values; k++) {
    a->value[0][k] = hr2d_solution_average(a->graded.solution, k / bands, k % bands);
    a->value[1][k] = hr2d_solution_irradiance(a->graded.solution, k / bands, k % bands);
  }
}

static void clear(answer *a) {
  hr2di_graded_clear(&a->graded);
  for (int h = 0; h < 2; h++) free(a->value[h]);
}

/* The largest difference of averages relative to the average, which counts as no less than the
   default floor. */
static double apart(const answer *a, const answer *b, size_t bands) {
  double worst = 0;
  for (int h = 0; h < 2; h++)
    for (size_t band = 0; band < bands; band++) {
      double max = 0;
      for (size_t k = band; k < a->values; k += bands) max = fmax(max, fabs(a->value[h][k]));
      for (size_t k = band; k < a->values && max > 0; k += bands)
        worst = fmax(worst, fabs(a->value[h][k] - b->value[h][k]) /
                                fmax(fabs(a->value[h][k]), HR2D_FLOOR * max));
    }
  return worst;
}

enum { POINTS = 3 };

/* The same at points of a patch, relative to the largest value there. */
static double apart_at(const answer *a, const answer *b, size_t patch, size_t bands) {
  static const double at[POINTS] = {0.1, 0.5, 0.8};
  double x[POINTS * HR2D_MAX_ORDER], y[POINTS * HR2D_MAX_ORDER], worst = 0;
  ck_assert_int_eq(hr2d_solution_gather(a->graded.solution, patch, at, POINTS, x), HR2D_OK);
  ck_assert_int_eq(hr2d_solution_gather(b->graded.solution, patch, at, POINTS, y), HR2D_OK);
  for (size_t band = 0; band < bands; band++) {
    double max = 0, off = 0;
    for (size_t k = band; k < POINTS * bands; k += bands) {
      max = fmax(max, fabs(x[k]));
      off = fmax(off, fabs(x[k] - y[k]));
    }
    if (off > 0) worst = fmax(worst, off / max);
  }
  return worst;
}

/* Compares solutions from floats and doubles; returns the part of the bound that roundings
   take. */
static double compare(const hr2d_scene *scene, double *max) {
  answer floats, doubles;
  solve(scene, 1, 1, &floats);
  solve(scene, 0, 1, &doubles);
  const double off = apart(&floats, &doubles, hr2d_scene_bands(scene));
  const double bound = floats.errors.rounding[0] + doubles.errors.rounding[0];
  ck_assert_msg(off <= bound, "%.3g, and %.3g stated", off, bound);
  const size_t patch = floats.values / hr2d_scene_bands(scene) / 2;
  ck_assert_double_le(apart_at(&floats, &doubles, patch, hr2d_scene_bands(scene)),
                      floats.errors.rounding[0] + floats.errors.rounding[1]);
  /* The size of errors with random signs, which is in both, is from solves to few digits; what
     kinks may hide is no more than residuals allow, and these are roundings in a furnace. */
  ck_assert_double_lt(fabs(floats.errors.average.estimate - doubles.errors.average.estimate),
                      0.02 * AIM + 0.1 * doubles.errors.average.estimate);
  if (off > doubles.errors.rounding[0]) *max = fmax(*max, off);
  clear(&floats);
  clear(&doubles);
  return off / bound;
}

/* The bound for doubles does not hold: floats are used, and roundings are seen. */
START_TEST(averages_keep_to_the_bound) {
  double max = 0, part = 0;
  const size_t count = test_rounds(300, 12);
  for (size_t k = 0; k < count; k++) {
    accuracy_scene drawn = accuracy_draw(test_seed(), (int)k, 0.95);
    hr2d_scene *scene = accuracy_make(&drawn);
    part = fmax(part, compare(scene, &max));
    hr2d_scene_destroy(scene);
    accuracy_free(&drawn);
  }
  static const slow_kind kind[] = {SLOW_SQUARES, SLOW_SOUP, SLOW_COMB, SLOW_ROUND};
  for (int k = 0; k < 4; k++) {
    hr2d_scene *scene = slow(kind[k], 40);
    part = fmax(part, compare(scene, &max));
    hr2d_scene_destroy(scene);
  }
  printf("averages differ by %.2g, %.2g of the bound\n", max, part);
  ck_assert_double_gt(max, 1e-10);
}
END_TEST

START_TEST(threads_change_no_bit) {
  hr2d_scene *scene = slow(SLOW_SQUARES, 120);
  answer one;
  solve(scene, 1, 1, &one);
  for (unsigned threads = 2; threads <= 3; threads++) {
    answer more;
    solve(scene, 1, threads, &more);
    for (int h = 0; h < 2; h++)
      ck_assert_int_eq(memcmp(one.value[h], more.value[h], one.values * sizeof *one.value[h]),
                       0);
    ck_assert_int_eq(memcmp(&one.errors, &more.errors, sizeof one.errors), 0);
    clear(&more);
  }
  clear(&one);
  hr2d_scene_destroy(scene);
}
END_TEST

enum { ORDER = 5, SQUARE = ORDER * ORDER };

static test_links make_links(void) {
  test_links t = test_make_links(slow(SLOW_SQUARES, 60), NULL, NULL, NULL, NULL);
  test_refine(&t, 0.15, 4);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, ORDER), HR2D_OK);
  return t;
}

/* What a block of floats may be off by before it is rounded, as a part of C_00. */
#define UNROUNDED 0.01

/* Each number has one rounding, but C_00 has none. */
START_TEST(numbers_are_rounded_once) {
  test_links t = make_links();
  double worst = 0;
  ck_assert_int_eq(
      hr2di_link_blocks_init(t.links, &(hr2di_blocks_wanted){ORDER, .threads = 1}, NULL),
      HR2D_OK);
  hr2di_link_blocks doubles = t.links->blocks;
  t.links->blocks = (hr2di_link_blocks){0};
  ck_assert_int_eq(
      hr2di_link_blocks_init(t.links, &(hr2di_blocks_wanted){ORDER, 1, .threads = 2}, NULL),
      HR2D_OK);
  const hr2di_link_blocks *floats = &t.links->blocks;
  for (uint64_t k = 0; k < t.links->store.count; k++) {
    const double area = hr2di_store_link(&t.links->store, k).exchange_area;
    const double *exact = hr2di_link_blocks_at(&doubles, k).value;
    const hr2di_stored_block block = hr2di_link_blocks_at(floats, k);
    double rounded[SQUARE];
    hr2di_join_block(&block, area, rounded);
    ck_assert(rounded[0] == area);
    for (size_t n = 1; n < SQUARE; n++) {
      const double off = fabs(rounded[n] - exact[n]);
      ck_assert_double_le(off, 0.5 * FLT_EPSILON * (fabs(exact[n]) + UNROUNDED * exact[0]));
      worst = fmax(worst, off / exact[0]);
    }
  }
  ck_assert_double_gt(worst, 0.1 * FLT_EPSILON);
  const uint64_t links = floats->links; /* a byte each tells whether they are distant */
  ck_assert_uint_eq(2 * (hr2di_link_blocks_bytes(floats) - links),
                    hr2di_link_blocks_bytes(&doubles) - links);
  hr2di_link_blocks_clear(&doubles, &t.links->alloc);
  test_free_links(&t);
}
END_TEST

static hr2d_solution *solve_with(const test_links *t, int single) {
  const hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  const hr2di_equation_how how = {.single = single};
  hr2d_solution *solution = NULL;
  ck_assert_int_eq(hr2di_solve(t->links, &how, &options, &solution), HR2D_OK);
  return solution;
}

/* A solve that asks for other numbers makes all blocks anew. */
START_TEST(numbers_are_those_asked_for) {
  test_links t = make_links();
  hr2d_solution *before = solve_with(&t, 0);
  hr2d_solution *rounded = solve_with(&t, 1);
  ck_assert(t.links->blocks.single);
  hr2d_solution *after = solve_with(&t, 0);
  ck_assert(!t.links->blocks.single);
  ck_assert(hr2d_solution_average(before, 3, 0) == hr2d_solution_average(after, 3, 0));
  ck_assert(hr2d_solution_average(before, 3, 0) != hr2d_solution_average(rounded, 3, 0));
  hr2d_solution_destroy(before);
  hr2d_solution_destroy(rounded);
  hr2d_solution_destroy(after);
  test_free_links(&t);
}
END_TEST

/* Two walls, at right angles. */
static int has_floats(double error, double reflectance, double background) {
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  test_add_patch(scene, (hr2d_segment){{0, 0}, {1, 0}}, 1, 0.5, HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{1, 0}, {1, 1}}, 0, reflectance, HR2D_SIDES_FRONT);
  if (background > 0)
    ck_assert_int_eq(hr2d_scene_set_background(scene, &background, 1), HR2D_OK);
  test_commit(scene);
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, NULL), HR2D_OK);
  const int single = solution->own_links->blocks.single;
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return single;
}

START_TEST(targets_have_floats_where_they_suffice) {
  ck_assert(has_floats(1e-2, 0.9, 0));
  ck_assert(has_floats(1e-3, 0.9, 0));
  ck_assert(!has_floats(1e-3, 0.999, 0));
  ck_assert(!has_floats(1e-3, 0.9, 1e-3));
  ck_assert(!has_floats(1e-5, 0.5, 0));
}
END_TEST

TEST_SUITE("single blocks") {
  ADD_TESTS("blocks", numbers_are_rounded_once, numbers_are_those_asked_for);
  ADD_TESTS("solutions", averages_keep_to_the_bound, threads_change_no_bit,
            targets_have_floats_where_they_suffice);
}
