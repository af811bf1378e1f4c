/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elements that make errors which are too large are divided, and others keep what they had. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/strategy.h"
#include "base/alloc.h"
#include "estimate/error-estimate.h"
#include "links/linkset-impl.h"
#include "mesh/admissibility.h"
#include "mesh/point-grid.h"
#include "mesh/refine-marked.h"
#include "mesh/reuse-links.h"
#include "support/plane.h"
#include "support/slow-scenes.h"
#include "support/support.h"

static hr2d_scene *squares(size_t patches) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(slow_add(scene, SLOW_SQUARES, patches), HR2D_OK);
  test_commit(scene);
  return scene;
}

static hr2d_hierarchy *trees(const hr2d_scene *scene, unsigned order) {
  hr2d_hierarchy *h = NULL;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_set_order(h, order), HR2D_OK);
  return h;
}

START_TEST(leaves_are_halved_so_often) {
  hr2d_scene *scene = squares(40);
  hr2d_hierarchy *h = trees(scene, 3), *divided = NULL;
  const size_t n = hr2d_scene_patches(scene);
  unsigned char *depth = calloc(n, 1);
  depth[3] = 1;
  depth[7] = 3;
  ck_assert_int_eq(hr2di_refine_marked(h, depth, 0, NULL, &divided), HR2D_OK);
  ck_assert_uint_eq(hr2d_hierarchy_count(divided).leaves, n + 1 + 7);
  for (size_t k = 0; k < n; k++) ck_assert_int_eq(divided->element[k].child > 0, depth[k] > 0);
  ck_assert_uint_eq(hr2d_hierarchy_count(h).elements, n);
  hr2d_hierarchy_destroy(divided);
  ck_assert_int_eq(hr2di_refine_marked(h, depth, n + 15, NULL, &divided), HR2D_EMAX_ELEMENTS);
  ck_assert_ptr_null(divided);
  ck_assert_int_eq(hr2di_refine_marked(h, depth, n + 16, NULL, &divided), HR2D_OK);
  free(depth);
  hr2d_hierarchy_destroy(divided);
  hr2d_hierarchy_destroy(h);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Links of elements that are as they are, with blocks of order 4, of floats if `single` is set;
   with `coarse`, of its elements with some divided. */
static hr2d_linkset *linked_with(hr2d_hierarchy *h, hr2d_linkset *coarse, unsigned threads,
                                 int single) {
  hr2d_linkset *links = NULL;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 0.5;
  options.max_level = UINT32_MAX;
  options.threads = threads;
  ck_assert_int_eq(hr2d_linkset_create(h, hr2di_admissibility_oracle(), NULL,
                                       hr2di_admissibility_fixed_leaves(), NULL, &links),
                   HR2D_OK);
  ck_assert_int_eq(coarse ? hr2di_reuse_links(links, coarse, &(hr2di_refine_how){0}, &options)
                          : hr2d_refine(links, &options),
                   HR2D_OK);
  const hr2di_blocks_wanted wanted = {4, single, .threads = threads};
  ck_assert_int_eq(hr2di_link_blocks_init(links, &wanted, NULL), HR2D_OK);
  links->oracle_ctx = NULL;
  return links;
}

static hr2d_linkset *linked(hr2d_hierarchy *h, hr2d_linkset *coarse, unsigned threads) {
  return linked_with(h, coarse, threads, 0);
}

enum { SQUARE = 16 };

/* A link with its block, to be sorted. */
typedef struct whole_link {
  hr2d_link link;
  double block[SQUARE];
  int distant;
} whole_link;

static int by_pair(const void *a, const void *b) {
  const hr2d_pair p = ((const whole_link *)a)->link.pair;
  const hr2d_pair q = ((const whole_link *)b)->link.pair;
  if (p.first != q.first) return p.first < q.first ? -1 : 1;
  return (p.second > q.second) - (p.second < q.second);
}

static whole_link *sorted_links(const hr2d_linkset *links) {
  const size_t count = (size_t)links->store.count;
  whole_link *all = calloc(count, sizeof *all);
  ck_assert_uint_eq(links->blocks.links, count);
  for (size_t k = 0; k < count; k++) {
    all[k].link = hr2di_store_link(&links->store, k);
    const hr2di_stored_block block = hr2di_link_blocks_at(&links->blocks, k);
    hr2di_join_block(&block, 1, all[k].block);
    all[k].distant = links->blocks.distant[k];
  }
  qsort(all, count, sizeof *all, by_pair);
  return all;
}

static int same_links(const hr2d_linkset *a, const hr2d_linkset *b) {
  if (a->store.count != b->store.count) return 0;
  whole_link *x = sorted_links(a), *y = sorted_links(b);
  const int same = memcmp(x, y, (size_t)a->store.count * sizeof *x) == 0;
  free(x);
  free(y);
  return same;
}

static void check_counts(const hr2d_linkset *fresh, const hr2d_linkset *taken) {
  const hr2d_refine_counts f = hr2d_linkset_counts(fresh), t = hr2d_linkset_counts(taken);
  ck_assert_uint_eq(f.elements, t.elements);
  ck_assert_uint_eq(f.links, t.links);
  ck_assert_uint_eq(f.limited_links, t.limited_links);
  ck_assert_uint_eq(f.partial_links, t.partial_links);
  ck_assert_uint_gt(t.partial_links, 0);
  ck_assert_uint_gt(t.links, t.limited_links);
}

/* Turns a bit of block 5: of its leading part, or of the rest where there is one. */
static void spoil(hr2di_link_blocks *b) {
  const hr2di_stored_block block = hr2di_link_blocks_at(b, 5);
  const char *from = b->rest ? b->rest : b->value, *at = b->rest ? block.rest : block.value;
  ((unsigned char *)(b->rest ? b->rest : b->value))[at - from] ^= 1;
}

/* Links and blocks that are taken over are those that would be made, bit for bit: in one part,
   and in two. */
START_TEST(links_are_taken_over) {
  const unsigned threads = _i % 2 == 0 ? 1 : 3;
  const int single = _i / 2 % 2;
  hr2d_scene *scene = squares(120);
  hr2d_hierarchy *h = trees(scene, _i / 4 == 0 ? 4 : 3), *divided = NULL;
  unsigned char *depth = calloc(hr2d_scene_patches(scene), 1);
  depth[1] = depth[9] = depth[50] = 1;
  hr2d_linkset *coarse = linked_with(h, NULL, threads, single);
  hr2d_linkset *wrong = linked_with(h, NULL, 1, single);
  ck_assert_int_eq(hr2di_refine_marked(h, depth, 0, NULL, &divided), HR2D_OK);
  ck_assert_uint_eq(wrong->blocks.lead, h->order);
  spoil(&wrong->blocks);
  hr2d_linkset *fresh = linked_with(divided, NULL, 1, single);
  hr2d_linkset *taken = linked_with(divided, coarse, threads, single);
  hr2d_linkset *off = linked_with(divided, wrong, 1, single);
  ck_assert(same_links(fresh, taken));
  ck_assert(!same_links(fresh, off));
  check_counts(fresh, taken);
  ck_assert_uint_gt(taken->blocks.kernels, 0);
  ck_assert_uint_lt(4 * taken->blocks.kernels, fresh->blocks.kernels);
  ck_assert_uint_eq(coarse->blocks.links, 0);
  hr2d_linkset_destroy(off);
  hr2d_linkset_destroy(wrong);
  hr2d_linkset_destroy(taken);
  hr2d_linkset_destroy(fresh);
  hr2d_linkset_destroy(coarse);
  hr2d_hierarchy_destroy(divided);
  hr2d_hierarchy_destroy(h);
  free(depth);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The same with trees of several levels, some leaves of which are divided: only pairs with
   these, or above them, are refined again. */
START_TEST(leaves_of_deep_trees_are_divided) {
  hr2d_scene *scene = squares(80);
  randoms r = randoms_stream(test_seed(), 15);
  hr2d_hierarchy *whole = trees(scene, 4), *h = NULL, *divided = NULL;
  unsigned char *depth = calloc(whole->elements, 1);
  for (size_t k = 0; k < whole->elements; k++)
    depth[k] = (unsigned char)(1 + 3 * (whole->element[k].length > 0.5));
  ck_assert_int_eq(hr2di_refine_marked(whole, depth, 0, NULL, &h), HR2D_OK);
  unsigned char *deeper = calloc(h->elements, 1);
  for (size_t k = 0; k < h->elements; k++)
    if (!h->element[k].child && random_below(&r, 12) == 0)
      deeper[k] = (unsigned char)(1 + random_below(&r, 2));
  ck_assert_int_eq(hr2di_refine_marked(h, deeper, 0, NULL, &divided), HR2D_OK);
  ck_assert_uint_gt(divided->elements, h->elements);
  hr2d_linkset *coarse = linked(h, NULL, 1), *fresh = linked(divided, NULL, 1);
  const uint64_t before = hr2d_linkset_counts(coarse).oracle_calls;
  hr2d_linkset *taken = linked(divided, coarse, 3);
  ck_assert(same_links(fresh, taken));
  check_counts(fresh, taken);
  const uint64_t again = hr2d_linkset_counts(taken).oracle_calls - before;
  printf("%llu pairs are looked at again, of %llu\n", (unsigned long long)again,
         (unsigned long long)hr2d_linkset_counts(fresh).oracle_calls);
  ck_assert_uint_lt(2 * again, hr2d_linkset_counts(fresh).oracle_calls);
  hr2d_linkset_destroy(taken);
  hr2d_linkset_destroy(fresh);
  hr2d_linkset_destroy(coarse);
  hr2d_hierarchy_destroy(divided);
  hr2d_hierarchy_destroy(h);
  hr2d_hierarchy_destroy(whole);
  free(deeper);
  free(depth);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Budgets hold for the links that are taken over and those that are made. */
START_TEST(budgets_count_links_taken_over) {
  hr2d_scene *scene = squares(60);
  hr2d_hierarchy *h = trees(scene, 4), *divided = NULL;
  unsigned char *depth = calloc(hr2d_scene_patches(scene), 1);
  depth[2] = 2;
  hr2d_linkset *coarse = linked(h, NULL, 1), *links = NULL;
  ck_assert_int_eq(hr2di_refine_marked(h, depth, 0, NULL, &divided), HR2D_OK);
  hr2d_linkset *fresh = linked(divided, NULL, 1);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 0.5;
  options.max_level = UINT32_MAX;
  options.max_links = fresh->store.count - 1 + (uint64_t)_i;
  ck_assert_int_eq(hr2d_linkset_create(divided, hr2di_admissibility_oracle(), NULL,
                                       hr2di_admissibility_fixed_leaves(), NULL, &links),
                   HR2D_OK);
  ck_assert_int_eq(hr2di_reuse_links(links, coarse, &(hr2di_refine_how){0}, &options),
                   _i == 0 ? HR2D_EMAX_LINKS : HR2D_OK);
  hr2d_linkset_destroy(links);
  hr2d_linkset_destroy(fresh);
  hr2d_linkset_destroy(coarse);
  hr2d_hierarchy_destroy(divided);
  hr2d_hierarchy_destroy(h);
  free(depth);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The largest relative difference of averages. */
static double max_off(const hr2d_solution *a, const hr2d_solution *b, size_t patches) {
  double max = 0;
  for (size_t k = 0; k < patches; k++) {
    const double x = hr2d_solution_average(a, k, 0), y = hr2d_solution_average(b, k, 0);
    max = fmax(max, fabs(x - y) / y);
  }
  return max;
}

/* Halving all leaves took 22,000 elements for 1e-3, and reached 2e-5. */
START_TEST(few_elements_suffice) {
  if (test_multiplier() < 1) return; /* sanitizers take minutes */
  hr2d_scene *scene = squares(1000);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_account account, finer;
  hr2d_solution *solution = NULL, *reference = NULL;
  target.error = 1e-3;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &account), HR2D_OK);
  target.error = 1e-4;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &reference, &finer), HR2D_OK);
  const double error = max_off(solution, reference, hr2d_scene_patches(scene));
  printf("%llu solves, %llu elements, error %.1e, about %.1e, at most %.1e\n",
         (unsigned long long)account.solves, (unsigned long long)account.elements, error,
         account.average.estimate, account.average.bound);
  ck_assert_uint_gt(account.solves, 1);
  ck_assert_uint_lt(account.elements, 11000);
  ck_assert_double_le(error, 1e-3);
  ck_assert_double_le(error, account.average.bound + finer.average.bound);
  hr2d_solution_destroy(reference);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Solves on whole patches or so, and estimates the error. */
static void estimate(const hr2d_scene *scene, hr2di_resolution *f, hr2di_graded *answer,
                     hr2di_error_pair *errors) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2di_message message;
  hr2di_survey survey;
  hr2di_watch watch;
  const int skip_bound = f->skip_bound;
  target.points = 1;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "refine");
  ck_assert_int_eq(hr2di_strategy_survey(scene, NULL, 1, &watch, &survey), HR2D_OK);
  *f = hr2di_strategy_for(scene, &survey, 1e-4, &target, NULL);
  f->skip_bound = skip_bound;
  ck_assert_int_eq(hr2di_graded_refine(answer, scene, f, &target, &message), HR2D_OK);
  ck_assert_int_eq(hr2di_graded_solve(answer, f, &target, &message), HR2D_OK);
  ck_assert_int_eq(hr2di_error_estimate(answer, f, &target, errors, &message), HR2D_OK);
  ck_assert(answer->unbounded == skip_bound);
}

/* A bound that nobody waited for is the same when it is asked for, and so is what to divide. */
START_TEST(bounds_may_come_later) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_scene *scene = squares(140);
  hr2di_resolution f = {.skip_bound = 0}, skip_bound = {.skip_bound = 1};
  hr2di_graded whole, part;
  hr2di_error_pair all, some;
  hr2di_message message;
  target.points = 1;
  estimate(scene, &f, &whole, &all);
  estimate(scene, &skip_bound, &part, &some);
  ck_assert(isfinite(all.average.bound) && isfinite(all.irradiance_sup.bound));
  ck_assert(isinf(some.average.bound) && isinf(some.irradiance_sup.bound));
  ck_assert(some.average.estimate <= all.average.estimate);
  ck_assert(some.irradiance.estimate <= all.irradiance.estimate);
  ck_assert_int_eq(memcmp(whole.depth, part.depth, whole.hierarchy->elements), 0);
  skip_bound.skip_bound = skip_bound.a_posteriori = 0;
  ck_assert_int_eq(hr2di_error_estimate(&part, &skip_bound, &target, &some, &message), HR2D_OK);
  ck_assert_int_eq(memcmp(&some, &all, sizeof all), 0);
  hr2di_graded_clear(&part);
  hr2di_graded_clear(&whole);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The order may rise on divided elements, which keep what they know. */
START_TEST(order_rises_on_divided_elements) {
  const hr2d_target target = HR2D_TARGET_INIT;
  hr2d_scene *scene = squares(140);
  hr2di_resolution f = {.skip_bound = 1};
  hr2di_graded answer, finer;
  hr2di_error_pair before, after;
  hr2di_message message;
  estimate(scene, &f, &answer, &before);
  f.order += 2;
  ck_assert_int_eq(hr2di_graded_divide(&finer, &answer, &f, &target, &message), HR2D_OK);
  ck_assert_int_eq(hr2di_graded_solve(&finer, &f, &target, &message), HR2D_OK);
  ck_assert_int_eq(hr2di_error_estimate(&finer, &f, &target, &after, &message), HR2D_OK);
  printf("order %u, %zu elements: %.1e; order %u, %zu elements: %.1e\n",
         answer.hierarchy->order, answer.hierarchy->elements, before.average.estimate,
         finer.hierarchy->order, finer.hierarchy->elements, after.average.estimate);
  ck_assert_uint_eq(finer.hierarchy->order, f.order);
  ck_assert_uint_gt(finer.hierarchy->elements, answer.hierarchy->elements);
  ck_assert_double_lt(after.average.estimate, 0.1 * before.average.estimate);
  hr2di_graded_clear(&finer);
  hr2di_graded_clear(&answer);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Where the budget ends before the target is reached, the answer has a bound. */
START_TEST(answers_have_bounds) {
  if (test_multiplier() < 1) return;
  hr2d_scene *scene = squares(560);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_account account, all;
  hr2d_solution *solution = NULL, *reference = NULL;
  target.error = 1e-3;
  target.points = 1;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &reference, &all), HR2D_OK);
  ck_assert_uint_gt(all.solves, 1);
  target.max_elements = all.elements - 1;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &account), HR2D_EACCURACY);
  const double error = max_off(solution, reference, hr2d_scene_patches(scene));
  printf("error %.1e, about %.1e, at most %.1e\n", error, account.average.estimate,
         account.average.bound);
  ck_assert_double_gt(account.average.estimate, 1e-3);
  ck_assert(isfinite(account.average.bound) && isfinite(account.irradiance.bound));
  ck_assert(isfinite(account.sup.bound) && isfinite(account.irradiance_sup.bound));
  ck_assert_double_le(error, account.average.bound + all.average.bound);
  hr2d_solution_destroy(reference);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

enum { POINTS = 2000, SEGMENTS = 200 };

static int is_in_spans(const hr2di_point_grid *g, hr2d_segment s, uint32_t number) {
  for (uint32_t row = 0; row < g->rows; row++) {
    const hr2di_grid_span span = hr2di_point_grid_strip(g, row, s);
    const size_t start = (size_t)row * g->columns;
    for (uint32_t k = g->first[start + span.from]; k < g->first[start + span.to]; k++)
      if (g->number[k] == number) return 1;
  }
  return 0;
}

static size_t count_in_spans(const hr2di_point_grid *g, hr2d_segment s) {
  size_t count = 0;
  for (uint32_t row = 0; row < g->rows; row++) {
    const hr2di_grid_span span = hr2di_point_grid_strip(g, row, s);
    const size_t start = (size_t)row * g->columns;
    count += g->first[start + span.to] - g->first[start + span.from];
  }
  return count;
}

/* Short segments in all directions, along the axes, too; every fourth point is on a line. */
START_TEST(strips_have_their_points) {
  static hr2d_point point[POINTS];
  const hr2d_allocator alloc = hr2di_alloc_default();
  randoms r = randoms_stream(test_seed(), 23);
  hr2di_point_grid g;
  size_t inside = 0, looked_at = 0;
  for (int k = 0; k < POINTS; k++)
    point[k] = (hr2d_point){random_unit(&r), k % 4 ? 0.3 * random_unit(&r) : 0.125};
  ck_assert_int_eq(hr2di_point_grid_init(&g, point, POINTS, &alloc, NULL), HR2D_OK);
  for (int k = 0; k < SEGMENTS; k++) {
    const hr2d_point a = {random_unit(&r), random_unit(&r)};
    const double angle = k % 5 ? 6.3 * random_unit(&r) : 1.5707963267948966 * (k % 4);
    const hr2d_segment s = {a, plane_polar(a, 0.02, angle)};
    for (uint32_t m = 0; m < POINTS; m++) {
      const double ux = s.b.x - s.a.x, uy = s.b.y - s.a.y;
      const double at =
          ((point[m].x - a.x) * ux + (point[m].y - a.y) * uy) / (ux * ux + uy * uy);
      if (!(at > 0 && at < 1)) continue;
      ck_assert(is_in_spans(&g, s, m));
      inside++;
    }
    looked_at += count_in_spans(&g, s);
  }
  printf("%zu points in strips, %zu looked at, of %d\n", inside, looked_at, POINTS * SEGMENTS);
  ck_assert_uint_gt(inside, SEGMENTS);
  ck_assert_uint_lt(looked_at, POINTS * SEGMENTS / 4);
  hr2di_point_grid_clear(&g, &alloc);
}
END_TEST

/* Equal points, and points on one line, have one cell across. */
START_TEST(grids_may_be_flat) {
  static const hr2d_point point[] = {{1, 2}, {1, 2}, {1, 2}, {1, 5}};
  const hr2d_allocator alloc = hr2di_alloc_default();
  const hr2d_segment across = {{0, 0}, {2, 0}}, beside = {{3, 0}, {4, 0}};
  for (size_t count = 1; count <= 4; count++) {
    hr2di_point_grid g;
    ck_assert_int_eq(hr2di_point_grid_init(&g, point, count, &alloc, NULL), HR2D_OK);
    ck_assert_uint_eq(count_in_spans(&g, across), count);
    ck_assert_uint_eq(count_in_spans(&g, beside), 0);
    hr2di_point_grid_clear(&g, &alloc);
  }
}
END_TEST

TEST_SUITE("error shares") {
  ADD_TESTS("division", leaves_are_halved_so_often, few_elements_suffice);
  REPEAT_TESTS(8, "links", links_are_taken_over);
  ADD_TESTS("deep", leaves_of_deep_trees_are_divided);
  REPEAT_TESTS(2, "links", budgets_count_links_taken_over);
  ADD_TESTS("bounds", bounds_may_come_later, order_rises_on_divided_elements,
            answers_have_bounds);
  ADD_TESTS("grid", strips_have_their_points, grids_may_be_flat);
}
