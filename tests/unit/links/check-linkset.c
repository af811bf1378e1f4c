/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Link sets: which callback tables they accept, who owns the contexts, and what can be read
   from them. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

/* Counts the calls with a context. */
typedef struct witness {
  int calls, destroyed;
} witness;

static hr2d_status accept_all(void *ctx, const hr2d_batch *batch, double *error) {
  ((witness *)ctx)->calls++;
  memset(error, 0, batch->count * sizeof *error);
  return HR2D_OK;
}

static hr2d_status limit_all(void *ctx, const hr2d_batch *batch, unsigned char *limited) {
  ((witness *)ctx)->calls++;
  memset(limited, 1, batch->count);
  return HR2D_OK;
}

static hr2d_status refuse_all(void *ctx, const hr2d_batch *batch, const double *error,
                              unsigned char *accepted) {
  (void)ctx, (void)error;
  memset(accepted, 0, batch->count);
  return HR2D_OK;
}

static void note_destroy(void *ctx) {
  ((witness *)ctx)->destroyed++;
}

static void never(void *ctx) {
  (void)ctx;
  ck_abort_msg("a member was called that the table is too short for");
}

static const hr2d_oracle whole_oracle = {.struct_size = sizeof(hr2d_oracle),
                                         .name = "accept all",
                                         .flags = HR2D_ORACLE_SYMMETRIC,
                                         .estimate = accept_all,
                                         .destroy = note_destroy};

static const hr2d_policy whole_policy = {.struct_size = sizeof(hr2d_policy),
                                         .name = "limit all",
                                         .acceptable = refuse_all,
                                         .recursion_limit = limit_all,
                                         .destroy = note_destroy};

/* The first `size` bytes of a table in memory of just that size, so that reading past
   them is an error under valgrind; struct_size says `size`. */
static void *cut_table(const void *table, size_t size) {
  char *cut = malloc(size < sizeof size ? sizeof size : size);
  memcpy(cut, table, size < sizeof size ? sizeof size : size);
  memcpy(cut, &size, sizeof size);
  return cut;
}

START_TEST(defaults_are_size_and_original) {
  hr2d_scene *scene = test_named_scene("orth1");
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  ck_assert_ptr_eq(hr2d_linkset_hierarchy(t.links), t.hierarchy);
  test_links named = test_make_links(test_named_scene("orth1"), hr2d_oracle_size(), NULL,
                                     hr2d_policy_original(), NULL);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 1. / 16;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(named.links, &options), HR2D_OK);
  /* 127 for the modified algorithm. */
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 125);
  ck_assert_uint_eq(hr2d_linkset_size(named.links), 125);
  for (uint64_t k = 0; k < 125; k++) {
    const hr2d_link l = hr2d_linkset_get(t.links, k), m = hr2d_linkset_get(named.links, k);
    ck_assert_mem_eq(&l, &m, sizeof l);
  }
  test_free_links(&t);
  test_free_links(&named);
  hr2d_linkset_destroy(NULL);
}
END_TEST

START_TEST(a_new_set_is_empty) {
  test_links t = test_make_links(test_named_scene("par1"), hr2d_oracle_bf(), NULL, NULL, NULL);
  const hr2d_refine_counts c = hr2d_linkset_counts(t.links);
  ck_assert_uint_eq(c.elements + c.leaves + c.links + c.limited_links + c.oracle_calls +
                        c.facing_tests + c.visibility_tests + c.exchange_areas + c.levels,
                    0);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 0);
  ck_assert_uint_eq(hr2d_linkset_bytes(t.links), 0);
  ck_assert_str_eq(hr2d_linkset_message(t.links), "");
  ck_assert_int_eq(hr2d_linkset_directed(t.links), 0);
  test_free_links(&t);
}
END_TEST

START_TEST(contexts_are_destroyed_once) {
  witness oracle = {0}, policy = {0};
  test_links t =
      test_make_links(test_named_scene("par1"), &whole_oracle, &oracle, &whole_policy, &policy);
  ck_assert_int_eq(hr2d_refine(t.links, NULL), HR2D_OK);
  ck_assert_int_eq(oracle.calls, 1);
  ck_assert_int_eq(policy.calls, 1);
  ck_assert_str_eq(hr2d_linkset_oracle(t.links)->name, whole_oracle.name);
  ck_assert_str_eq(hr2d_linkset_policy(t.links)->name, whole_policy.name);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 1);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).limited_links, 1);
  ck_assert_int_eq(oracle.destroyed, 0);
  ck_assert_int_eq(policy.destroyed, 0);
  test_free_links(&t);
  ck_assert_int_eq(oracle.destroyed, 1);
  ck_assert_int_eq(policy.destroyed, 1);
}
END_TEST

START_TEST(unused_contexts_are_destroyed_too) {
  witness oracle = {0};
  hr2d_oracle table = whole_oracle;
  test_links t = test_make_links(test_named_scene("par1"), &table, &oracle, NULL, NULL);
  /* The table is copied: what becomes of it does not matter. */
  memset(&table, 0xff, sizeof table);
  test_free_links(&t);
  ck_assert_int_eq(oracle.destroyed, 1);
}
END_TEST

/* Refused: the contexts stay the caller's, and nothing is made. */
static void check_refused(const hr2d_oracle *oracle, const hr2d_policy *policy) {
  hr2d_scene *scene = test_named_scene("par1");
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  witness of_oracle = {0}, of_policy = {0};
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &hierarchy), HR2D_OK);
  ck_assert_int_eq(
      hr2d_linkset_create(hierarchy, oracle, &of_oracle, policy, &of_policy, &links),
      HR2D_EINVAL);
  ck_assert_ptr_null(links);
  ck_assert_int_eq(of_oracle.destroyed, 0);
  ck_assert_int_eq(of_policy.destroyed, 0);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
}

START_TEST(tables_without_required_members_are_refused) {
  hr2d_oracle oracle = whole_oracle;
  oracle.name = NULL;
  check_refused(&oracle, &whole_policy);
  oracle = whole_oracle;
  oracle.estimate = NULL;
  check_refused(&oracle, &whole_policy);
  hr2d_policy policy = whole_policy;
  policy.name = NULL;
  check_refused(&whole_oracle, &policy);
  check_refused(NULL, &policy);
  const size_t of_oracle[] = {0, 1, offsetof(hr2d_oracle, name), offsetof(hr2d_oracle, flags),
                              offsetof(hr2d_oracle, estimate)};
  for (size_t k = 0; k < sizeof of_oracle / sizeof *of_oracle; k++) {
    hr2d_oracle *cut = cut_table(&whole_oracle, of_oracle[k]);
    check_refused(cut, NULL);
    free(cut);
  }
  const size_t of_policy[] = {0, 1, offsetof(hr2d_policy, name), offsetof(hr2d_policy, flags)};
  for (size_t k = 0; k < sizeof of_policy / sizeof *of_policy; k++) {
    hr2d_policy *cut = cut_table(&whole_policy, of_policy[k]);
    check_refused(NULL, cut);
    free(cut);
  }
}
END_TEST

/* Tables of an older caller: members beyond struct_size count as NULL, whatever the memory
   behind them holds. */
START_TEST(shorter_tables_are_taken) {
  hr2d_oracle oracle = whole_oracle;
  hr2d_policy policy = whole_policy;
  oracle.destroy = never;
  policy.destroy = never;
  for (int k = 0; k < 4; k++) {
    oracle.struct_size = k & 1 ? offsetof(hr2d_oracle, destroy) : offsetof(hr2d_oracle, accept);
    policy.struct_size =
        k & 2 ? offsetof(hr2d_policy, destroy) : offsetof(hr2d_policy, acceptable);
    memset(&oracle.accept, k & 1 ? 0 : 0xff, sizeof oracle.accept);
    if (!(k & 2)) {
      memset(&policy.acceptable, 0xff, sizeof policy.acceptable);
      memset(&policy.recursion_limit, 0xff, sizeof policy.recursion_limit);
      memset(&policy.preferred_subdivision, 0xff, sizeof policy.preferred_subdivision);
    }
    hr2d_oracle *cut_oracle = cut_table(&oracle, oracle.struct_size);
    hr2d_policy *cut_policy = cut_table(&policy, policy.struct_size);
    for (int cut = 0; cut < 2; cut++) {
      witness of_oracle = {0}, of_policy = {0};
      test_links t = test_make_links(test_named_scene("par1"), cut ? cut_oracle : &oracle,
                                     &of_oracle, cut ? cut_policy : &policy, &of_policy);
      ck_assert_int_eq(hr2d_refine(t.links, NULL), HR2D_OK);
      ck_assert_uint_eq(hr2d_linkset_size(t.links), 1);
      ck_assert_int_eq(of_oracle.calls, 1);
      ck_assert_int_eq(of_policy.calls, k & 2 ? 1 : 0);
      test_free_links(&t);
      ck_assert_int_eq(of_oracle.destroyed + of_policy.destroyed, 0);
    }
    free(cut_oracle);
    free(cut_policy);
    policy = whole_policy;
    policy.destroy = never;
  }
}
END_TEST

/* The least that is required, with subdivision: everything else is the default. */
START_TEST(min_tables_work_as_the_defaults) {
  hr2d_oracle *oracle = cut_table(hr2d_oracle_size(), offsetof(hr2d_oracle, accept));
  hr2d_policy *policy = cut_table(hr2d_policy_original(), offsetof(hr2d_policy, acceptable));
  test_links t = test_make_links(test_named_scene("orth1"), oracle, NULL, policy, NULL);
  free(oracle);
  free(policy);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 1. / 16;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 125);
  ck_assert_uint_eq(hr2d_linkset_counts(t.links).oracle_calls, 249);
  test_free_links(&t);
}
END_TEST

START_TEST(longer_tables_are_taken) {
  struct {
    hr2d_oracle known;
    void (*unknown[3])(void *);
  } oracle = {whole_oracle, {never, never, never}};
  struct {
    hr2d_policy known;
    void (*unknown[3])(void *);
  } policy = {whole_policy, {never, never, never}};
  oracle.known.struct_size = sizeof oracle;
  policy.known.struct_size = sizeof policy;
  witness of_oracle = {0}, of_policy = {0};
  test_links t = test_make_links(test_named_scene("par1"), &oracle.known, &of_oracle,
                                 &policy.known, &of_policy);
  ck_assert_int_eq(hr2d_refine(t.links, NULL), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_size(t.links), 1);
  test_free_links(&t);
  ck_assert_int_eq(of_oracle.destroyed, 1);
  ck_assert_int_eq(of_policy.destroyed, 1);
}
END_TEST

START_TEST(without_memory_the_caller_keeps_the_contexts) {
  test_memory m = {.until_failure = -1, .for_good = 1};
  const hr2d_allocator hooks = test_hooks(&m);
  hr2d_scene *scene = NULL;
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  ck_assert_int_eq(hr2d_scene_create(&hooks, &scene), HR2D_OK);
  hr2d_patch patch = HR2D_PATCH_INIT;
  patch.b.x = 1;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &hierarchy), HR2D_OK);
  witness w = {0};
  m.until_failure = 0;
  ck_assert_int_eq(hr2d_linkset_create(hierarchy, &whole_oracle, &w, &whole_policy, &w, &links),
                   HR2D_ENOMEM);
  ck_assert_ptr_null(links);
  ck_assert_int_eq(w.destroyed, 0);
  m.until_failure = -1;
  ck_assert_int_eq(hr2d_linkset_create(hierarchy, &whole_oracle, &w, &whole_policy, &w, &links),
                   HR2D_OK);
  hr2d_linkset_destroy(links);
  ck_assert_int_eq(w.destroyed, 2);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
  ck_assert_int_eq(m.live, 0);
}
END_TEST

START_TEST(links_are_elements_and_their_exchange) {
  /* Not at a scale of 1, so that units show. */
  const double room[][6] = {
      {0, 0, 48, 0, 1, .5}, {48, 20, 0, 20, 0, .5}, {-3, 19, -3, 1, 0, 0}};
  test_links t = test_make_links(test_scene(room, 3), NULL, NULL, NULL, NULL);
  ck_assert_int_eq(hr2d_refine(t.links, NULL), HR2D_OK);
  const hr2d_element *element = hr2d_hierarchy_elements(t.hierarchy);
  const double unit = hr2d_scene_unit(t.scene);
  ck_assert_double_eq(unit, 32);
  ck_assert_uint_gt(hr2d_linkset_size(t.links), 100);
  for (uint64_t k = 0; k < hr2d_linkset_size(t.links); k++) {
    const hr2d_link link = hr2d_linkset_get(t.links, k);
    const hr2d_element *e[] = {&element[link.pair.first], &element[link.pair.second]};
    hr2d_segment s[2];
    for (int m = 0; m < 2; m++)
      s[m] = (hr2d_segment){{e[m]->a.x * unit, e[m]->a.y * unit},
                            {e[m]->b.x * unit, e[m]->b.y * unit}};
    ck_assert_uint_lt(e[0]->patch, e[1]->patch);
    ck_assert_double_eq(link.exchange_area, hr2d_exchange_area(&s[0], &s[1]));
  }
  test_free_links(&t);
}
END_TEST

START_TEST(bytes_are_those_of_blocks) {
  test_links t = test_make_links(test_named_scene("par0.1"), NULL, NULL, NULL, NULL);
  const uint64_t size[] = {46, 958, 15244, 246082};
  for (int k = 0; k < 4; k++) {
    hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
    options.epsilon = 1. / (1 << 2 * k);
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    ck_assert_uint_eq(hr2d_linkset_size(t.links), size[k]);
    ck_assert_uint_eq(hr2d_linkset_counts(t.links).links, size[k]);
    const uint64_t blocks = (size[k] + 4095) / 4096, bytes = hr2d_linkset_bytes(t.links);
    ck_assert_uint_ge(bytes, blocks * 4096 * 16);
    /* Lists of chunks and of their memory that grow by doubling, from 8. */
    ck_assert_uint_le(bytes, blocks * 4096 * 16 + (2 * blocks + 8) * 3 * sizeof(void *));
  }
  test_free_links(&t);
}
END_TEST

START_TEST(direction_is_that_of_the_oracle_or_the_options) {
  const hr2d_oracle *const oracle[] = {hr2d_oracle_size(), hr2d_oracle_size2(),
                                       hr2d_oracle_bf()};
  for (int k = 0; k < 6; k++) {
    test_links t = test_make_links(test_named_scene("par1"), oracle[k / 2], NULL, NULL, NULL);
    hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
    options.ordered = k % 2;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    ck_assert_int_eq(hr2d_linkset_directed(t.links), k / 2 == 2 || k % 2);
    ck_assert_uint_gt(hr2d_linkset_size(t.links), 1);
    test_free_links(&t);
  }
}
END_TEST

START_TEST(counts_sum_up_what_was_done) {
  test_links t = test_make_links(test_named_scene("par1"), NULL, NULL, NULL, NULL);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 0.25;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  hr2d_refine_counts counts = hr2d_linkset_counts(t.links);
  ck_assert_uint_eq(counts.elements, 14);
  ck_assert_uint_eq(counts.leaves, 8);
  ck_assert_uint_eq(counts.links, 16);
  ck_assert_uint_eq(counts.oracle_calls, 31);
  ck_assert_uint_eq(counts.exchange_areas, 16);
  ck_assert_uint_eq(counts.levels, 2);
  options.epsilon = 1. / 16;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  counts = hr2d_linkset_counts(t.links);
  ck_assert_uint_eq(counts.elements, 62);
  ck_assert_uint_eq(counts.leaves, 32);
  ck_assert_uint_eq(counts.links, 256);
  /* The tree of pairs has 511 nodes; the 16 links of before were asked about twice. */
  ck_assert_uint_eq(counts.oracle_calls, 511 + 16);
  ck_assert_uint_eq(counts.levels, 4);
  test_free_links(&t);
}
END_TEST

START_TEST(messages_stay_with_their_set) {
  hr2d_scene *scene = test_named_scene("par1");
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  hr2d_linkset *other = NULL;
  ck_assert_int_eq(hr2d_linkset_create(t.hierarchy, NULL, NULL, NULL, NULL, &other), HR2D_OK);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = -1;
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_EINVAL);
  ck_assert_str_ne(hr2d_linkset_message(t.links), "");
  ck_assert_str_eq(hr2d_linkset_message(other), "");
  ck_assert_int_eq(hr2d_refine(t.links, NULL), HR2D_OK);
  ck_assert_str_ne(hr2d_linkset_message(t.links), "");
  hr2d_linkset_destroy(other);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("linkset") {
  ADD_TESTS("tables", defaults_are_size_and_original, contexts_are_destroyed_once,
            unused_contexts_are_destroyed_too, tables_without_required_members_are_refused,
            shorter_tables_are_taken, min_tables_work_as_the_defaults, longer_tables_are_taken,
            without_memory_the_caller_keeps_the_contexts);
  ADD_TESTS("reading", a_new_set_is_empty, links_are_elements_and_their_exchange,
            bytes_are_those_of_blocks, direction_is_that_of_the_oracle_or_the_options,
            counts_sum_up_what_was_done, messages_stay_with_their_set);
}
