/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refinement with links on several threads: the links, the elements and the counts of one
   thread, in the same order and with the same bits; and how it ends early. */
#include <string.h>

#include "hierarchy/hierarchy-impl.h"
#include "support/slow-scenes.h"
#include "support/support.h"

enum { PATCHES = 150 }; /* more than one band of rows */

static const unsigned all_threads[] = {2, 3, 8};
enum { THREADS = sizeof all_threads / sizeof *all_threads };

static test_links make(slow_kind kind, const hr2d_allocator *hooks, const hr2d_oracle *oracle,
                       const hr2d_policy *policy) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(hooks, &scene), HR2D_OK);
  ck_assert_int_eq(slow_add(scene, kind, PATCHES), HR2D_OK);
  test_commit(scene);
  return test_make_links(scene, oracle, NULL, policy, NULL);
}

static uint64_t mix(uint64_t digest, const void *bytes, size_t count) {
  const unsigned char *byte = bytes;
  for (size_t k = 0; k < count; k++) digest = (digest ^ byte[k]) * 0x100000001b3u; /* FNV-1a */
  return digest;
}

/* Of all that a refinement makes. */
static uint64_t digest_of(const test_links *t) {
  uint64_t digest = 0xcbf29ce484222325u;
  for (uint64_t k = 0; k < hr2d_linkset_size(t->links); k++) {
    const hr2d_link link = hr2d_linkset_get(t->links, k);
    digest = mix(digest, &link.pair, sizeof link.pair);
    digest = mix(digest, &link.exchange_area, sizeof link.exchange_area);
  }
  const hr2d_hierarchy *h = t->hierarchy;
  digest = mix(digest, h->element, h->elements * sizeof *h->element);
  digest = mix(digest, h->parent, h->elements * sizeof *h->parent);
  digest = mix(digest, h->level, h->elements * sizeof *h->level);
  const hr2d_refine_counts n = hr2d_linkset_counts(t->links);
  const uint64_t counts[] = {n.elements,       n.leaves,        n.links,
                             n.limited_links,  n.oracle_calls,  n.facing_tests,
                             n.exchange_areas, n.partial_links, n.visibility_tests,
                             n.blocked_pairs,  n.dark_pairs,    n.levels};
  return mix(digest, counts, sizeof counts);
}

static uint64_t refined(slow_kind kind, const hr2d_oracle *oracle, const hr2d_policy *policy,
                        const hr2d_refine_options *options, uint64_t *links) {
  test_links t = make(kind, NULL, oracle, policy);
  ck_assert_int_eq(hr2d_refine(t.links, options), HR2D_OK);
  ck_assert_uint_eq(hr2d_hierarchy_count(t.hierarchy).elements, t.hierarchy->elements);
  const uint64_t digest = digest_of(&t);
  *links = hr2d_linkset_size(t.links);
  test_free_links(&t);
  return digest;
}

START_TEST(threads_make_the_same) {
  const slow_kind kind = (slow_kind)(_i % SLOW_KINDS);
  const int other = _i / SLOW_KINDS;
  const hr2d_oracle *oracle = other ? hr2d_oracle_bf() : hr2d_oracle_size();
  const hr2d_policy *policy = other ? hr2d_policy_modified() : hr2d_policy_original();
  hr2d_refine_options options = test_options(other ? 2e-3 : 0.7, 5);
  uint64_t links, same, finer;
  const uint64_t expected = refined(kind, oracle, policy, &options, &links);
  for (int k = 0; k < THREADS; k++) {
    options.threads = all_threads[k];
    ck_assert_msg(refined(kind, oracle, policy, &options, &same) == expected, "%s, %u threads",
                  slow_name(kind), all_threads[k]);
    ck_assert_uint_eq(same, links);
  }
  /* Negative control: other links have another digest.  Under a sky alone bf divides nothing.
   */
  options.epsilon *= 0.3;
  ck_assert(other || refined(kind, oracle, policy, &options, &finer) != expected);
  printf("%s, %s: %llu links\n", slow_name(kind), oracle->name, (unsigned long long)links);
}
END_TEST

/* A set that is there already is refined further, and elements of another set are there. */
START_TEST(elements_may_exist) {
  uint64_t digest[2];
  for (unsigned k = 0; k < 2; k++) {
    test_links t = make(SLOW_SOUP, NULL, NULL, NULL);
    hr2d_linkset *first = NULL;
    hr2d_refine_options options = test_options(1.5, 4);
    ck_assert_int_eq(hr2d_linkset_create(t.hierarchy, NULL, NULL, NULL, NULL, &first), HR2D_OK);
    options.threads = k ? 3 : 1;
    ck_assert_int_eq(hr2d_refine(first, &options), HR2D_OK);
    options.epsilon = 0.8;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    options.epsilon = 0.6;
    ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
    digest[k] = digest_of(&t);
    hr2d_linkset_destroy(first);
    test_free_links(&t);
  }
  ck_assert(digest[0] == digest[1]);
}
END_TEST

START_TEST(targets_have_the_same_bits) {
  double average[2][PATCHES];
  for (unsigned k = 0; k < 2; k++) {
    test_links t = make(SLOW_SQUARES, NULL, NULL, NULL);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *solution = NULL;
    target.error = 1e-2;
    target.threads = k ? 3 : 1;
    ck_assert_int_eq(hr2d_solve_to(t.scene, &target, &solution, NULL), HR2D_OK);
    for (size_t patch = 0; patch < PATCHES; patch++)
      average[k][patch] =
          patch < hr2d_scene_patches(t.scene) ? hr2d_solution_average(solution, patch, 0) : 0;
    hr2d_solution_destroy(solution);
    test_free_links(&t);
  }
  ck_assert_int_eq(memcmp(average[0], average[1], sizeof average[0]), 0);
}
END_TEST

static hr2d_status stop(void *ctx, const hr2d_progress *progress) {
  int *left = ctx;
  ck_assert(progress->fraction >= 0 && progress->fraction <= 1);
  return (*left)-- > 0 ? HR2D_OK : HR2D_STOPPED;
}

START_TEST(budgets_and_callbacks_end_it) {
  test_links t = make(SLOW_SQUARES, NULL, NULL, NULL);
  for (unsigned threads = 1; threads <= 3; threads += 2) {
    hr2d_refine_options options = test_options(0.1, 7);
    options.threads = threads;
    options.max_links = 1000;
    test_refuse(&t, &options, HR2D_EMAX_LINKS, "1000 links");
    options.max_links = 0;
    options.max_elements = 300;
    test_refuse(&t, &options, HR2D_EMAX_ELEMENTS, "300 elements");
    options.max_elements = 0;
    options.max_bytes = 200000;
    test_refuse(&t, &options, HR2D_EMAX_BYTES, "200000 bytes");
    options.max_bytes = 0;
    options.progress = stop;
    for (int questions = 0; questions < 5; questions += 2) {
      int left = questions;
      options.progress_ctx = &left;
      test_refuse(&t, &options, HR2D_STOPPED, "progress");
    }
  }
  test_free_links(&t);
}
END_TEST

START_TEST(memory_may_run_out) {
  test_memory m = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&m);
  test_links t = make(SLOW_COMB, &hooks, NULL, NULL);
  hr2d_refine_options options = test_options(1, 4);
  options.threads = 2;
  int failed = 0;
  hr2d_status status = HR2D_ENOMEM;
  for (long k = 0; status == HR2D_ENOMEM; k += 1 + k / 16, failed++) {
    const long live = m.live;
    m.until_failure = k;
    m.for_good = (int)(k % 2);
    status = hr2d_refine(t.links, &options);
    m.until_failure = -1;
    ck_assert(status == HR2D_OK || status == HR2D_ENOMEM);
    if (status == HR2D_ENOMEM) {
      ck_assert_int_eq(m.live, live);
      ck_assert_uint_eq(t.hierarchy->elements, hr2d_scene_patches(t.scene));
    }
  }
  printf("%d failures\n", failed);
  ck_assert_int_gt(failed, 20);
  test_free_links(&t);
  ck_assert_int_eq(m.live, 0);
}
END_TEST

START_TEST(memory_of_targets_may_run_out) {
  test_memory m = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&m);
  test_links t = make(SLOW_SQUARES, &hooks, NULL, NULL);
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 0.1;
  target.threads = 3;
  int failed = 0;
  hr2d_status status = HR2D_ENOMEM;
  for (long k = 0; status; k += 1 + k / 8, failed++) {
    const long live = m.live;
    hr2d_solution *solution = NULL;
    m.until_failure = k;
    m.for_good = (int)(k % 2);
    status = hr2d_solve_to(t.scene, &target, &solution, NULL);
    m.until_failure = -1;
    ck_assert(status == HR2D_OK || status == HR2D_ENOMEM);
    hr2d_solution_destroy(solution);
    ck_assert_int_eq(m.live, live);
  }
  printf("%d failures of targets\n", failed);
  ck_assert_int_gt(failed, 20);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("rows") {
  REPEAT_TESTS(2 * SLOW_KINDS, "links", threads_make_the_same);
  ADD_TESTS("sets", elements_may_exist, targets_have_the_same_bits);
  ADD_TESTS("ends", budgets_and_callbacks_end_it, memory_may_run_out,
            memory_of_targets_may_run_out);
}
