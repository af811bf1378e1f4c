/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/links.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

test_links test_make_links(hr2d_scene *scene, const hr2d_oracle *oracle, void *oracle_ctx,
                           const hr2d_policy *policy, void *policy_ctx) {
  test_links t = {.scene = scene};
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &t.hierarchy), HR2D_OK);
  ck_assert_int_eq(
      hr2d_linkset_create(t.hierarchy, oracle, oracle_ctx, policy, policy_ctx, &t.links),
      HR2D_OK);
  return t;
}

void test_free_links(test_links *t) {
  hr2d_linkset_destroy(t->links);
  hr2d_hierarchy_destroy(t->hierarchy);
  hr2d_scene_destroy(t->scene);
}

hr2d_refine_options test_options(double epsilon, unsigned max_level) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon != 0 ? epsilon : HR2D_EPSILON_ZERO;
  options.max_level = max_level ? max_level : HR2D_NO_SUBDIVISION;
  return options;
}

hr2d_refine_options test_epsilon(double epsilon) {
  return test_options(epsilon, HR2D_DEFAULT_MAX_LEVEL);
}

void test_refine(test_links *t, double epsilon, unsigned max_level) {
  const hr2d_refine_options options = test_options(epsilon, max_level);
  ck_assert_msg(hr2d_refine(t->links, &options) == HR2D_OK, "%s",
                hr2d_linkset_message(t->links));
}

void test_refuse(const test_links *t, const hr2d_refine_options *options, hr2d_status status,
                 const char *phrase) {
  const hr2d_hierarchy_counts before = hr2d_hierarchy_count(t->hierarchy);
  const uint64_t links = hr2d_linkset_size(t->links);
  ck_assert_int_eq(hr2d_refine(t->links, options), status);
  ck_assert_str_ne(hr2d_linkset_message(t->links), "");
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t->links), phrase));
  const hr2d_hierarchy_counts after = hr2d_hierarchy_count(t->hierarchy);
  ck_assert_uint_eq(before.elements, after.elements);
  ck_assert_uint_eq(before.leaves, after.leaves);
  ck_assert_uint_eq(before.levels, after.levels);
  ck_assert_uint_eq(links, hr2d_linkset_size(t->links));
}

hr2d_solution *test_solve_by(const test_links *t, const hr2d_solve_options *options) {
  hr2d_solution *solution = NULL;
  ck_assert_msg(hr2d_solve(t->links, options, &solution) == HR2D_OK, "%s",
                hr2d_linkset_message(t->links));
  return solution;
}

hr2d_solution *test_solve(const test_links *t, int closure) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.closure = closure ? HR2D_CLOSURE_ON : HR2D_CLOSURE_OFF;
  return test_solve_by(t, &options);
}

double test_average_error(const test_links *t, const hr2d_solution *solution,
                          const test_table *table, size_t row) {
  const char *name = test_cell(table, row, "scene");
  double worst = 0;
  for (size_t k = 0; k < hr2d_scene_patches(t->scene); k++) {
    ck_assert_str_eq(test_cell(table, row + k, "scene"), name);
    const double expected = test_number(table, row + k, "avgB");
    worst = fmax(worst, fabs(hr2d_solution_average(solution, k, 0) / expected - 1));
  }
  return worst;
}

enum { ROW = 5 };

static int by_bits(const void *left, const void *right) {
  return memcmp(left, right, ROW * sizeof(double));
}

double *test_sorted_links(const test_links *t, size_t *count) {
  const hr2d_element *e = hr2d_hierarchy_elements(t->hierarchy);
  const size_t links = (size_t)hr2d_linkset_size(t->links);
  double *row = malloc((links + 1) * ROW * sizeof *row);
  ck_assert_ptr_nonnull(row);
  *count = 0;
  for (size_t k = 0; k < links; k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k);
    const double length = hr2d_scene_unit(t->scene) * e[link.pair.first].length;
    if (link.exchange_area <= 1e-25 * length) continue;
    const double all[ROW] = {e[link.pair.first].centre.x, e[link.pair.first].centre.y,
                             e[link.pair.second].centre.x, e[link.pair.second].centre.y,
                             link.exchange_area};
    memcpy(row + ROW * (*count)++, all, sizeof all);
  }
  qsort(row, *count, ROW * sizeof *row, by_bits);
  return row;
}

void test_same_links(const test_links *one, const test_links *other) {
  size_t n, m;
  double *first = test_sorted_links(one, &n), *second = test_sorted_links(other, &m);
  ck_assert_uint_eq(n, m);
  ck_assert_mem_eq(first, second, n * ROW * sizeof *first);
  free(first);
  free(second);
}

hr2d_status test_collect(void *ctx, const hr2d_link *links, size_t count) {
  test_collected *c = ctx;
  c->link = realloc(c->link, (size_t)(c->count + count) * sizeof *c->link);
  ck_assert_ptr_nonnull(c->link);
  memcpy(c->link + c->count, links, count * sizeof *links);
  c->count += count;
  return c->stop_at && c->count >= c->stop_at ? HR2D_STOPPED : HR2D_OK;
}

void test_expect_collected(const test_links *t, const test_collected *c) {
  ck_assert_uint_eq(c->count, hr2d_linkset_size(t->links));
  for (uint64_t k = 0; k < c->count; k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k);
    ck_assert_mem_eq(&link, &c->link[k], sizeof link);
  }
}

void test_same_counts(const hr2d_refine_counts *one, const hr2d_refine_counts *other) {
  ck_assert_uint_eq(one->elements, other->elements);
  ck_assert_uint_eq(one->leaves, other->leaves);
  ck_assert_uint_eq(one->links, other->links);
  ck_assert_uint_eq(one->limited_links, other->limited_links);
  ck_assert_uint_eq(one->oracle_calls, other->oracle_calls);
  ck_assert_uint_eq(one->facing_tests, other->facing_tests);
  ck_assert_uint_eq(one->visibility_tests, other->visibility_tests);
  ck_assert_uint_eq(one->partial_links, other->partial_links);
  ck_assert_uint_eq(one->blocked_pairs, other->blocked_pairs);
  ck_assert_uint_eq(one->dark_pairs, other->dark_pairs);
  ck_assert_uint_eq(one->exchange_areas, other->exchange_areas);
  ck_assert_uint_eq(one->levels, other->levels);
}

hr2d_solution *test_solve_to(const hr2d_scene *scene, double error, unsigned threads,
                             hr2d_account *account) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = error;
  target.threads = threads;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
  ck_assert_msg(!status, "%s: %s", hr2d_strerror(status), account->reason);
  return solution;
}
