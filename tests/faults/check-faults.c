/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Allocation k of a call fails, for every k: once, and for good.  The call returns
   HR2D_ENOMEM, its objects are unchanged, the same call then gives the same bits, and no
   memory leaks. */
#include <stdlib.h>
#include <string.h>

#include "support/fault-calls.h"

static const char *of_scene(const fault_stage *s) {
  return hr2d_scene_message(s->scene);
}

static const char *of_links(const fault_stage *s) {
  return hr2d_linkset_message(s->links);
}

static hr2d_status create_scene(fault_stage *s, uint64_t *sum) {
  const hr2d_allocator hooks = test_hooks(&s->memory);
  (void)sum;
  return hr2d_scene_create(&hooks, &s->scene);
}

static hr2d_status add_patch(fault_stage *s, uint64_t *sum) {
  static const double e[] = {1, 2, 3}, rho[] = {.5, .25, .125};
  const hr2d_patch patch = {.a = {3, 3},
                            .b = {4, 5},
                            .name = "a patch with a name that is longer than others",
                            .emission = e,
                            .emission_bands = 3,
                            .reflectance = rho,
                            .reflectance_bands = 3,
                            .sides = HR2D_SIDES_BOTH};
  size_t index = 99;
  const hr2d_status status = hr2d_scene_add(s->scene, &patch, &index);
  return fault_mix_stage(s, sum, status);
}

/* The wavelengths may be set although the patch was not added. */
static hr2d_status add_thermal(fault_stage *s, uint64_t *sum) {
  static const double at[] = {1, 2, 3, 4}, e[] = {.1, .2, .3, .4, .5};
  const hr2d_patch patch = {.a = {3, 3}, .b = {4, 5}, .sides = HR2D_SIDES_BOTH};
  const hr2d_thermal thermal = {.struct_size = sizeof thermal,
                                .given = HR2D_HEAT_TEMPERATURE,
                                .value = 500,
                                .emissivity = e,
                                .emissivity_bands = 5};
  hr2d_status status = hr2d_scene_set_wavelengths(s->scene, at, 4);
  if (!status) status = hr2d_scene_add_thermal(s->scene, &patch, &thermal, NULL);
  return fault_mix_stage(s, sum, status);
}

static double fading(void *ctx, double kelvin, size_t band) {
  (void)ctx;
  return 1 / (1 + kelvin / 1000 + (double)band);
}

/* A table, and a function at a given temperature. */
static hr2d_status add_table(fault_stage *s, uint64_t *sum) {
  static const double at[] = {300, 600}, e[] = {.1, .2};
  const hr2d_patch patch = {.a = {3, 3}, .b = {4, 5}};
  hr2d_thermal thermal = {.struct_size = sizeof thermal,
                          .given = HR2D_HEAT_FLUX,
                          .emissivity = e,
                          .emissivity_bands = 1,
                          .kelvin = at,
                          .kelvins = 2};
  const hr2d_status status = hr2d_scene_add_thermal(s->scene, &patch, &thermal, NULL);
  if (!status) *sum = fault_mix_real(*sum, hr2d_scene_emissivity_at(s->scene, 0, 0, 450));
  return fault_mix_stage(s, sum, status);
}

/* Weights of two bands, one after the other. */
static hr2d_status set_weights(fault_stage *s, uint64_t *sum) {
  static const double weight[] = {.5, -1e-4, .25, 0};
  const hr2d_patch patch = {.a = {3, 3}, .b = {4, 5}};
  const hr2d_thermal thermal = {
      .struct_size = sizeof thermal, .given = HR2D_HEAT_TEMPERATURE, .value = 500};
  hr2d_status status = hr2d_scene_set_weights(s->scene, weight, 1, 2);
  if (!status) status = hr2d_scene_set_weights(s->scene, weight, 2, 2);
  if (!status) status = hr2d_scene_add_thermal(s->scene, &patch, &thermal, NULL);
  return fault_mix_stage(s, sum, status);
}

static hr2d_status add_function(fault_stage *s, uint64_t *sum) {
  const hr2d_patch patch = {.a = {3, 3}, .b = {4, 5}};
  const hr2d_thermal thermal = {.struct_size = sizeof thermal,
                                .given = HR2D_HEAT_TEMPERATURE,
                                .value = 500,
                                .emissivity_of = fading};
  return fault_mix_stage(s, sum, hr2d_scene_add_thermal(s->scene, &patch, &thermal, NULL));
}

static hr2d_status add_gas(fault_stage *s, uint64_t *sum) {
  static const double kappa[] = {1, 1, 1}, emission[] = {1, 2, 3};
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = kappa;
  gas.emission = emission;
  gas.absorption_bands = gas.emission_bands = 3;
  const hr2d_status status = hr2d_scene_add_gas(s->scene, &gas, NULL);
  *sum = fault_mix_count(*sum, hr2d_scene_gases(s->scene));
  return fault_mix_stage(s, sum, status);
}

static hr2d_status set_background(fault_stage *s, uint64_t *sum) {
  static const double sky[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  return fault_mix_stage(s, sum, hr2d_scene_set_background(s->scene, sky, 10));
}

static hr2d_status set_sky(fault_stage *s, uint64_t *sum) {
  static const hr2d_sky_piece piece[] = {{-90, 10}, {10, 80}};
  static const double value[] = {1, 2, 3, 4};
  return fault_mix_stage(s, sum, hr2d_scene_set_sky(s->scene, piece, 2, value, 2));
}

static hr2d_status set_continuous_sky(fault_stage *s, uint64_t *sum) {
  hr2d_sky sky = HR2D_SKY_INIT;
  sky.irradiance = 1;
  sky.sun_elevation = 40;
  sky.tolerance = 1e-3;
  hr2d_status status = hr2d_sky_cie(12, &sky);
  if (!status) status = hr2d_scene_set_continuous_sky(s->scene, &sky, 1);
  return fault_mix_stage(s, sum, status);
}

static hr2d_status set_sun(fault_stage *s, uint64_t *sum) {
  static const hr2d_sun suns[] = {{{1, -2}, 1}, {{0, 0}, 0}, {{-1, -1}, 2}};
  return fault_mix_stage(s, sum, hr2d_scene_set_sun(s->scene, suns, 3));
}

/* The sun may be set although the scene was not committed. */
static hr2d_status commit_sunny(fault_stage *s, uint64_t *sum) {
  static const hr2d_sun sun = {{1, -2}, 1};
  static const hr2d_sky_piece piece = {-20, 30};
  static const double value = 2;
  hr2d_status status = hr2d_scene_set_sun(s->scene, &sun, 1);
  if (!status) status = hr2d_scene_set_sky(s->scene, &piece, 1, &value, 1);
  if (!status) status = hr2d_scene_commit(s->scene);
  for (size_t k = 0; !status && k < hr2d_scene_patches(s->scene); k++)
    *sum = fault_mix_real(*sum, hr2d_scene_sunlight(s->scene, k, 0));
  return fault_mix_stage(s, sum, status);
}

static hr2d_status split_crossings(fault_stage *s, uint64_t *sum) {
  size_t cuts = 0;
  const hr2d_status status = hr2d_scene_split_crossings(s->scene, &cuts);
  if (!status) ck_assert_uint_eq(cuts, 1);
  return fault_mix_stage(s, sum, status);
}

static hr2d_status snap(fault_stage *s, uint64_t *sum) {
  hr2d_snap_report report = {0};
  const hr2d_status status = hr2d_scene_snap(s->scene, 1e-3, &report);
  if (!status) *sum = fault_mix_count(*sum, report.cuts);
  return fault_mix_stage(s, sum, status);
}

static hr2d_status mix_warning(void *ctx, const hr2d_warning *w) {
  uint64_t *sum = ctx;
  *sum = fault_mix(*sum, w->text, strlen(w->text));
  return HR2D_OK;
}

static hr2d_status lint(fault_stage *s, uint64_t *sum) {
  uint64_t found = *sum;
  const hr2d_status status = hr2d_scene_lint(s->scene, mix_warning, &found, NULL);
  if (!status) *sum = found;
  return fault_mix_stage(s, sum, status);
}

static hr2d_status commit(fault_stage *s, uint64_t *sum) {
  const hr2d_status status = hr2d_scene_commit(s->scene);
  for (int e = 0; !status && e < HR2D_EFFECT_COUNT; e++)
    *sum = fault_mix_count(*sum, (uint64_t)hr2d_scene_effect(s->scene, (hr2d_effect)e, NULL));
  return fault_mix_stage(s, sum, status);
}

static hr2d_status force_and_commit(fault_stage *s, uint64_t *sum) {
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++)
    ck_assert_int_eq(hr2d_scene_force(s->scene, (hr2d_effect)e), HR2D_OK);
  return commit(s, sum);
}

static const char geojson[] =
    "{\"type\":\"FeatureCollection\",\"hr2d\":{\"background\":[1,2]},\"features\":[{\"type\":"
    "\"Feature\",\"properties\":{\"name\":\"room\",\"reflectance\":[0.5,0.9],\"emission\":0.25,"
    "\"sides\":\"both\"},\"geometry\":{\"type\":\"MultiPolygon\",\"coordinates\":[[[[0,0],[2,0]"
    ","
    "[2,1],[0,1],[0,0]],[[0.5,0.5],[1,0.5],[1,0.75],[0.5,0.5]]]]}}]}";

static hr2d_status parse_geojson(fault_stage *s, uint64_t *sum) {
  return fault_mix_stage(s, sum, hr2d_scene_parse(s->scene, geojson, sizeof geojson - 1));
}

static const char warm[] =
    "{\"type\":\"FeatureCollection\",\"hr2d\":{\"wavelengths\":[3,8],\"background_"
    "temperature\":"
    "300},\"features\":[{\"type\":\"Feature\",\"properties\":{\"temperature\":900,"
    "\"emissivity\":[0.5,0.9,1]},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[0,0],"
    "[2,0],[2,1]]}}]}";

static hr2d_status parse_thermal(fault_stage *s, uint64_t *sum) {
  return fault_mix_stage(s, sum, hr2d_scene_parse(s->scene, warm, sizeof warm - 1));
}

static const char sunny[] =
    "{\"type\":\"FeatureCollection\",\"hr2d\":{\"background\":1,\"sun\":{\"bearing\":[30,60],"
    "\"irradiance\":800},\"sky\":[[-90,0,[1,2]],[0,90,3]]},\"features\":[{\"type\":\"Feature\","
    "\"properties\":{},"
    "\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[0,0],[2,0],[2,1]]}}]}";

static hr2d_status parse_sunny(fault_stage *s, uint64_t *sum) {
  return fault_mix_stage(s, sum, hr2d_scene_parse(s->scene, sunny, sizeof sunny - 1));
}

static hr2d_status read_file(fault_stage *s, uint64_t *sum, const char *name) {
  return fault_mix_stage(s, sum, hr2d_scene_read(s->scene, test_scene_path(name)));
}

static hr2d_status read_geojson(fault_stage *s, uint64_t *sum) {
  return read_file(s, sum, "furnace.geojson");
}

static hr2d_status read_vs2(fault_stage *s, uint64_t *sum) {
  return read_file(s, sum, "blk1.vs2");
}

static hr2d_status create_hierarchy(fault_stage *s, uint64_t *sum) {
  hr2d_hierarchy *made = NULL;
  const hr2d_status status = hr2d_hierarchy_create(s->scene, &made);
  ck_assert((made != NULL) == !status);
  if (!status) *sum = fault_mix_count(*sum, hr2d_hierarchy_count(made).elements);
  hr2d_hierarchy_destroy(made);
  return status;
}

static void destroyed(void *ctx) {
  (*(int *)ctx)++;
}

/* On failure the caller keeps the contexts. */
static hr2d_status create_links(fault_stage *s, uint64_t *sum) {
  hr2d_oracle oracle = *hr2d_oracle_size();
  hr2d_policy policy = *hr2d_policy_modified();
  hr2d_linkset *made = NULL;
  int count = 0;
  (void)sum;
  oracle.destroy = policy.destroy = destroyed;
  const hr2d_status status =
      hr2d_linkset_create(s->hierarchy, &oracle, &count, &policy, &count, &made);
  ck_assert((made != NULL) == !status);
  ck_assert_int_eq(count, 0);
  hr2d_linkset_destroy(made);
  ck_assert_int_eq(count, status ? 0 : 2);
  return status;
}

static hr2d_status refine(fault_stage *s, uint64_t *sum) {
  const hr2d_refine_options o = test_options(0.15, 5);
  return fault_mix_stage(s, sum, hr2d_refine(s->links, &o));
}

/* The error is a length. */
static hr2d_status refine_finely(fault_stage *s, uint64_t *sum) {
  const hr2d_refine_options o = test_options(0.001, 5);
  return fault_mix_stage(s, sum, hr2d_refine(s->links, &o));
}

static hr2d_status refine_ordered(fault_stage *s, uint64_t *sum) {
  hr2d_refine_options o = test_options(0.15, 5);
  o.ordered = 1;
  return fault_mix_stage(s, sum, hr2d_refine(s->links, &o));
}

static hr2d_status refine_by_brightness(fault_stage *s, uint64_t *sum) {
  hr2d_refine_options o = test_options(0.02, 5);
  o.brightness = s->solution;
  return fault_mix_stage(s, sum, hr2d_refine(s->links, &o));
}

static hr2d_status count(fault_stage *s, uint64_t *sum) {
  const hr2d_refine_options o = test_options(0.05, 8);
  return fault_count(s, sum, &o);
}

static hr2d_status count_by_three(fault_stage *s, uint64_t *sum) {
  hr2d_refine_options o = test_options(0.005, 9);
  o.threads = 3;
  return fault_count(s, sum, &o);
}

static hr2d_status look(void *ctx, const hr2d_link *links, size_t count_of_links) {
  *(uint64_t *)ctx = fault_mix(*(uint64_t *)ctx, links, count_of_links * sizeof *links);
  return HR2D_OK;
}

static hr2d_status visit(fault_stage *s, uint64_t *sum) {
  const hr2d_refine_options o = test_options(0.15, 5);
  hr2d_refine_counts counts;
  return fault_mix_stage(s, sum, hr2d_refine_visit(s->links, &o, look, sum, &counts));
}

static hr2d_status study(fault_stage *s, uint64_t *sum) {
  static const double epsilon[] = {0.7, 0.3, 0.15};
  const hr2d_refine_options o = test_options(1, 5);
  return fault_study(s, sum, &o, epsilon, 3);
}

static hr2d_status law(fault_stage *s, uint64_t *sum) {
  hr2d_study_constants constants;
  const hr2d_status status = hr2d_study_law(s->links, NULL, &constants);
  if (!status) *sum = fault_mix(*sum, &constants, sizeof constants);
  return fault_mix_stage(s, sum, status);
}

static hr2d_status validate(fault_stage *s, uint64_t *sum) {
  return fault_mix_stage(s, sum, hr2d_linkset_validate(s->links));
}

static hr2d_status solve(fault_stage *s, uint64_t *sum) {
  return fault_solve(s, sum, NULL);
}

static hr2d_status solve_otherwise(fault_stage *s, uint64_t *sum) {
  hr2d_solve_options how = HR2D_SOLVE_OPTIONS_INIT;
  how.closure = HR2D_CLOSURE_OFF;
  how.start = s->solution;
  how.threads = 2;
  return fault_solve(s, sum, &how);
}

static hr2d_status gather(fault_stage *s, uint64_t *sum) {
  static const double t[] = {0, 0.25, 0.3, 1};
  double value[8];
  const hr2d_status status = hr2d_solution_gather(s->solution, 0, t, 4, value);
  if (!status) *sum = fault_mix(*sum, value, sizeof value);
  return status;
}

static hr2d_status field(fault_stage *s, uint64_t *sum) {
  static const hr2d_point at[] = {{.5, .5}, {0, 0}, {.1, .7}, {-30, 2}};
  double mean[8] = {0}, flux[16] = {0}, error[8], sky[4];
  const hr2d_account account = {.sup = {1e-3, 1e-2}};
  const hr2d_field_options how = {.struct_size = sizeof how, .threads = 2, .account = &account};
  const hr2d_field_values values = {
      .struct_size = sizeof values, .mean = mean, .flux = flux, .error = error, .sky = sky};
  const hr2d_status status = hr2d_field_at(s->solution, at, 4, &how, &values);
  if (!status) *sum = fault_mix(*sum, mean, sizeof mean);
  if (!status) *sum = fault_mix(*sum, flux, sizeof flux);
  return status;
}

static hr2d_status field_grid(fault_stage *s, uint64_t *sum) {
  double mean[2 * 40 * 20] = {0};
  const hr2d_field_grid grid = {sizeof grid, {-.5, -.5}, {1.5, 1.5}, 40, 20, .01};
  const hr2d_field_options how = {.struct_size = sizeof how, .threads = 2};
  const hr2d_field_values values = {.struct_size = sizeof values, .mean = mean};
  const hr2d_status status = hr2d_field_on_grid(s->solution, &grid, &how, &values, NULL);
  if (!status) *sum = fault_mix(*sum, mean, sizeof mean);
  return status;
}

static hr2d_status mix_row(void *ctx, const hr2d_field_row *row) {
  uint64_t *sum = ctx;
  *sum = fault_mix_count(*sum, row->count);
  for (size_t k = 0; k < row->count; k++) *sum = fault_mix_real(*sum, row->factor[k]);
  return HR2D_OK;
}

static hr2d_status field_rows(fault_stage *s, uint64_t *sum) {
  static const hr2d_point at[] = {{.5, .5}, {0, 0}, {.1, .7}, {-30, 2}};
  uint64_t rows = 0;
  const hr2d_status status =
      hr2d_field_rows_visit(s->scene, at, at + 2, 2, NULL, mix_row, &rows);
  if (!status) *sum = fault_mix_count(*sum, rows);
  return status;
}

static hr2d_status matrix(fault_stage *s, uint64_t *sum) {
  hr2d_matrix_options how = HR2D_MATRIX_OPTIONS_INIT;
  how.threads = 1;
  return fault_matrix(s, sum, &how);
}

static hr2d_status matrix_by_three(fault_stage *s, uint64_t *sum) {
  hr2d_matrix_options how = HR2D_MATRIX_OPTIONS_INIT;
  how.threads = 3;
  return fault_matrix(s, sum, &how);
}

static hr2d_status area(fault_stage *s, uint64_t *sum) {
  const hr2d_allocator hooks = test_hooks(&s->memory);
  const hr2d_segment i = {{0, 0}, {4, 0}}, j = {{4, 1}, {0, 1}};
  hr2d_segment occluder[40];
  double value;
  for (int k = 0; k < 40; k++)
    occluder[k] = (hr2d_segment){{.1 * k, .5}, {.1 * k + .05, .5 + .01 * (k % 7)}};
  const hr2d_status status = hr2d_exchange_area_occluded(&i, &j, occluder, 40, &hooks, &value);
  if (!status) *sum = fault_mix_real(*sum, value);
  return status;
}

static hr2d_status adopt(fault_stage *s, uint64_t *sum) {
  static double field[4096];
  hr2d_solution *made = NULL;
  ck_assert_uint_le(
      4 * hr2d_hierarchy_count(s->hierarchy).elements * hr2d_scene_bands(s->scene), 4096);
  const hr2d_status status = hr2d_solution_adopt(s->links, NULL, field, &made);
  if (!status) *sum = fault_mix_real(*sum, hr2d_solution_average(made, 0, 0));
  hr2d_solution_destroy(made);
  return status;
}

static hr2d_status blocks(fault_stage *s, uint64_t *sum) {
  hr2d_link link[20];
  double block[20 * 16];
  for (uint64_t k = 0; k < 20; k++) link[k] = hr2d_linkset_get(s->links, k);
  const hr2d_status status = hr2d_blocks(s->hierarchy, link, 20, block);
  if (!status) *sum = fault_mix(*sum, block, sizeof block);
  return status;
}

static hr2d_status leaf_sums(fault_stage *s, uint64_t *sum) {
  static double front[4096], back[4096];
  const size_t elements = (size_t)hr2d_hierarchy_count(s->hierarchy).elements;
  ck_assert_uint_le(elements, 4096);
  memset(front, 0, sizeof front);
  memset(back, 0, sizeof back);
  const hr2d_status status = hr2d_leaf_sums(s->hierarchy, 0, 0, front, back);
  if (!status) *sum = fault_mix(fault_mix(*sum, front, sizeof front), back, sizeof back);
  return status;
}

/* On a hierarchy of its own, with one division that is not a half. */
static hr2d_status fields(fault_stage *s, uint64_t *sum) {
  hr2d_hierarchy *h = NULL;
  double field[64] = {0};
  uint32_t child;
  hr2d_status status = hr2d_hierarchy_create(s->scene, &h);
  if (!status) status = hr2d_hierarchy_set_order(h, 4);
  for (uint32_t k = 0, of = 0; k < 3 && !status; k++, of = child)
    status = hr2d_hierarchy_divide(h, of, 0.3, &child);
  field[0] = 1;
  if (!status) status = hr2d_hierarchy_push(h, 1, field);
  if (!status) status = hr2d_hierarchy_pull(h, 1, field);
  if (!status) *sum = fault_mix(*sum, field, sizeof field);
  hr2d_hierarchy_destroy(h);
  return status;
}

#define PLAY(...)                                                                              \
  do {                                                                                         \
    const fault_act act = {__VA_ARGS__};                                                       \
    fault_play(&act);                                                                          \
  } while (0)

START_TEST(scenes) {
  PLAY("scene_create", {.depth = DEPTH_NOTHING}, create_scene, NULL, 0);
  PLAY("scene_add", {.depth = DEPTH_SCENE}, add_patch, of_scene, 0);
  PLAY("scene_add to others", {.depth = DEPTH_FILLED, .plan = PLAN_ROOM}, add_patch, of_scene,
       0);
  PLAY("scene_add_thermal", {.depth = DEPTH_SCENE}, add_thermal, of_scene, 0);
  PLAY("scene_set_weights", {.depth = DEPTH_SCENE}, set_weights, of_scene, 0);
  PLAY("scene_add_thermal, table", {.depth = DEPTH_SCENE}, add_table, of_scene, 0);
  PLAY("scene_add_thermal, function", {.depth = DEPTH_SCENE}, add_function, of_scene, 0);
  PLAY("scene_add_gas", {.depth = DEPTH_SCENE}, add_gas, of_scene, 0);
  PLAY("scene_parse, thermal", {.depth = DEPTH_SCENE}, parse_thermal, of_scene, 0);
  PLAY("scene_set_background", {.depth = DEPTH_FILLED, .plan = PLAN_OPEN}, set_background,
       of_scene, 0);
  PLAY("scene_set_sky", {.depth = DEPTH_FILLED, .plan = PLAN_OPEN}, set_sky, of_scene, 0);
  PLAY("scene_set_continuous_sky", {.depth = DEPTH_FILLED, .plan = PLAN_OPEN},
       set_continuous_sky, of_scene, 0);
  PLAY("scene_set_sun", {.depth = DEPTH_FILLED, .plan = PLAN_OPEN}, set_sun, of_scene, 0);
  PLAY("scene_commit, sun", {.depth = DEPTH_FILLED, .plan = PLAN_PAIR}, commit_sunny, of_scene,
       0);
  PLAY("scene_commit, images", {.depth = DEPTH_FILLED, .plan = PLAN_IMAGES}, commit, of_scene,
       3);
  PLAY("scene_commit, plates", {.depth = DEPTH_FILLED, .plan = PLAN_PLATES}, commit, of_scene,
       9);
  PLAY("scene_parse, sun", {.depth = DEPTH_FILLED, .plan = PLAN_PAIR}, parse_sunny, of_scene,
       0);
  PLAY("scene_parse", {.depth = DEPTH_FILLED, .plan = PLAN_OPEN}, parse_geojson, of_scene, 0);
  PLAY("scene_read", {.depth = DEPTH_SCENE}, read_geojson, of_scene, 0);
  PLAY("scene_read of .vs2", {.depth = DEPTH_SCENE}, read_vs2, of_scene, 0);
  PLAY("scene_split_crossings", {.depth = DEPTH_FILLED, .plan = PLAN_CROSSING}, split_crossings,
       of_scene, 0);
  PLAY("scene_commit", {.depth = DEPTH_FILLED, .plan = PLAN_ROOM}, commit, of_scene, 0);
  PLAY("scene_commit, in part dark", {.depth = DEPTH_FILLED, .plan = PLAN_OPEN}, commit,
       of_scene, 0);
  PLAY("scene_commit, all forced", {.depth = DEPTH_FILLED, .plan = PLAN_ROOM}, force_and_commit,
       of_scene, 0);
  PLAY("scene_snap", {.depth = DEPTH_FILLED, .plan = PLAN_CROSSING}, snap, of_scene, 0);
  PLAY("scene_lint", {.depth = DEPTH_FILLED, .plan = PLAN_CROSSING}, lint, NULL, 0);
  PLAY("scene_lint, open", {.depth = DEPTH_COMMITTED, .plan = PLAN_OPEN}, lint, NULL, 0);
  PLAY("scene_lint, room", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, lint, NULL, 0);
  PLAY("scene_commit, many", {.depth = DEPTH_FILLED, .plan = PLAN_BLOCKS}, commit, of_scene,
       60);
}
END_TEST

START_TEST(refinements) {
  static const char *const oracles[] = {"size", "size2", "bf", "l1", "l1-grid", "bounds"};
  static const char *const policies[] = {"original", "modified"};
  PLAY("hierarchy_create", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, create_hierarchy,
       NULL, 0);
  PLAY("linkset_create", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, create_links, NULL, 0);
  for (size_t k = 0; k < sizeof oracles / sizeof *oracles; k++)
    for (size_t m = 0; m < sizeof policies / sizeof *policies; m++) {
      const hr2d_oracle *oracle = hr2d_oracle_find(oracles[k]);
      const hr2d_policy *policy = hr2d_policy_find(policies[m]);
      hr2d_status (*call)(fault_stage *, uint64_t *) =
          strncmp(oracles[k], "l1", 2) && strcmp(oracles[k], "bounds") ? refine : refine_finely;
      char name[64];
      snprintf(name, sizeof name, "refine, %s, %s", oracles[k], policies[m]);
      PLAY(name,
           {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM, .oracle = oracle, .policy = policy},
           call, of_links, 60);
      snprintf(name, sizeof name, "refine again, %s, %s", oracles[k], policies[m]);
      PLAY(name,
           {.depth = DEPTH_REFINED, .plan = PLAN_ROOM, .oracle = oracle, .policy = policy},
           call, of_links, 60);
    }
  PLAY("refine, images", {.depth = DEPTH_COMMITTED, .plan = PLAN_IMAGES}, refine, of_links, 0);
  PLAY("refine, open", {.depth = DEPTH_COMMITTED, .plan = PLAN_OPEN}, refine, of_links, 0);
  PLAY("refine, clear", {.depth = DEPTH_COMMITTED, .plan = PLAN_PAIR}, refine, of_links, 0);
  PLAY("refine, ordered", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, refine_ordered,
       of_links, 0);
  PLAY("refine, by brightness",
       {.depth = DEPTH_SOLVED, .plan = PLAN_ROOM, .oracle = hr2d_oracle_bf()},
       refine_by_brightness, of_links, 0);
  PLAY("refine, many", {.depth = DEPTH_COMMITTED, .plan = PLAN_BLOCKS}, refine, of_links, 6);
}
END_TEST

START_TEST(counts) {
  PLAY("refine_count", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, count, of_links, 60);
  PLAY("refine_count, bf",
       {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM, .oracle = hr2d_oracle_bf()}, count,
       of_links, 60);
  PLAY("refine_count by 3", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, count_by_three,
       of_links, 60);
  PLAY("refine_visit", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, visit, of_links, 60);
  PLAY("solution_adopt", {.depth = DEPTH_REFINED, .plan = PLAN_ROOM, .order = 4}, adopt,
       of_links, 0);
  PLAY("blocks", {.depth = DEPTH_REFINED, .plan = PLAN_ROOM, .order = 4}, blocks, NULL, 0);
  PLAY("leaf_sums", {.depth = DEPTH_REFINED, .plan = PLAN_ROOM}, leaf_sums, NULL, 0);
  PLAY("leaf_sums, open", {.depth = DEPTH_REFINED, .plan = PLAN_OPEN}, leaf_sums, NULL, 0);
  PLAY("hierarchy_push and _pull", {.depth = DEPTH_COMMITTED, .plan = PLAN_PAIR}, fields, NULL,
       0);
  PLAY("study_run", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, study, of_links, 0);
  PLAY("study_law", {.depth = DEPTH_COMMITTED, .plan = PLAN_OPEN, .oracle = hr2d_oracle_l1()},
       law, of_links, 0);
  PLAY("linkset_validate", {.depth = DEPTH_REFINED, .plan = PLAN_ROOM}, validate, of_links, 0);
  PLAY("linkset_validate, directed",
       {.depth = DEPTH_REFINED, .plan = PLAN_OPEN, .oracle = hr2d_oracle_bf()}, validate,
       of_links, 0);
}
END_TEST

START_TEST(solutions) {
  PLAY("solve", {.depth = DEPTH_REFINED, .plan = PLAN_ROOM}, solve, of_links, 0);
  PLAY("solve, open", {.depth = DEPTH_REFINED, .plan = PLAN_OPEN}, solve, of_links, 0);
  PLAY("solve, heat", {.depth = DEPTH_REFINED, .plan = PLAN_HEAT}, solve, of_links, 60);
  PLAY("solve, directed",
       {.depth = DEPTH_REFINED, .plan = PLAN_ROOM, .oracle = hr2d_oracle_bf()}, solve, of_links,
       0);
  PLAY("solve, order 4", {.depth = DEPTH_REFINED, .plan = PLAN_ROOM, .order = 4}, solve,
       of_links, 60);
  PLAY("solve, gas", {.depth = DEPTH_REFINED, .plan = PLAN_GAS}, solve, of_links, 60);
  PLAY("solve, gas, order 4", {.depth = DEPTH_REFINED, .plan = PLAN_GAS, .order = 4}, solve,
       of_links, 60);
  PLAY("solve, open, gas", {.depth = DEPTH_REFINED, .plan = PLAN_OPEN_GAS, .order = 3}, solve,
       of_links, 60);
  PLAY("solve, open, order 4", {.depth = DEPTH_REFINED, .plan = PLAN_OPEN, .order = 4}, solve,
       of_links, 60);
  PLAY("solve, warm, no closure", {.depth = DEPTH_SOLVED, .plan = PLAN_PAIR}, solve_otherwise,
       of_links, 0);
  PLAY("solve, warm, order 4", {.depth = DEPTH_SOLVED, .plan = PLAN_PAIR, .order = 4},
       solve_otherwise, of_links, 0);
  PLAY("solution_gather", {.depth = DEPTH_SOLVED, .plan = PLAN_ROOM}, gather, NULL, 0);
  PLAY("solution_gather, open", {.depth = DEPTH_SOLVED, .plan = PLAN_OPEN, .order = 4}, gather,
       NULL, 0);
  PLAY("field_at", {.depth = DEPTH_SOLVED, .plan = PLAN_ROOM}, field, NULL, 0);
  PLAY("field_on_grid", {.depth = DEPTH_SOLVED, .plan = PLAN_ROOM}, field_grid, NULL, 0);
  PLAY("field_at, no plane, order 4", {.depth = DEPTH_SOLVED, .plan = PLAN_PAIR, .order = 4},
       field, NULL, 0);
}
END_TEST

START_TEST(exchanges) {
  PLAY("field_rows_visit", {.depth = DEPTH_COMMITTED, .plan = PLAN_OPEN}, field_rows, NULL, 0);
  PLAY("exchange_matrix", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, matrix, NULL, 0);
  PLAY("exchange_matrix by 3", {.depth = DEPTH_COMMITTED, .plan = PLAN_OPEN}, matrix_by_three,
       NULL, 0);
  PLAY("exchange_area_occluded", {.depth = DEPTH_NOTHING}, area, NULL, 0);
}
END_TEST

START_TEST(failures_are_seen) {
  /* Negative control: the hooks are really used, and a leak would be counted. */
  test_memory memory = {.until_failure = 0, .for_good = 1};
  hr2d_scene *scene = NULL;
  const hr2d_allocator hooks = test_hooks(&memory);
  ck_assert_int_eq(hr2d_scene_create(&hooks, &scene), HR2D_ENOMEM);
  memory.until_failure = -1;
  ck_assert_int_eq(hr2d_scene_create(&hooks, &scene), HR2D_OK);
  ck_assert_int_eq(memory.live, 1);
  hr2d_scene_destroy(scene);
  hr2d_allocator missing = test_hooks(&memory);
  missing.reallocate = NULL;
  ck_assert_int_eq(hr2d_scene_create(&missing, &scene), HR2D_EINVAL);
}
END_TEST

TEST_SUITE("faults") {
  ADD_TESTS("memory", scenes, refinements, counts, solutions, exchanges, failures_are_seen);
}
