/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ProjectKernel: N and L of the reference tables, invariants of every link set, and
   refinements that end early. */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/neumaier-sum.h"
#include "support/elements.h"
#include "support/support.h"

static uint64_t leaves_of_patch(const hr2d_hierarchy *hierarchy, uint32_t patch) {
  const hr2d_element *element = hr2d_hierarchy_elements(hierarchy);
  uint64_t leaves = 0;
  for (uint64_t k = 0; k < hr2d_hierarchy_count(hierarchy).elements; k++)
    leaves += element[k].patch == patch && !element[k].child;
  return leaves;
}

static void check_row(const test_table *table, size_t row, int ordered) {
  const char *oracle = test_cell(table, row, "oracle");
  test_links t =
      test_make_links(test_named_scene(test_cell(table, row, "scene")),
                      strcmp(oracle, "maxA/r") == 0 ? hr2d_oracle_size() : hr2d_oracle_size2(),
                      NULL, hr2d_policy_find(test_cell(table, row, "algorithm")), NULL);
  hr2d_refine_options options = test_epsilon(test_number(table, row, "eps"));
  options.ordered = ordered;
  hr2d_refine_counts counts;
  ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_OK);
  ck_assert_uint_eq(counts.elements, (uint64_t)test_number(table, row, "N_nodes"));
  ck_assert_uint_eq(counts.leaves, (uint64_t)test_number(table, row, "N_leaves"));
  ck_assert_uint_eq(counts.links, (uint64_t)test_number(table, row, "L"));
  ck_assert_uint_eq(counts.oracle_calls, (uint64_t)test_number(table, row, "visited_pairs"));
  ck_assert_uint_eq(counts.levels, (uint64_t)test_number(table, row, "max_level"));
  ck_assert_uint_eq(leaves_of_patch(t.hierarchy, 0),
                    (uint64_t)test_number(table, row, "leaves_patch1"));
  ck_assert_uint_eq(leaves_of_patch(t.hierarchy, 1),
                    (uint64_t)test_number(table, row, "leaves_patch2"));
  ck_assert_uint_eq(counts.limited_links, 0);
  test_free_links(&t);
}

static void check_table(const char *file, int ordered) {
  test_table table = test_read_table(file);
  const double max = 1e8 * test_multiplier();
  size_t checked = 0;
  for (size_t row = 1; row < table.rows; row++) {
    if (test_number(&table, row, "L") > max) continue;
    check_row(&table, row, ordered);
    checked++;
  }
  ck_assert_uint_ge(checked, 20);
  test_free_table(&table);
}

START_TEST(counts_of_size) {
  check_table("counts_maxAr_pow2.csv", 0);
}
END_TEST

START_TEST(counts_of_size2) {
  check_table("counts_maxAr_squared.csv", 0);
}
END_TEST

START_TEST(counts_of_both_orders) {
  check_table("counts_maxAr_both_calls.csv", 1);
}
END_TEST

/* The exchange areas of the links between two patches add up to that of the patches. */
static void check_transport(const test_links *t) {
  const hr2d_element *element = hr2d_hierarchy_elements(t->hierarchy);
  const size_t n = hr2d_scene_patches(t->scene);
  const int directed = hr2d_linkset_directed(t->links);
  hr2di_sum *sum = calloc(n * n, sizeof *sum);
  for (uint64_t k = 0; k < hr2d_linkset_size(t->links); k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k);
    ck_assert_double_ge(link.exchange_area, 0);
    const size_t i = element[link.pair.first].patch, j = element[link.pair.second].patch;
    hr2di_sum_add(&sum[i * n + j], link.exchange_area);
    if (!directed) hr2di_sum_add(&sum[j * n + i], link.exchange_area);
  }
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      const hr2d_segment s = hr2d_scene_segment(t->scene, i),
                         u = hr2d_scene_segment(t->scene, j);
      ck_assert_double_eq_tol(hr2di_sum_total(&sum[i * n + j]),
                              i == j ? 0 : hr2d_exchange_area(&s, &u), 1e-14);
    }
  free(sum);
}

static const double clipped_pair[][6] = {
    {0, 0, 1, 0, 1, .5},       /* a floor */
    {1.5, -0.75, 2, 1, 0, .5}, /* a wall that begins below its horizon */
};

START_TEST(links_exchange_what_patches_do) {
  const char *const name[] = {"par0.1", "orth1", "orth_touch_rho0.7", "square_rho0.9"};
  const hr2d_policy *const policy[] = {hr2d_policy_original(), hr2d_policy_modified()};
  for (size_t k = 0; k < 8; k++) {
    test_links t =
        test_make_links(test_named_scene(name[k / 2]), NULL, NULL, policy[k % 2], NULL);
    hr2d_refine_options options = test_epsilon(0.1);
    options.max_level = 12;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    check_transport(&t);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(clipped_links_exchange_what_patches_do) {
  test_links t = test_make_links(test_scene(clipped_pair, 2), NULL, NULL, NULL, NULL);
  const hr2d_refine_options options = test_epsilon(0.01);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  check_transport(&t);
  const hr2d_refine_counts counts = hr2d_linkset_counts(t.links);
  ck_assert_uint_gt(counts.facing_tests, 0);
  /* The part below the horizon is not linked at all. */
  for (uint64_t k = 0; k < hr2d_linkset_size(t.links); k++)
    ck_assert_double_gt(hr2d_linkset_get(t.links, k).exchange_area, 0);
  test_free_links(&t);
}
END_TEST

/* A room of many walls with a horizon here and there. */
static hr2d_scene *many_walls(void) {
  double wall[64][6];
  for (size_t k = 0; k < 64; k++) {
    const double from = 0.09 * (double)k, to = 0.09 * (double)(k + 1);
    const double w[6] = {cos(from), sin(from), cos(to), sin(to), k == 3, 0.5};
    memcpy(wall[k], w, sizeof w);
  }
  return test_scene((const double(*)[6])wall, 64);
}

/* Any number of threads counts the same, and leaves the same hierarchy behind. */
static void check_threads(hr2d_scene *(*make)(void), const hr2d_oracle *oracle,
                          const hr2d_policy *policy, double epsilon) {
  test_links t[3];
  hr2d_refine_counts counts[3];
  const unsigned threads[] = {1, 2, 5};
  for (size_t k = 0; k < 3; k++) {
    t[k] = test_make_links(make(), oracle, NULL, policy, NULL);
    hr2d_refine_options options = test_epsilon(epsilon);
    options.threads = threads[k];
    options.max_level = 12;
    ck_assert_int_eq(hr2d_refine_count(t[k].links, &options, &counts[k]), HR2D_OK);
    test_same_counts(&counts[0], &counts[k]);
    ck_assert_mem_eq(hr2d_hierarchy_elements(t[0].hierarchy),
                     hr2d_hierarchy_elements(t[k].hierarchy),
                     (size_t)counts[0].elements * sizeof(hr2d_element));
    options.max_links = counts[0].links - 1;
    ck_assert_int_eq(hr2d_refine_count(t[k].links, &options, &counts[k]), HR2D_EMAX_LINKS);
    options.max_links++;
    ck_assert_int_eq(hr2d_refine_count(t[k].links, &options, &counts[k]), HR2D_OK);
  }
  /* The plain refinement is the measure. */
  test_links stored = test_make_links(make(), oracle, NULL, policy, NULL);
  hr2d_refine_options options = test_epsilon(epsilon);
  options.max_level = 12;
  ck_assert_int_eq(hr2d_refine(stored.links, &options), HR2D_OK);
  counts[0].exchange_areas = hr2d_linkset_size(stored.links);
  const hr2d_refine_counts measure = hr2d_linkset_counts(stored.links);
  test_same_counts(&counts[0], &measure);
  test_free_links(&stored);
  for (size_t k = 0; k < 3; k++) test_free_links(&t[k]);
}

static hr2d_scene *par_near(void) {
  return test_named_scene("par0.1");
}

static hr2d_scene *clipped(void) {
  return test_scene(clipped_pair, 2);
}

START_TEST(threads_count_the_same) {
  check_threads(par_near, NULL, NULL, 0.01);
  check_threads(par_near, hr2d_oracle_size2(), hr2d_policy_modified(), 1e-3);
  check_threads(many_walls, NULL, NULL, 0.1);
  check_threads(many_walls, hr2d_oracle_bf(), NULL, 1e-3);
  check_threads(clipped, NULL, NULL, 2e-3);
}
END_TEST

START_TEST(facing_pairs_are_never_tested_again) {
  test_links t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  const hr2d_refine_options options = test_epsilon(0.05);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).facing_tests, 0);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).exchange_areas, hr2d_linkset_size(t.links));
  test_free_links(&t);
}
END_TEST

START_TEST(patches_that_see_nothing_have_no_links) {
  /* back to back */
  const double backs[][6] = {{0, 0, 1, 0, 1, .5}, {1, 0, 0, 0, 1, .5}};
  test_links t = test_make_links(test_scene(backs, 2), NULL, NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_refine(t.links, NULL), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 0);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).oracle_calls, 0);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).elements, 2);
  test_free_links(&t);
}
END_TEST

START_TEST(stored_streamed_and_counted_agree) {
  const hr2d_refine_options options = test_epsilon(0.03);
  test_links stored =
      test_make_links(test_named_scene("square_rho0.9"), NULL, NULL, NULL, NULL);
  test_links other = test_make_links(test_named_scene("square_rho0.9"), NULL, NULL, NULL, NULL);
  hr2d_refine_counts streamed, counted;
  test_collected c = {0};
  ck_assert_int_eq(hr2d_refine(stored.links, &options), HR2D_OK);
  ck_assert_int_eq(hr2d_refine_visit(other.links, &options, test_collect, &c, &streamed),
                   HR2D_OK);
  ck_assert_int_eq(hr2d_refine_count(other.links, &options, &counted), HR2D_OK);
  const hr2d_refine_counts of_set = hr2d_linkset_counts(stored.links);
  test_expect_collected(&stored, &c);
  test_same_counts(&streamed, &of_set);
  ck_assert_uint_eq(counted.exchange_areas, 0);
  counted.exchange_areas = of_set.exchange_areas;
  test_same_counts(&counted, &of_set);
  ck_assert_uint_gt(counted.limited_links, 0); /* touching walls */
  ck_assert_uint_eq(counted.levels, HR2D_DEFAULT_MAX_LEVEL);
  free(c.link);
  test_free_links(&stored);
  test_free_links(&other);
}
END_TEST

static int by_bits(const void *left, const void *right) {
  return memcmp(left, right, 5 * sizeof(double));
}

/* All links, by the geometry of their elements, which does not depend on numbering. */
static double *sorted_geometry(const test_links *t, size_t *count) {
  const hr2d_element *e = hr2d_hierarchy_elements(t->hierarchy);
  *count = (size_t)hr2d_linkset_size(t->links);
  double *row = malloc((*count + 1) * 5 * sizeof *row);
  for (size_t k = 0; k < *count; k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k);
    const double all[5] = {e[link.pair.first].centre.x, e[link.pair.first].centre.y,
                           e[link.pair.second].centre.x, e[link.pair.second].centre.y,
                           link.exchange_area};
    memcpy(row + 5 * k, all, sizeof all);
  }
  qsort(row, *count, 5 * sizeof *row, by_bits);
  return row;
}

START_TEST(multigrid_ends_where_one_step_does) {
  const char *const name[] = {"par0.1", "orth_touch_rho0.7", "square_rho0.9"};
  for (size_t k = 0; k < 3; k++) {
    test_links once = test_make_links(test_named_scene(name[k]), NULL, NULL, NULL, NULL);
    test_links grid = test_make_links(test_named_scene(name[k]), NULL, NULL, NULL, NULL);
    hr2d_refine_options options = test_epsilon(1);
    options.max_level = 12;
    uint64_t areas = 0;
    for (; options.epsilon >= 1. / 32; options.epsilon /= 2) {
      ck_assert_int_eq(hr2d_refine(grid.links, &options), HR2D_OK);
      areas = hr2d_linkset_counts(grid.links).exchange_areas;
    }
    options.epsilon *= 2;
    ck_assert_int_eq(hr2d_refine(once.links, &options), HR2D_OK);
    size_t n, m;
    double *first = sorted_geometry(&once, &n), *second = sorted_geometry(&grid, &m);
    ck_assert_uint_eq(n, m);
    ck_assert_mem_eq(first, second, n * 5 * sizeof *first);
    ck_assert_uint_eq(hr2d_linkset_counts(once.links).limited_links,
                      hr2d_linkset_counts(grid.links).limited_links);
    ck_assert_uint_eq(hr2d_linkset_counts(once.links).elements,
                      hr2d_linkset_counts(grid.links).elements);
    /* The links of a step that stays acceptable are not integrated again. */
    ck_assert_int_eq(hr2d_refine(grid.links, &options), HR2D_OK);
    ck_assert_uint_eq(hr2d_linkset_counts(grid.links).exchange_areas - areas,
                      hr2d_linkset_counts(grid.links).limited_links);
    free(first);
    free(second);
    test_free_links(&once);
    test_free_links(&grid);
  }
}
END_TEST

START_TEST(level_limit_acts_and_says_so) {
  test_links t = test_make_links(test_named_scene("orth_touch_rho0.7"), NULL, NULL, NULL, NULL);
  hr2d_refine_options options = test_epsilon(0.25);
  options.max_level = 6;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).levels, 6);
  ck_assert_uint_gt(hr2d_linkset_counts(t.links).limited_links, 0);
  /* A shallower limit is obeyed on trees that are deeper already. */
  test_links u = {t.scene, t.hierarchy, NULL};
  ck_assert_int_eq(hr2d_linkset_create(t.hierarchy, NULL, NULL, NULL, NULL, &u.links), HR2D_OK);
  options.max_level = 3;
  hr2d_refine_counts counts;
  ck_assert_int_eq(hr2d_refine_count(u.links, &options, &counts), HR2D_OK);
  test_links fresh =
      test_make_links(test_named_scene("orth_touch_rho0.7"), NULL, NULL, NULL, NULL);
  hr2d_refine_counts expected;
  ck_assert_int_eq(hr2d_refine_count(fresh.links, &options, &expected), HR2D_OK);
  ck_assert_uint_eq(counts.links, expected.links);
  ck_assert_uint_eq(counts.limited_links, expected.limited_links);
  hr2d_linkset_destroy(u.links);
  test_free_links(&fresh);
  test_free_links(&t);
}
END_TEST

START_TEST(elements_end_where_doubles_do) {
  /* At 1e15 a unit patch holds 9 doubles: level 3 is the last.  The third patch, which turns
     its back on them, makes the scene so large that it is taken. */
  const double far[][6] = {
      {1e15, 0, 1e15 + 1, 0, 1, .5}, {1e15 + 1, .1, 1e15, .1, 0, .5}, {0, 0, 0, 1, 0, 0}};
  test_links t = test_make_links(test_scene(far, 3), NULL, NULL, NULL, NULL);
  hr2d_refine_options options = test_epsilon(0.01);
  options.max_level = 1000;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).levels, 3);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).limited_links, 64);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 64);
  test_free_links(&t);
}
END_TEST

START_TEST(budgets_are_kept) {
  test_links t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  for (int again = 0; again < 2; again++) {
    hr2d_refine_options options = test_epsilon(1. / 64);
    options.max_links = 200000;
    test_refuse(&t, &options, HR2D_EMAX_LINKS, "200000 links");
    options.max_links = 0;
    options.max_elements = 4093;
    test_refuse(&t, &options, HR2D_EMAX_ELEMENTS, "4093 elements");
    options.max_elements = 0;
    options.max_bytes = 3000000;
    test_refuse(&t, &options, HR2D_EMAX_BYTES, "3000000 bytes");
    /* From links that are there already it must hold, too. */
    options = test_epsilon(0.5);
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  }
  hr2d_refine_options exact = test_epsilon(1. / 64);
  exact.max_links = 246082;
  exact.max_elements = 4094;
  exact.max_bytes = 6000000;
  ck_assert_int_eq(hr2d_refine(t.links, &exact), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 246082);
  test_free_links(&t);
}
END_TEST

START_TEST(options_without_meaning_are_refused) {
  test_links t = test_make_links(test_named_scene("par1"), NULL, NULL, NULL, NULL);
  hr2d_refine_options options = test_epsilon(NAN);
  test_refuse(&t, &options, HR2D_EINVAL, "epsilon");
  options.epsilon = -1;
  test_refuse(&t, &options, HR2D_EINVAL, "epsilon");
  options.epsilon = INFINITY;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 1);
  options.ordered = 1;
  test_refuse(&t, &options, HR2D_EINVAL, "directed");
  hr2d_refine_counts counts;
  ck_assert_int_eq(hr2d_refine_count(t.links, NULL, &counts), HR2D_ESTATE);
  test_free_links(&t);
}
END_TEST

typedef struct script {
  double value;       /* of the estimate */
  hr2d_status status; /* returned by every function */
  int calls, destroyed;
  unsigned split;       /* by the policy */
  unsigned limit_level; /* of the policy */
  hr2d_linkset *reenter;
  hr2d_status reentered;
} script;

static hr2d_status scripted_estimate(void *ctx, const hr2d_batch *batch, double *error) {
  script *s = ctx;
  s->calls++;
  for (size_t k = 0; k < batch->count; k++) error[k] = s->value;
  if (s->reenter) s->reentered = hr2d_refine(s->reenter, NULL);
  return s->status;
}

static void scripted_destroy(void *ctx) {
  ((script *)ctx)->destroyed++;
}

static const hr2d_oracle scripted_oracle = {.struct_size = sizeof(hr2d_oracle),
                                            .name = "scripted",
                                            .flags = HR2D_ORACLE_SYMMETRIC,
                                            .estimate = scripted_estimate,
                                            .destroy = scripted_destroy};

static hr2d_status scripted_split(void *ctx, const hr2d_batch *batch, unsigned char *split) {
  const script *s = ctx;
  memset(split, (int)s->split, batch->count);
  return s->status;
}

static hr2d_status scripted_limit(void *ctx, const hr2d_batch *batch, unsigned char *limited) {
  const script *s = ctx;
  for (size_t k = 0; k < batch->count; k++)
    limited[k] = hr2d_element_level(batch->hierarchy, batch->pairs[k].first) >= s->limit_level;
  return HR2D_OK;
}

static hr2d_status scripted_accept(void *ctx, const hr2d_batch *batch, const double *error,
                                   unsigned char *accepted) {
  (void)ctx;
  /* The opposite of the default: large errors are accepted. */
  for (size_t k = 0; k < batch->count; k++) accepted[k] = error[k] > batch->epsilon;
  return HR2D_OK;
}

static const hr2d_policy scripted_policy = {.struct_size = sizeof(hr2d_policy),
                                            .name = "scripted",
                                            .recursion_limit = scripted_limit,
                                            .preferred_subdivision = scripted_split,
                                            .destroy = scripted_destroy};

START_TEST(estimates_without_meaning_end_the_refinement) {
  const double bad[] = {NAN, -1, -HUGE_VAL};
  for (size_t k = 0; k < 3; k++) {
    script s = {.value = bad[k]};
    test_links t = test_make_links(test_named_scene("par1"), &scripted_oracle, &s, NULL, NULL);
    test_refuse(&t, NULL, HR2D_ECALLBACK, "oracle \"scripted\"");
    s.value = 0;
    ck_assert_int_eq(hr2d_refine(t.links, NULL), HR2D_OK);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(callbacks_end_the_refinement) {
  const hr2d_status end[] = {HR2D_STOPPED, HR2D_ERANGE};
  for (size_t k = 0; k < 2; k++) {
    script s = {.value = 0, .status = end[k]}, p = {.status = end[k]};
    test_links t =
        test_make_links(test_named_scene("par1"), &scripted_oracle, &s, &scripted_policy, &p);
    test_refuse(&t, NULL, end[k], "oracle");
    s.status = HR2D_OK;
    s.value = HUGE_VAL;
    test_refuse(&t, NULL, end[k], "policy");
    p.status = HR2D_OK;
    p.split = 3;
    test_refuse(&t, NULL, HR2D_ECALLBACK, "a subdivision of 3");
    test_free_links(&t);
    ck_assert_int_eq(s.destroyed, 1);
    ck_assert_int_eq(p.destroyed, 1);
  }
}
END_TEST

START_TEST(policies_decide) {
  /* Everything is refused, the second element is split down to the level of the
     policy: a limit on the first never acts, so the level of the options does. */
  script s = {.value = 1}, p = {.split = HR2D_SPLIT_SECOND, .limit_level = 1};
  test_links t =
      test_make_links(test_named_scene("par1"), &scripted_oracle, &s, &scripted_policy, &p);
  hr2d_refine_options options = test_epsilon(0.5);
  options.max_level = 5;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 32);
  ck_assert_uint_eq(leaves_of_patch(t.hierarchy, 0), 1);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).limited_links, 32);
  test_free_links(&t);

  p = (script){.split = HR2D_SPLIT_BOTH, .limit_level = 2};
  t = test_make_links(test_named_scene("par1"), &scripted_oracle, &s, &scripted_policy, &p);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 16);
  test_free_links(&t);

  const hr2d_policy contrary = {
      .struct_size = sizeof contrary, .name = "contrary", .acceptable = scripted_accept};
  t = test_make_links(test_named_scene("par1"), NULL, NULL, &contrary, NULL);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 1); /* A/r = 1 > 0.5 */
  test_free_links(&t);
}
END_TEST

/* Fails after a while, for whichever thread asks then. */
static hr2d_status fails_later(void *ctx, const hr2d_batch *batch, double *error) {
  atomic_uint *left = ctx;
  if (atomic_fetch_sub(left, 1) == 0) return HR2D_ERANGE;
  return hr2d_oracle_size()->estimate(NULL, batch, error);
}

START_TEST(a_team_ends_as_one) {
  const hr2d_oracle oracle = {.struct_size = sizeof oracle,
                              .name = "late",
                              .flags = HR2D_ORACLE_SYMMETRIC | HR2D_ORACLE_THREAD_SAFE,
                              .estimate = fails_later};
  for (unsigned threads = 1; threads < 4; threads++)
    for (unsigned batches = 0; batches < 500; batches += 99) {
      atomic_uint left = batches;
      test_links t = test_make_links(test_named_scene("par0.1"), &oracle, &left, NULL, NULL);
      hr2d_refine_options options = test_epsilon(1. / 64);
      hr2d_refine_counts counts;
      options.threads = threads;
      ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_ERANGE);
      ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(t.links), "oracle \"late\""));
      ck_assert_uint_eq(hr2d_hierarchy_count(t.hierarchy).elements, 2);
      test_free_links(&t);
    }
}
END_TEST

START_TEST(callbacks_cannot_refine_what_is_being_refined) {
  script s = {.value = 0};
  test_links t = test_make_links(test_named_scene("par1"), &scripted_oracle, &s, NULL, NULL);
  s.reenter = t.links;
  ck_assert_int_eq(hr2d_refine(t.links, NULL), HR2D_OK);
  ck_assert_int_eq(s.reentered, HR2D_ESTATE);
  test_free_links(&t);
}
END_TEST

START_TEST(visitors_and_progress_can_stop) {
  test_links t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  const hr2d_refine_options options = test_epsilon(0.01);
  hr2d_refine_counts counts;
  test_collected c = {.stop_at = 1000};
  ck_assert_int_eq(hr2d_refine_visit(t.links, &options, test_collect, &c, &counts),
                   HR2D_STOPPED);
  ck_assert_uint_eq(hr2d_hierarchy_count(t.hierarchy).elements, 2);
  free(c.link);
  test_free_links(&t);
}
END_TEST

typedef struct watch {
  double last;
  int calls, stop_after;
} watch;

static hr2d_status watch_progress(void *ctx, const hr2d_progress *progress) {
  watch *w = ctx;
  ck_assert_str_eq(progress->phase, "refine");
  ck_assert(progress->fraction >= w->last && progress->fraction <= 1);
  w->last = progress->fraction;
  return ++w->calls == w->stop_after ? HR2D_STOPPED : HR2D_OK;
}

START_TEST(progress_rises) {
  test_links t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  watch w = {0};
  hr2d_refine_options options = test_epsilon(1. / 128);
  options.progress = watch_progress;
  options.progress_ctx = &w;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_int_ge(w.calls, 10);
  ck_assert_double_gt(w.last, 0.9);
  test_free_links(&t);
  t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  w = (watch){.stop_after = 2};
  test_refuse(&t, &options, HR2D_STOPPED, "progress");
  hr2d_refine_counts counts;
  for (options.threads = 1; options.threads < 4; options.threads++) {
    w = (watch){0};
    ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_OK);
    ck_assert_int_ge(w.calls, 2);
    ck_assert_double_gt(w.last, 0.9);
    w = (watch){.stop_after = 2};
    ck_assert_int_eq(hr2d_refine_count(t.links, &options, &counts), HR2D_STOPPED);
  }
  test_free_links(&t);
}
END_TEST

START_TEST(brightness_directs_refinement) {
  test_links t =
      test_make_links(test_named_scene("par0.1"), hr2d_oracle_bf(), NULL, NULL, NULL);
  const hr2d_refine_options options = test_epsilon(0.01);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert(hr2d_linkset_directed(t.links));
  check_transport(&t);
  /* Patch 1 is dark, so that one link suffices for its light. */
  const hr2d_element *element = hr2d_hierarchy_elements(t.hierarchy);
  uint64_t from_dark = 0;
  for (uint64_t k = 0; k < hr2d_linkset_size(t.links); k++)
    from_dark += element[hr2d_linkset_get(t.links, k).pair.second].patch == 1;
  ck_assert_uint_eq(from_dark, 1);
  ck_assert_uint_gt(hr2d_linkset_size(t.links), 100);
  /* Once solved it is not dark any more. */
  hr2d_solution *solution = NULL;
  ck_assert_int_eq(hr2d_solve(t.links, NULL, &solution), HR2D_OK);
  hr2d_refine_options brighter = options;
  brighter.brightness = solution;
  ck_assert_int_eq(hr2d_refine(t.links, &brighter), HR2D_OK);
  check_transport(&t);
  from_dark = 0;
  for (uint64_t k = 0; k < hr2d_linkset_size(t.links); k++)
    from_dark += element[hr2d_linkset_get(t.links, k).pair.second].patch == 1;
  ck_assert_uint_gt(from_dark, 50);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
}
END_TEST

START_TEST(shortcut_decides_as_the_estimate) {
  /* `accept` against `estimate`, also at equality and one unit to either side. */
  const hr2d_oracle *const oracle[] = {hr2d_oracle_size(), hr2d_oracle_size2()};
  unsigned long state = test_seed();
  for (int round = 0; round < (int)test_rounds(20000, 100); round++) {
    double scale = pow(10, 40 * test_random(&state) - 20), p[2][6] = {{0}};
    for (int k = 0; k < 8; k++) p[k / 4][k % 4] = scale * test_random(&state);
    if (round % 3 == 0) /* tiny, and far from the origin's digits */
      for (int k = 4; k < 8; k++) p[1][k % 4] *= 1e-200;
    element_pair e = {.brightness = NULL};
    for (int k = 0; k < 2; k++)
      e.element[k] =
          (hr2d_element){.centre = {p[k][0], p[k][1]}, .length = hypot(p[k][2], p[k][3])};
    const hr2d_batch batch = element_batch(&e);
    for (int o = 0; o < 2; o++) {
      const double error = element_estimate(oracle[o], &batch);
      const double epsilon[] = {error, nextafter(error, 0), nextafter(error, HUGE_VAL),
                                error * test_random(&state), error / test_random(&state)};
      for (int k = 0; k < 5; k++)
        ck_assert_msg(element_accepted(oracle[o], &batch, epsilon[k]) == (error <= epsilon[k]),
                      "estimate %a, epsilon %a", error, epsilon[k]);
    }
  }
}
END_TEST

TEST_SUITE("refine") {
  ADD_TESTS("reference tables", counts_of_size, counts_of_size2, counts_of_both_orders);
  ADD_TESTS("links", links_exchange_what_patches_do, clipped_links_exchange_what_patches_do,
            facing_pairs_are_never_tested_again, patches_that_see_nothing_have_no_links,
            stored_streamed_and_counted_agree, threads_count_the_same,
            multigrid_ends_where_one_step_does);
  ADD_TESTS("limits", level_limit_acts_and_says_so, elements_end_where_doubles_do,
            budgets_are_kept, options_without_meaning_are_refused);
  ADD_TESTS("callbacks", estimates_without_meaning_end_the_refinement,
            callbacks_end_the_refinement, policies_decide, a_team_ends_as_one,
            callbacks_cannot_refine_what_is_being_refined, visitors_and_progress_can_stop,
            progress_rises, brightness_directs_refinement, shortcut_decides_as_the_estimate);
}
