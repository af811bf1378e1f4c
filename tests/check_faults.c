/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Allocation number k fails, for k = 0, 1, 2, … until everything succeeds: once, and
   from then on.  The right status comes back, objects stay usable, nothing leaks. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

/* A whole story: each step may fail for lack of memory and is then tried again. */
typedef struct story {
  test_memory fault;
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links, *counted;
  hr2d_solution *solution, *next;
  hr2d_refine_counts counts, visited;
  uint64_t seen;
  int destroyed;
} story;

/* Runs a step; on HR2D_ENOMEM memory comes back and it must succeed. */
#define STEP(s, call)                                                                          \
  do {                                                                                         \
    const long failures = (s)->fault.failures;                                                 \
    hr2d_status status = (call);                                                               \
    if (status == HR2D_ENOMEM && (s)->fault.failures > failures) {                             \
      (s)->fault.until_failure = -1;                                                           \
      (s)->fault.for_good = 0;                                                                 \
      status = (call);                                                                         \
    }                                                                                          \
    ck_assert_msg(status == HR2D_OK, "%s: %s", #call, hr2d_strerror(status));                  \
  } while (0)

static const char room[] =
    "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":"
    "{\"name\":\"room\",\"reflectance\":[0.5,0.9],\"emission\":0.25},\"geometry\":{\"type\":"
    "\"Polygon\",\"coordinates\":[[[0,0],[2,0],[2,1],[0,1],[0,0]]]}}]}";

static void count_destroy(void *ctx) {
  (*(int *)ctx)++;
}

static hr2d_status count_links(void *ctx, const hr2d_link *links, size_t count) {
  (void)links;
  *(uint64_t *)ctx += count;
  return HR2D_OK;
}

static hr2d_status visit(story *s, const hr2d_refine_options *options) {
  s->seen = 0;
  return hr2d_refine_visit(s->counted, options, count_links, &s->seen, &s->visited);
}

static void tell(story *s, const hr2d_oracle *kind) {
  const hr2d_allocator hooks = test_hooks(&s->fault);
  const double one = 1;
  const hr2d_patch lamp = {.a = {.9, .5},
                           .b = {1.1, .5},
                           .name = "lamp",
                           .emission = &one,
                           .emission_bands = 1,
                           .sides = HR2D_SIDES_BOTH};
  hr2d_oracle oracle = *kind;
  oracle.destroy = count_destroy;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.max_level = 8;
  options.epsilon = 0.5;
  STEP(s, hr2d_scene_create(&hooks, &s->scene));
  STEP(s, hr2d_scene_parse(s->scene, room, strlen(room)));
  ck_assert_uint_eq(hr2d_scene_patches(s->scene), 4);
  STEP(s, hr2d_scene_add(s->scene, &lamp, NULL));
  ck_assert_uint_eq(hr2d_scene_patches(s->scene), 6);
  hr2d_scene_destroy(s->scene);
  s->scene = NULL;
  STEP(s, hr2d_scene_create(&hooks, &s->scene));
  STEP(s, hr2d_scene_parse(s->scene, room, strlen(room)));
  STEP(s, hr2d_scene_commit(s->scene));
  STEP(s, hr2d_hierarchy_create(s->scene, &s->hierarchy));
  STEP(s, hr2d_linkset_create(s->hierarchy, &oracle, &s->destroyed, NULL, NULL, &s->links));
  STEP(s, hr2d_linkset_create(s->hierarchy, &oracle, &s->destroyed, NULL, NULL, &s->counted));
  STEP(s, hr2d_refine_count(s->counted, &options, &s->counts));
  STEP(s, visit(s, &options));
  STEP(s, hr2d_refine(s->links, &options));
  STEP(s, hr2d_solve(s->links, NULL, &s->solution));
  options.epsilon = 0.02;
  options.brightness = s->solution;
  STEP(s, hr2d_refine(s->links, &options));
  const hr2d_solve_options warm = {.struct_size = sizeof warm,
                                   .tolerance = 1e-12,
                                   .max_iterations = 100,
                                   .threads = 1,
                                   .closure = 1,
                                   .start = s->solution};
  STEP(s, hr2d_solve(s->links, &warm, &s->next));
}

static void end(story *s) {
  hr2d_solution_destroy(s->next);
  hr2d_solution_destroy(s->solution);
  hr2d_linkset_destroy(s->counted);
  hr2d_linkset_destroy(s->links);
  hr2d_hierarchy_destroy(s->hierarchy);
  hr2d_scene_destroy(s->scene);
  ck_assert_int_eq(s->destroyed, 2);
  ck_assert_int_eq(s->fault.live, 0);
}

static void compare(const story *s, const story *ideal) {
  ck_assert_uint_eq(s->seen, ideal->seen);
  test_same_counts(&s->counts, &ideal->counts);
  ck_assert_uint_eq(hr2d_linkset_size(s->links), hr2d_linkset_size(ideal->links));
  ck_assert_uint_eq(hr2d_hierarchy_count(s->hierarchy).elements,
                    hr2d_hierarchy_count(ideal->hierarchy).elements);
  for (uint32_t e = 0; e < hr2d_hierarchy_count(s->hierarchy).elements; e++)
    for (size_t band = 0; band < 2; band++)
      ck_assert_double_eq(hr2d_solution_element(s->next, e, band),
                          hr2d_solution_element(ideal->next, e, band));
}

static void fail_everywhere(const hr2d_oracle *oracle, int for_good) {
  story ideal = {.fault = {.until_failure = -1}};
  tell(&ideal, oracle);
  long k = 0;
  for (int failed = 1; failed; k++) {
    story s = {.fault = {.until_failure = k, .for_good = for_good}};
    tell(&s, oracle);
    failed = s.fault.failures > 0;
    compare(&s, &ideal);
    end(&s);
  }
  ck_assert_int_gt(k, 60); /* the story allocates at all */
  printf("%s, %s: %ld allocations failed\n", oracle->name, for_good ? "for good" : "once",
         k - 1);
  end(&ideal);
}

START_TEST(one_allocation_fails) {
  fail_everywhere(hr2d_oracle_size(), 0);
  fail_everywhere(hr2d_oracle_bf(), 0);
}
END_TEST

START_TEST(allocations_fail_for_good) {
  fail_everywhere(hr2d_oracle_size(), 1);
  fail_everywhere(hr2d_oracle_bf(), 1);
}
END_TEST

START_TEST(failures_are_seen) {
  /* Negative control: the hooks are really used, and a leak would be counted. */
  story s = {.fault = {.until_failure = 0, .for_good = 1}};
  const hr2d_allocator hooks = test_hooks(&s.fault);
  ck_assert_int_eq(hr2d_scene_create(&hooks, &s.scene), HR2D_ENOMEM);
  s.fault.until_failure = -1;
  ck_assert_int_eq(hr2d_scene_create(&hooks, &s.scene), HR2D_OK);
  ck_assert_int_eq(s.fault.live, 1);
  hr2d_scene_destroy(s.scene);
  hr2d_allocator missing = test_hooks(&s.fault);
  missing.reallocate = NULL;
  ck_assert_int_eq(hr2d_scene_create(&missing, &s.scene), HR2D_EINVAL);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("faults");
  TCase *memory = tcase_create("memory");
  tcase_set_timeout(memory, 600);
  tcase_add_test(memory, one_allocation_fails);
  tcase_add_test(memory, allocations_fail_for_good);
  tcase_add_test(memory, failures_are_seen);
  suite_add_tcase(suite, memory);
  return test_run(suite);
}
