/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fault-stage.h"

#include <string.h>

#define BOUND 1469598103934665603u /* of FNV */

uint64_t fault_mix(uint64_t sum, const void *bytes, size_t size) {
  const unsigned char *at = bytes;
  for (size_t k = 0; k < size; k++) sum = (sum ^ at[k]) * 1099511628211u;
  return sum;
}

uint64_t fault_mix_count(uint64_t sum, uint64_t count) {
  return fault_mix(sum, &count, sizeof count);
}

uint64_t fault_mix_real(uint64_t sum, double value) {
  return fault_mix(sum, &value, sizeof value);
}

static void add(hr2d_scene *scene, const double at[4], const char *name, const double *emission,
                size_t bands, double reflectance, hr2d_sides sides) {
  const hr2d_patch patch = {.a = {at[0], at[1]},
                            .b = {at[2], at[3]},
                            .name = name,
                            .emission = emission,
                            .emission_bands = bands,
                            .reflectance = &reflectance,
                            .reflectance_bands = 1,
                            .sides = sides};
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
}

static void add_room(hr2d_scene *scene, const double *emission, size_t bands) {
  static const double wall[4][4] = {{0, 0, 2, 0}, {2, 0, 2, 1}, {2, 1, 0, 1}, {0, 1, 0, 0}};
  for (int k = 0; k < 4; k++)
    add(scene, wall[k], k ? NULL : "floor", emission, bands, .5, HR2D_SIDES_FRONT);
}

/* Squares under a sky, some of which see little of it. */
static void add_blocks(hr2d_scene *scene, int across) {
  for (int k = 0; k < across * across; k++) {
    const double x = 3 * (k % across), y = 3 * (k / across), e = 0.125 * (k % 5);
    const double at[5][2] = {{x, y}, {x, y + 1}, {x + 1, y + 1}, {x + 1, y}, {x, y}};
    for (int m = 0; m < 4; m++)
      add(scene, (const double[]){at[m][0], at[m][1], at[m + 1][0], at[m + 1][1]}, NULL, &e, 1,
          .25, HR2D_SIDES_FRONT);
  }
}

/* Two rows that face each other, each slightly bent from patch to patch. */
static void add_rows(hr2d_scene *scene, int across) {
  const double e = 1;
  for (int k = 0; k < across; k++) {
    const double x0 = k, x1 = k + 1, y0 = 1e-3 * (k % 2), y1 = 1e-3 * ((k + 1) % 2);
    add(scene, (const double[]){x0, y0, x1, y1}, NULL, k % 7 ? NULL : &e, k % 7 ? 0 : 1, .5,
        HR2D_SIDES_FRONT);
    add(scene, (const double[]){x1, across - y1, x0, across - y0}, NULL, NULL, 0, .25,
        HR2D_SIDES_FRONT);
  }
}

/* One wall of a room has a temperature, the others a flux. */
static void add_heat(hr2d_scene *scene) {
  static const double at[3][4] = {{0, 0, 2, 0}, {2, 0, 0, 1}, {0, 1, 0, 0}};
  static const double wavelength[2] = {3, 8}, emissivity[3] = {.5, .25, 1};
  ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, wavelength, 2), HR2D_OK);
  for (int k = 0; k < 3; k++) {
    const hr2d_patch patch = {.a = {at[k][0], at[k][1]}, .b = {at[k][2], at[k][3]}};
    const hr2d_thermal thermal = {.struct_size = sizeof thermal,
                                  .given = k ? HR2D_HEAT_FLUX : HR2D_HEAT_TEMPERATURE,
                                  .value = k ? 0 : 1000,
                                  .emissivity = emissivity,
                                  .emissivity_bands = 3};
    ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &thermal, NULL), HR2D_OK);
  }
}

static void add_mirror(hr2d_scene *scene, double x) {
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{x, 0}, {x, 1}}), HR2D_OK);
}

static void add_gas(hr2d_scene *scene, size_t bands) {
  static const double kappa[2] = {.5, .25}, hot = 2;
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = kappa;
  gas.absorption_bands = bands;
  gas.emission = &hot;
  gas.emission_bands = 1;
  ck_assert_int_eq(hr2d_scene_add_gas(scene, &gas, NULL), HR2D_OK);
}

static void fill(hr2d_scene *scene, fault_plan plan) {
  static const double dim[2] = {.25, .5}, one = 1, sky[2] = {1, .5};
  switch (plan) {
  case PLAN_ROOM:
    add_room(scene, dim, 2);
    add(scene, (const double[]){.8, .5, 1.25, .625}, "lamp", &one, 1, 0, HR2D_SIDES_BOTH);
    break;
  case PLAN_OPEN:
    add(scene, (const double[]){0, 0, 2, 0}, "street", NULL, 0, .75, HR2D_SIDES_FRONT);
    add(scene, (const double[]){2, 0, 2, 1.5}, NULL, NULL, 0, .25, HR2D_SIDES_FRONT);
    add(scene, (const double[]){1.5, 1, .5, 1.25}, NULL, NULL, 0, .5, HR2D_SIDES_BOTH);
    ck_assert_int_eq(hr2d_scene_set_background(scene, sky, 2), HR2D_OK);
    break;
  case PLAN_PAIR:
    add(scene, (const double[]){0, 0, 1, 0}, NULL, &one, 1, .5, HR2D_SIDES_FRONT);
    add(scene, (const double[]){1, .25, 0, .25}, NULL, NULL, 0, .5, HR2D_SIDES_FRONT);
    break;
  case PLAN_HEAT:
    add_heat(scene);
    break;
  case PLAN_GAS:
    fill(scene, PLAN_ROOM);
    add_gas(scene, 2);
    break;
  case PLAN_OPEN_GAS:
    fill(scene, PLAN_PAIR);
    add_gas(scene, 1);
    break;
  case PLAN_CROSSING:
    add_room(scene, dim, 1);
    add(scene, (const double[]){.5, .25, 1.5, .75}, "bar", &one, 1, 0, HR2D_SIDES_BOTH);
    add(scene, (const double[]){.5, .75, 1.5, .25}, NULL, &one, 1, 0, HR2D_SIDES_BOTH);
    break;
  case PLAN_IMAGES:
    fill(scene, PLAN_OPEN);
    add_mirror(scene, 0);
    ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){5, 0}), HR2D_OK);
    break;
  case PLAN_PLATES:
    fill(scene, PLAN_PAIR);
    add_mirror(scene, 0);
    add_mirror(scene, 1);
    break;
  case PLAN_BLOCKS:
    add_blocks(scene, 9);
    ck_assert_int_eq(hr2d_scene_set_background(scene, sky, 1), HR2D_OK);
    break;
  case PLAN_ROWS:
    add_rows(scene, 220);
    break;
  }
}

void fault_stage_make(fault_stage *s, const fault_setting *setting) {
  *s = (fault_stage){0};
  s->memory.until_failure = -1;
  const hr2d_allocator hooks = test_hooks(&s->memory);
  if (setting->depth < DEPTH_SCENE) return;
  ck_assert_int_eq(hr2d_scene_create(&hooks, &s->scene), HR2D_OK);
  if (setting->depth < DEPTH_FILLED) return;
  fill(s->scene, setting->plan);
  if (setting->depth < DEPTH_COMMITTED) return;
  ck_assert_msg(!hr2d_scene_commit(s->scene), "%s", hr2d_scene_message(s->scene));
  ck_assert_int_eq(hr2d_hierarchy_create(s->scene, &s->hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_set_order(s->hierarchy, setting->order ? setting->order : 1),
                   HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(s->hierarchy, setting->oracle, NULL, setting->policy,
                                       NULL, &s->links),
                   HR2D_OK);
  if (setting->depth < DEPTH_REFINED) return;
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  refine.epsilon = setting->epsilon > 0 ? setting->epsilon : 0.7;
  refine.max_level = 5;
  ck_assert_int_eq(hr2d_refine(s->links, &refine), HR2D_OK);
  if (setting->depth < DEPTH_SOLVED) return;
  ck_assert_int_eq(hr2d_solve(s->links, NULL, &s->solution), HR2D_OK);
}

void fault_stage_end(fault_stage *s) {
  hr2d_solution_destroy(s->result);
  hr2d_solution_destroy(s->solution);
  hr2d_linkset_destroy(s->links);
  hr2d_hierarchy_destroy(s->hierarchy);
  hr2d_scene_destroy(s->scene);
  ck_assert_int_eq(s->memory.live, 0);
}

static uint64_t scene_sum(const hr2d_scene *scene, int committed) {
  uint64_t sum = BOUND;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const hr2d_segment at = hr2d_scene_segment(scene, k);
    const char *name = hr2d_scene_name(scene, k);
    sum = fault_mix(fault_mix(sum, &at, sizeof at), name, strlen(name));
    for (size_t b = 0; committed && b < hr2d_scene_bands(scene); b++)
      sum = fault_mix_real(sum, hr2d_scene_emission(scene, k, b) +
                                    8 * hr2d_scene_reflectance(scene, k, b));
  }
  for (int e = 0; committed && e < HR2D_EFFECT_COUNT; e++)
    sum = fault_mix_count(sum, (uint64_t)hr2d_scene_effect(scene, (hr2d_effect)e, NULL));
  return sum;
}

static uint64_t hierarchy_sum(const hr2d_hierarchy *h) {
  const hr2d_hierarchy_counts n = hr2d_hierarchy_count(h);
  uint64_t sum = fault_mix_count(BOUND, n.levels);
  sum = fault_mix_count(sum, hr2d_hierarchy_order(h));
  for (uint32_t k = 0; k < n.elements; k++) {
    const hr2d_element *e = &hr2d_hierarchy_elements(h)[k];
    sum = fault_mix(sum, &e->a, sizeof e->a);
    sum = fault_mix_count(sum, e->child);
    sum = fault_mix_count(sum, hr2d_element_parent(h, k));
  }
  return sum;
}

uint64_t fault_counts_sum(const hr2d_refine_counts *n) {
  const uint64_t all[] = {n->elements,         n->leaves,         n->links,
                          n->limited_links,    n->oracle_calls,   n->facing_tests,
                          n->visibility_tests, n->exchange_areas, n->partial_links,
                          n->blocked_pairs,    n->dark_pairs,     n->levels};
  return fault_mix(BOUND, all, sizeof all);
}

static uint64_t links_sum(const hr2d_linkset *links) {
  const hr2d_refine_counts counts = hr2d_linkset_counts(links);
  uint64_t sum = fault_counts_sum(&counts);
  sum = fault_mix_count(sum, (uint64_t)hr2d_linkset_directed(links));
  for (uint64_t k = 0; k < hr2d_linkset_size(links); k++) {
    const hr2d_link link = hr2d_linkset_get(links, k);
    sum = fault_mix(sum, &link, sizeof link);
  }
  return sum;
}

uint64_t fault_solution_sum(const hr2d_solution *solution) {
  const hr2d_hierarchy *h = hr2d_linkset_hierarchy(hr2d_solution_links(solution));
  const hr2d_scene *scene = hr2d_hierarchy_scene(h);
  uint64_t sum = fault_mix_real(BOUND, hr2d_solution_residual(solution));
  for (size_t band = 0; band < hr2d_scene_bands(scene); band++) {
    const hr2d_power power = hr2d_solution_power(solution, band);
    sum = fault_mix(sum, &power, sizeof power);
    for (size_t k = 0; k < hr2d_scene_patches(scene); k++)
      for (double t = 0; t <= 1; t += 0.25) {
        sum = fault_mix_real(sum, hr2d_solution_at(solution, k, t, band));
        sum = fault_mix_real(sum, hr2d_solution_irradiance_at(solution, k, t, band));
      }
  }
  return sum;
}

uint64_t fault_stage_sum(const fault_stage *s) {
  uint64_t sum = s->scene ? scene_sum(s->scene, s->hierarchy != NULL) : BOUND;
  if (s->hierarchy) sum = fault_mix_count(sum, hierarchy_sum(s->hierarchy));
  if (s->links) sum = fault_mix_count(sum, links_sum(s->links));
  if (s->solution) sum = fault_mix_count(sum, fault_solution_sum(s->solution));
  return sum;
}

/* Plays once with memory to the end; returns how many allocations that takes. */
static long play_undisturbed(const fault_act *act, uint64_t *sum) {
  fault_stage s;
  fault_stage_make(&s, &act->setting);
  const long many = 1000000000;
  s.memory.until_failure = many;
  *sum = BOUND;
  const hr2d_status status = act->call(&s, sum);
  ck_assert_msg(!status, "%s: %s, %s", act->name, hr2d_strerror(status),
                act->message ? act->message(&s) : "");
  const long allocations = many - s.memory.until_failure;
  s.memory.until_failure = -1;
  fault_stage_end(&s);
  return allocations;
}

/* Allocation k of the call fails.  Returns whether there was one. */
static int play_disturbed(const fault_act *act, long k, int for_good, uint64_t undisturbed) {
  fault_stage s;
  uint64_t sum = BOUND;
  fault_stage_make(&s, &act->setting);
  const uint64_t before = fault_stage_sum(&s);
  s.memory.for_good = for_good;
  s.memory.until_failure = k;
  hr2d_status status = act->call(&s, &sum);
  const int failed = s.memory.failures > 0;
  s.memory.until_failure = -1;
  ck_assert_msg(status == (failed ? HR2D_ENOMEM : HR2D_OK), "%s, allocation %ld, %s: %s",
                act->name, k, for_good ? "for good" : "once", hr2d_strerror(status));
  if (failed) {
    ck_assert_msg(fault_stage_sum(&s) == before, "%s, allocation %ld: objects have changed",
                  act->name, k);
    ck_assert_msg(!s.result, "%s, allocation %ld: a result all the same", act->name, k);
    if (act->message)
      ck_assert_msg(strstr(act->message(&s), "memory") || strstr(act->message(&s), "room"),
                    "%s, allocation %ld: \"%s\"", act->name, k, act->message(&s));
    sum = BOUND;
    status = act->call(&s, &sum);
    ck_assert_msg(!status, "%s, again after allocation %ld: %s", act->name, k,
                  hr2d_strerror(status));
  }
  ck_assert_msg(sum == undisturbed, "%s, allocation %ld: another result", act->name, k);
  fault_stage_end(&s);
  return failed;
}

void fault_play(const fault_act *act) {
  uint64_t undisturbed;
  const long allocations = play_undisturbed(act, &undisturbed);
  const double multiplier = test_multiplier();
  const double max = (act->max ? act->max : 400) * (multiplier < 1 ? multiplier : 1) + 1;
  const double step = (double)allocations > max ? (double)allocations / max : 1;
  long failures = 0;
  const double first = multiplier < 0.1 ? step / 2 : 0; /* the only one, perhaps */
  for (int for_good = 0; for_good < 2; for_good++)
    for (double k = first; k < (double)allocations; k += step)
      failures += play_disturbed(act, (long)k, for_good, undisturbed);
  play_disturbed(act, allocations + 1000, 0, undisturbed);
  printf("%-40s %6ld allocations, %5ld failed\n", act->name, allocations, failures);
  fflush(stdout);
  ck_assert_int_gt(allocations, 0);
  ck_assert_int_gt(failures, 0);
}
