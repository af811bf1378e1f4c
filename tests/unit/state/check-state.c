/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Saved states of a solve: resuming from one gives the same bits as a run without
   interruption; states that are damaged, cut off or forged are refused or do no harm. */
#include <hr2d/symmetry.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"
#include "support/tape.h"

static tape write_tape(const hr2d_solution *solution) {
  tape t = {.until_failure = -1};
  ck_assert_int_eq(hr2d_state_write(solution, tape_record, &t), HR2D_OK);
  return t;
}

/* Refines to `epsilon`, weighted with a solution, and solves from it; destroys it. */
static hr2d_solution *stage(test_links *t, double epsilon, hr2d_solution *before) {
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *after;
  refine.epsilon = epsilon;
  refine.max_level = 10;
  refine.brightness = solve.start = before;
  ck_assert_int_eq(hr2d_refine(t->links, &refine), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(t->links, &solve, &after), HR2D_OK);
  hr2d_solution_destroy(before);
  return after;
}

static const char *const names[] = {"par0.1", "square_rho0.9", "occ_square_walls0.5_occ0.5"};

typedef struct setup {
  const char *scene;
  const hr2d_oracle *oracle;
  const hr2d_policy *policy;
  unsigned order;
} setup;

static test_links make(const setup *s) {
  test_links t = test_make_links(test_named_scene(s->scene), s->oracle, NULL, s->policy, NULL);
  ck_assert_int_eq(hr2d_hierarchy_set_order(t.hierarchy, s->order), HR2D_OK);
  return t;
}

static const setup plain = {"square_rho0.9", NULL, NULL, 1};

/* All that can be asked of the two. */
static void same(const test_links *one, const hr2d_solution *b, const test_links *other,
                 const hr2d_solution *c) {
  const uint64_t links = hr2d_linkset_size(one->links);
  const hr2d_hierarchy_counts n = hr2d_hierarchy_count(one->hierarchy);
  const hr2d_refine_counts counts[] = {hr2d_linkset_counts(one->links),
                                       hr2d_linkset_counts(other->links)};
  const hr2d_power power[] = {hr2d_solution_power(b, 0), hr2d_solution_power(c, 0)};
  ck_assert(hr2d_solution_power_cut_off(b, 0) == hr2d_solution_power_cut_off(c, 0));
  ck_assert_uint_eq(n.elements, hr2d_hierarchy_count(other->hierarchy).elements);
  ck_assert_int_eq(memcmp(hr2d_hierarchy_elements(one->hierarchy),
                          hr2d_hierarchy_elements(other->hierarchy),
                          (size_t)n.elements * sizeof(hr2d_element)),
                   0);
  ck_assert_uint_eq(links, hr2d_linkset_size(other->links));
  for (uint64_t k = 0; k < links; k++) {
    const hr2d_link i = hr2d_linkset_get(one->links, k), j = hr2d_linkset_get(other->links, k);
    ck_assert_int_eq(memcmp(&i, &j, sizeof i), 0);
  }
  test_same_counts(&counts[0], &counts[1]);
  ck_assert_int_eq(memcmp(&power[0], &power[1], sizeof *power), 0);
  ck_assert(hr2d_solution_residual(b) == hr2d_solution_residual(c));
  ck_assert(hr2d_linkset_epsilon(one->links) == hr2d_linkset_epsilon(other->links));
  for (size_t patch = 0; patch < hr2d_scene_patches(one->scene); patch++)
    for (int k = 0; k <= 20; k++) {
      ck_assert(hr2d_solution_at(b, patch, k / 20.0, 0) ==
                hr2d_solution_at(c, patch, k / 20.0, 0));
      ck_assert(hr2d_solution_irradiance_at(b, patch, k / 20.0, 0) ==
                hr2d_solution_irradiance_at(c, patch, k / 20.0, 0));
    }
}

static void check_resumed(const setup *s) {
  test_links through = make(s), before = make(s), behind = make(s);
  hr2d_solution *b = stage(&through, 1, NULL), *c = stage(&before, 1, NULL), *d = NULL;
  b = stage(&through, 0.4, b);
  c = stage(&before, 0.4, c);
  tape t = write_tape(c);
  ck_assert_int_eq(hr2d_state_read(behind.links, tape_play, &t, &d), HR2D_OK);
  ck_assert_uint_eq(t.at, t.size);
  same(&before, c, &behind, d);
  tape again = write_tape(d);
  ck_assert_uint_eq(again.size, t.size);
  ck_assert_int_eq(memcmp(again.byte, t.byte, t.size), 0);
  hr2d_solution_destroy(c);
  test_free_links(&before);
  b = stage(&through, 0.15, b);
  d = stage(&behind, 0.15, d);
  same(&through, b, &behind, d);
  ck_assert_int_eq(hr2d_linkset_validate(behind.links), HR2D_OK);
  hr2d_solution_destroy(b);
  hr2d_solution_destroy(d);
  test_free_links(&through);
  test_free_links(&behind);
  free(t.byte);
  free(again.byte);
}

START_TEST(going_on_from_a_state_gives_the_same_bits) {
  const setup s[] = {{names[_i], NULL, NULL, 1},
                     {names[_i], NULL, NULL, 3},
                     {names[_i], hr2d_oracle_bf(), hr2d_policy_modified(), 1},
                     {names[_i], hr2d_oracle_size2(), hr2d_policy_modified(), 2}};
  for (size_t k = 0; k < sizeof s / sizeof *s; k++) check_resumed(&s[k]);
}
END_TEST

/* Reads a tape into a fresh set, which must stay empty and usable if that fails. */
static hr2d_status read_fresh(tape *t, const setup *s) {
  test_links fresh = make(s);
  hr2d_solution *solution = NULL;
  t->at = 0;
  const hr2d_status status = hr2d_state_read(fresh.links, tape_play, t, &solution);
  if (status) {
    ck_assert_ptr_null(solution);
    ck_assert_uint_eq(hr2d_linkset_size(fresh.links), 0);
    ck_assert_uint_eq(hr2d_hierarchy_count(fresh.hierarchy).elements,
                      hr2d_scene_patches(fresh.scene));
    ck_assert_str_ne(hr2d_linkset_message(fresh.links), "");
    solution = stage(&fresh, 1, NULL);
  }
  hr2d_solution_destroy(solution);
  test_free_links(&fresh);
  return status;
}

/* The state of a fresh set after a stage; destroys the set. */
static tape tape_of(test_links t, double epsilon) {
  hr2d_solution *solution = stage(&t, epsilon, NULL);
  tape made = write_tape(solution);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  return made;
}

static tape plain_tape(void) {
  return tape_of(make(&plain), 0.7);
}

START_TEST(a_damaged_state_is_refused) {
  tape t = plain_tape();
  const size_t step = test_multiplier() < 1 ? 7 : 1;
  ck_assert_int_eq(read_fresh(&t, &plain), HR2D_OK);
  for (size_t k = 0; k < t.size; k += step) {
    const unsigned char flip = (unsigned char)(1u << k % 8);
    t.byte[k] ^= flip;
    const hr2d_status status = read_fresh(&t, &plain);
    ck_assert_msg(status == HR2D_ESYNTAX || (k >= 16 && k < 32 && status == HR2D_EINVAL),
                  "byte %zu: %s", k, hr2d_strerror(status));
    t.byte[k] ^= flip;
  }
  const size_t size = t.size;
  for (t.size = 0; t.size < size; t.size += step)
    ck_assert_int_eq(read_fresh(&t, &plain), HR2D_ESYNTAX);
  t.size = size;
  ck_assert_int_eq(read_fresh(&t, &plain), HR2D_OK);
  free(t.byte);
}
END_TEST

/* FNV-1a, so that a made-up state has the right hash. */
static void sign(tape *t) {
  uint64_t hash = UINT64_C(0xcbf29ce484222325);
  for (size_t k = 0; k + 8 < t->size; k++) hash = (hash ^ t->byte[k]) * UINT64_C(0x100000001b3);
  for (size_t k = 0; k < 8; k++) t->byte[t->size - 8 + k] = (unsigned char)(hash >> 8 * k);
}

/* A number that may do harm. */
static void poison(unsigned char *byte, unsigned long *random) {
  static const uint64_t words[] = {0,
                                   1,
                                   UINT64_MAX,
                                   UINT64_MAX / 2,
                                   UINT64_MAX / 16,
                                   UINT32_MAX,
                                   UINT64_C(0x7ff8000000000000),
                                   UINT64_C(0x7ff0000000000000),
                                   UINT64_C(0xbff0000000000000),
                                   UINT64_C(0x7fe0000000000000)};
  const size_t count = sizeof words / sizeof *words;
  uint64_t word = words[(size_t)(test_random(random) * (double)count)];
  if (test_random(random) < 0.5) word = (uint64_t)(test_random(random) * 100);
  for (size_t k = 0; k < 4 + 4 * (size_t)(test_random(random) < 0.5); k++)
    byte[k] = (unsigned char)(word >> 8 * k);
}

/* Any status will do. */
static void use(test_links *t, const hr2d_solution *before) {
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *after = NULL;
  refine.epsilon = 0.5;
  refine.max_level = 8;
  solve.max_iterations = 100;
  refine.brightness = solve.start = before;
  hr2d_linkset_validate(t->links);
  hr2d_refine(t->links, &refine);
  if (!hr2d_solve(t->links, &solve, &after)) hr2d_solution_destroy(after);
}

START_TEST(a_state_that_was_made_up_does_no_harm) {
  tape t = plain_tape();
  tape forged = t;
  unsigned long random = test_seed();
  int refused = 0, taken = 0;
  forged.byte = malloc(t.size);
  for (int k = 0; k < (int)test_rounds(5000, 200); k++) {
    memcpy(forged.byte, t.byte, t.size);
    const size_t words = (t.size - 16) / 4 - 3;
    const size_t at = 16 + 4 * (size_t)(test_random(&random) * (double)(k % 2 ? words : 60));
    poison(forged.byte + at, &random);
    sign(&forged);
    test_links fresh = make(&plain);
    hr2d_solution *solution = NULL;
    forged.at = 0;
    const hr2d_status status = hr2d_state_read(fresh.links, tape_play, &forged, &solution);
    if (status) {
      refused++;
    } else {
      taken++;
      use(&fresh, solution);
    }
    hr2d_solution_destroy(solution);
    test_free_links(&fresh);
  }
  ck_assert_int_gt(refused, 20);
  ck_assert_int_gt(taken, 20);
  free(forged.byte);
  free(t.byte);
}
END_TEST

static test_links half_of_a_room(void) {
  hr2d_scene *half = test_new_scene(NULL);
  test_add_patch(half, (hr2d_segment){{0, 0}, {1, 0}}, 1, .5, HR2D_SIDES_FRONT);
  test_add_patch(half, (hr2d_segment){{1, 0}, {0, 1}}, 0, .5, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_add_mirror(half, (hr2d_segment){{0, 0}, {0, 1}}), HR2D_OK);
  test_commit(half);
  return test_make_links(half, NULL, NULL, NULL, NULL);
}

/* With the same patches as the half and its images. */
START_TEST(a_state_of_a_half_is_not_one_of_the_whole) {
  test_links half = half_of_a_room(), again = half_of_a_room();
  hr2d_solution *solution = stage(&half, .4, NULL), *read = NULL;
  hr2d_scene *whole = test_new_scene(NULL);
  for (size_t k = 0; k < 4; k++)
    test_add_patch(whole, hr2d_scene_image(half.scene, k % 2, k / 2), k % 2 == 0, .5,
                   HR2D_SIDES_FRONT);
  test_commit(whole);
  test_links other = test_make_links(whole, NULL, NULL, NULL, NULL);
  tape t = write_tape(solution);
  ck_assert_int_eq(hr2d_state_read(other.links, tape_play, &t, &read), HR2D_EINVAL);
  t.at = 0;
  ck_assert_int_eq(hr2d_state_read(again.links, tape_play, &t, &read), HR2D_OK);
  same(&half, solution, &again, read);
  hr2d_solution_destroy(solution);
  hr2d_solution_destroy(read);
  test_free_links(&half);
  test_free_links(&again);
  test_free_links(&other);
  free(t.byte);
}
END_TEST

START_TEST(a_state_belongs_to_its_scene_and_method) {
  tape t = plain_tape();
  const setup others[] = {{"square_furnace_rho0.9", NULL, NULL, 1},
                          {"par0.1", NULL, NULL, 1},
                          {"square_rho0.9", hr2d_oracle_size2(), NULL, 1},
                          {"square_rho0.9", NULL, hr2d_policy_modified(), 1}};
  for (size_t k = 0; k < sizeof others / sizeof *others; k++)
    ck_assert_int_eq(read_fresh(&t, &others[k]), HR2D_EINVAL);
  /* Solutions may have any order. */
  ck_assert_int_eq(read_fresh(&t, &(setup){"square_rho0.9", NULL, NULL, 5}), HR2D_OK);
  test_links used = make(&plain);
  hr2d_solution *solution = stage(&used, 1, NULL), *none = NULL;
  t.at = 0;
  ck_assert_int_eq(hr2d_state_read(used.links, tape_play, &t, &none), HR2D_ESTATE);
  ck_assert_ptr_null(none);
  hr2d_solution_destroy(solution);
  test_free_links(&used);
  free(t.byte);
}
END_TEST

/* Plates that see for ever: links with images that are extrapolated may be negative. */
static test_links endless_plates(void) {
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_patch(scene, (hr2d_segment){{0, 0}, {1, 0}}, 1, .5, HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{1, 1}, {0, 1}}, 0, .7, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
  test_commit(scene);
  return test_make_links(scene, NULL, NULL, NULL, NULL);
}

START_TEST(states_of_a_period_are_read) {
  test_links one = endless_plates(), other = endless_plates();
  hr2d_solution *a = stage(&one, .4, NULL), *b = NULL;
  tape t = write_tape(a);
  int negative = 0;
  for (uint64_t k = 0; k < hr2d_linkset_size(one.links); k++)
    negative |= hr2d_linkset_get(one.links, k).exchange_area < 0;
  ck_assert(negative);
  ck_assert_int_eq(hr2d_state_read(other.links, tape_play, &t, &b), HR2D_OK);
  same(&one, a, &other, b);
  a = stage(&one, .1, a);
  b = stage(&other, .1, b);
  same(&one, a, &other, b);
  hr2d_solution_destroy(a);
  hr2d_solution_destroy(b);
  test_free_links(&one);
  test_free_links(&other);
  free(t.byte);
}
END_TEST

START_TEST(callbacks_may_fail_and_may_not_interfere) {
  tape t = plain_tape();
  const hr2d_status failures[] = {HR2D_STOPPED, HR2D_EIO, HR2D_ESYNTAX, (hr2d_status)77};
  for (size_t f = 0; f < sizeof failures / sizeof *failures; f++) {
    hr2d_status status = failures[f];
    for (long k = 0; status; k++) {
      t.until_failure = k;
      t.failure = failures[f];
      status = read_fresh(&t, &plain);
      ck_assert(status == failures[f] || !status);
      ck_assert(status || k > 3);
    }
  }
  test_links links = make(&plain);
  hr2d_solution *solution = NULL;
  t.until_failure = -1;
  t.at = 0;
  t.touched = links.links;
  ck_assert_int_eq(hr2d_state_read(links.links, tape_play, &t, &solution), HR2D_OK);
  tape cut = {.until_failure = 0, .failure = (hr2d_status)77};
  ck_assert_int_eq(hr2d_state_write(solution, tape_record, &cut), 77);
  ck_assert_uint_eq(cut.size, 0);
  hr2d_solution_destroy(solution);
  test_free_links(&links);
  free(cut.byte);
  free(t.byte);
}
END_TEST

START_TEST(a_solution_to_a_target_has_no_state) {
  hr2d_scene *scene = test_named_scene("par0.1");
  hr2d_solution *solution;
  tape t = {.until_failure = -1};
  ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_state_write(solution, tape_record, &t), HR2D_EUNSUPPORTED);
  ck_assert_uint_eq(t.size, 0);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Two plates, and an empty set on them. */
static test_links make_plates(const hr2d_allocator *hooks) {
  const double one = 1, half = 0.5;
  const hr2d_patch floor = {
      .b = {1, 0}, .emission = &one, .emission_bands = 1, .name = "floor"};
  const hr2d_patch roof = {
      .a = {1, 1}, .b = {0, 1}, .reflectance = &half, .reflectance_bands = 1};
  test_links t;
  ck_assert_int_eq(hr2d_scene_create(hooks, &t.scene), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_add(t.scene, &floor, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_add(t.scene, &roof, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(t.scene), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_create(t.scene, &t.hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(t.hierarchy, NULL, NULL, NULL, NULL, &t.links), HR2D_OK);
  return t;
}

static tape plates_tape(void) {
  return tape_of(make_plates(NULL), 0.1);
}

START_TEST(claims_take_no_memory) {
  test_meter m = {0, 0};
  const hr2d_allocator hooks = test_metered(&m);
  tape t = plates_tape();
  test_links links = make_plates(&hooks);
  hr2d_solution *solution = NULL;
  const long long before = m.held;
  m.peak = before;
  /* 4·10⁹ elements, all solved for, and 2⁵⁷ links of 32 coefficients. */
  const uint64_t claim[] = {4000000000, UINT64_C(1) << 57, 4000000000, 32};
  for (size_t k = 0; k < 4; k++)
    for (size_t b = 0; b < 8; b++) t.byte[32 + 8 * k + b] = (unsigned char)(claim[k] >> 8 * b);
  ck_assert_int_eq(hr2d_state_read(links.links, tape_play, &t, &solution), HR2D_ESYNTAX);
  ck_assert_int_le(m.peak - before, 64 * (long long)t.size);
  test_free_links(&links);
  ck_assert_int_eq(m.held, 0);
  free(t.byte);
}
END_TEST

static void check_memory(tape *t, int for_good) {
  long failures = 1;
  for (long k = 0; failures; k++) {
    test_memory memory = {.until_failure = -1};
    const hr2d_allocator hooks = test_hooks(&memory);
    test_links links = make_plates(&hooks);
    hr2d_solution *solution = NULL;
    memory.until_failure = k;
    memory.for_good = for_good;
    t->at = 0;
    const hr2d_status status = hr2d_state_read(links.links, tape_play, t, &solution);
    failures = memory.failures;
    ck_assert_int_eq(status, failures ? HR2D_ENOMEM : HR2D_OK);
    memory.until_failure = -1;
    memory.for_good = 0;
    t->at = 0;
    if (status)
      ck_assert_int_eq(hr2d_state_read(links.links, tape_play, t, &solution), HR2D_OK);
    else
      ck_assert_int_gt(k, 4);
    tape again = write_tape(solution);
    ck_assert_uint_eq(again.size, t->size);
    ck_assert_int_eq(memcmp(again.byte, t->byte, t->size), 0);
    free(again.byte);
    hr2d_solution_destroy(solution);
    test_free_links(&links);
    ck_assert_int_eq(memory.live, 0);
  }
}

START_TEST(any_allocation_may_fail) {
  tape t = plates_tape();
  check_memory(&t, 0);
  check_memory(&t, 1);
  free(t.byte);
}
END_TEST

TEST_SUITE("state") {
  REPEAT_TESTS(sizeof names / sizeof *names, "all", going_on_from_a_state_gives_the_same_bits);
  ADD_TESTS("all", a_damaged_state_is_refused, a_state_that_was_made_up_does_no_harm,
            a_state_belongs_to_its_scene_and_method, a_state_of_a_half_is_not_one_of_the_whole,
            states_of_a_period_are_read, callbacks_may_fail_and_may_not_interfere,
            a_solution_to_a_target_has_no_state, claims_take_no_memory,
            any_allocation_may_fail);
}
