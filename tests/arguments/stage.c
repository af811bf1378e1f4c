/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "arguments/stage.h"

#include <stdlib.h>
#include <string.h>

#include "support/support.h"

hr2d_status on_near_pairs_fn(void *ctx, const hr2d_pair *pairs, size_t count) {
  (void)ctx, (void)pairs, (void)count;
  return HR2D_OK;
}

hr2d_status on_field_row_fn(void *ctx, const hr2d_field_row *row) {
  (void)ctx, (void)row;
  return HR2D_OK;
}

hr2d_status on_warning_fn(void *ctx, const hr2d_warning *warning) {
  (void)ctx, (void)warning;
  return HR2D_OK;
}

hr2d_status on_visitor(void *ctx, const hr2d_link *links, size_t count) {
  (void)ctx, (void)links, (void)count;
  return HR2D_OK;
}

hr2d_status on_write_fn(void *ctx, const void *bytes, size_t size) {
  (void)ctx, (void)bytes, (void)size;
  return HR2D_OK;
}

hr2d_status on_exchange_row_fn(void *ctx, const hr2d_exchange_row *row) {
  (void)ctx, (void)row;
  return HR2D_OK;
}

hr2d_status on_beam_fn(void *ctx, const hr2d_beam *beam) {
  (void)ctx, (void)beam;
  return HR2D_OK;
}

hr2d_status on_progress_fn(void *ctx, const hr2d_progress *progress) {
  (void)ctx, (void)progress;
  return HR2D_OK;
}

hr2d_status read_state(void *ctx, void *bytes, size_t size) {
  return tape_play(&((stage *)ctx)->state, bytes, size);
}

hr2d_status read_scene(void *ctx, void *bytes, size_t size) {
  return tape_play(&((stage *)ctx)->scene_state, bytes, size);
}

/* The values of one share alone are those of all. */
static hr2d_status combine(void *ctx, hr2d_status status, hr2d_combine how, double *value,
                           size_t count) {
  (void)ctx, (void)how, (void)value, (void)count;
  return status;
}

static void *allocate(void *ctx, size_t bytes) {
  (void)ctx;
  return malloc(bytes);
}

static void *reallocate(void *ctx, void *block, size_t bytes) {
  (void)ctx;
  return realloc(block, bytes);
}

static void release(void *ctx, void *block) {
  (void)ctx;
  free(block);
}

void *cut(stage *s, const void *whole, size_t size) {
  const size_t room = size < sizeof size ? sizeof size : size;
  void *copy = malloc(room);
  ck_assert(copy && s->cuts < STAGE_CUTS);
  memcpy(copy, whole, room);
  memcpy(copy, &size, sizeof size);
  s->cut[s->cuts++] = copy;
  return copy;
}

/* A room whose wall "wall" is lit, and a wall in it. */
static hr2d_scene *draw(void) {
  static const double x[] = {0, 2, 2, 0, 0}, y[] = {0, 0, 2, 2, 0};
  static const double emission[] = {1, 2}, reflectance[] = {0.5, 0.25};
  hr2d_scene *scene;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (int k = 0; k < 5; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.name = k ? NULL : "wall";
    patch.a = k < 4 ? (hr2d_point){x[k], y[k]} : (hr2d_point){1, 0.5};
    patch.b = k < 4 ? (hr2d_point){x[k + 1], y[k + 1]} : (hr2d_point){1.25, 1};
    patch.reflectance = reflectance;
    patch.reflectance_bands = 2;
    if (k == 0) patch.emission = emission;
    if (k == 0) patch.emission_bands = 2;
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  return scene;
}

/* So coarse that refinements and solves, of which there are two for most calls, take as long as
   a call, and fine enough for the links and children that are asked for. */
#define COARSE 1.0

static void solve(const hr2d_scene *scene, hr2d_hierarchy **hierarchy, hr2d_linkset **links,
                  hr2d_solution **solution) {
  hr2d_refine_options coarse = HR2D_REFINE_OPTIONS_INIT;
  coarse.epsilon = COARSE;
  hr2d_status status = hr2d_hierarchy_create(scene, hierarchy);
  if (!status) status = hr2d_linkset_create(*hierarchy, NULL, NULL, NULL, NULL, links);
  if (!status && solution) status = hr2d_refine(*links, &coarse);
  if (!status && solution) status = hr2d_solve(*links, NULL, solution);
  ck_assert_int_eq(status, HR2D_OK);
  if (solution)
    ck_assert_uint_gt(hr2d_hierarchy_count(*hierarchy).elements, hr2d_scene_patches(scene));
}

static hr2d_scene *draw_pair(void) {
  hr2d_scene *scene;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (int k = 0; k < 2; k++) {
    const double emission = 1;
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = k ? (hr2d_point){1, 1} : (hr2d_point){0, 0};
    patch.b = k ? (hr2d_point){0, 1} : (hr2d_point){1, 0};
    patch.emission = &emission;
    patch.emission_bands = 1;
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

static void make_objects(stage *s) {
  s->scene = draw();
  const hr2d_gas none = HR2D_GAS_INIT;
  ck_assert_int_eq(hr2d_scene_add_gas(s->scene, &none, NULL), HR2D_OK);
  s->drawn = draw();
  s->mirrored = draw();
  ck_assert_int_eq(hr2d_scene_create(NULL, &s->empty), HR2D_OK);
  const hr2d_segment line = {{-1, 0}, {-1, 1}};
  ck_assert_int_eq(hr2d_scene_add_mirror(s->mirrored, line), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(s->mirrored), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(s->scene), HR2D_OK);
  solve(s->scene, &s->hierarchy, &s->links, &s->solution);
  solve(s->scene, &s->other_hierarchy, &s->other_links, &s->other);
  solve(s->scene, &s->free_hierarchy, &s->free_links, NULL);
  s->pair = draw_pair();
  solve(s->pair, &s->pair_hierarchy, &s->pair_links, NULL);
  ck_assert_int_eq(hr2d_clusters_create(s->scene, NULL, on_near_pairs_fn, NULL, &s->clusters),
                   HR2D_OK);
  ck_assert_int_eq(hr2d_exchange_rows_create(s->scene, NULL, &s->rows, NULL), HR2D_OK);
  const hr2d_enclose_options how = {.struct_size = sizeof how, .gap = 1};
  const hr2d_status status = hr2d_enclose(s->scene, &how, &s->enclosure, NULL);
  ck_assert(status == HR2D_OK || status == HR2D_EACCURACY);
  const hr2d_target rough = {.struct_size = sizeof rough, .error = 0.1};
  ck_assert_int_eq(hr2d_operator_create(s->scene, &rough, &s->op, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_operator_solve(s->op, NULL, NULL, &s->op_solution, NULL), HR2D_OK);
  s->state.until_failure = s->scene_state.until_failure = -1;
  ck_assert_int_eq(hr2d_state_write(s->solution, tape_record, &s->state), HR2D_OK);
  ck_assert_int_eq(hr2d_state_write_scene(s->scene, tape_record, &s->scene_state), HR2D_OK);
  ck_assert_uint_eq(hr2d_linkset_read(s->links, 0, 8, s->link), 8);
}

static void make_arrays(stage *s) {
  for (int k = 0; k < STAGE_NUMBERS; k++) s->half[k] = 0.5;
  s->point[0] = (hr2d_point){0.5, 0.5};
  s->point[1] = (hr2d_point){1.5, 1.5};
  s->segment[0] = (hr2d_segment){{0, 0}, {1, 0}};
  s->segment[1] = (hr2d_segment){{1, 1}, {0, 1}};
  s->segment[2] = (hr2d_segment){{0.25, 0.5}, {0.5, 0.5}};
  s->sun = (hr2d_sun){{0, -1}, 1};
  s->piece = (hr2d_sky_piece){1, 2};
  for (int k = 0; k < 4; k++) {
    s->row[k].counts.elements = 10u << k;
    s->row[k].counts.links = 20u << k;
  }
  s->file =
      "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{},"
      "\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[5,5],[6,5]]}}]}";
  s->path = test_scene_path("square-room.geojson");
  memset(s->broken, 0xA0, sizeof s->broken - 1);
}

static void make_structs(stage *s) {
  s->good_allocator = (hr2d_allocator){allocate, reallocate, release, NULL};
  s->good_oracle = *hr2d_oracle_size();
  s->good_policy = *hr2d_policy_original();
  s->good_patch = (hr2d_patch){.a = {5, 5}, .b = {6, 5}};
  s->good_sky = (hr2d_sky){.struct_size = sizeof s->good_sky, .irradiance = 1};
  s->good_thermal = (hr2d_thermal){
      .struct_size = sizeof s->good_thermal, .given = HR2D_HEAT_TEMPERATURE, .value = 300};
  s->good_gas = (hr2d_gas){.struct_size = sizeof s->good_gas,
                           .absorption = s->half,
                           .absorption_bands = 1,
                           .emission = s->half,
                           .emission_bands = 1};
  s->good_share =
      (hr2d_share){.struct_size = sizeof s->good_share, .count = 1, .combine = combine};
  s->good_target = (hr2d_target)HR2D_TARGET_INIT;
  s->good_target.error = 0.1;
  s->good_target.important = &s->size;
  s->good_target.important_count = 1;
  s->good_light = (hr2d_light)HR2D_LIGHT_INIT;
  s->good_values = (hr2d_values){s->half, {0, 0, 0}};
  s->good_gradient = (hr2d_gradient)HR2D_GRADIENT_INIT;
  s->good_enclose_options = (hr2d_enclose_options)HR2D_ENCLOSE_OPTIONS_INIT;
  s->good_enclose_options.gap = 1;
  s->good_refine_options = (hr2d_refine_options)HR2D_REFINE_OPTIONS_INIT;
  s->good_refine_options.epsilon = COARSE;
  s->good_refine_options.row_counts = s->row_counts;
  s->good_solve_options = (hr2d_solve_options)HR2D_SOLVE_OPTIONS_INIT;
  s->good_matrix_options = (hr2d_matrix_options)HR2D_MATRIX_OPTIONS_INIT;
  s->good_clusters_options = (hr2d_clusters_options)HR2D_CLUSTERS_OPTIONS_INIT;
  s->good_field_options = (hr2d_field_options)HR2D_FIELD_OPTIONS_INIT;
  s->good_lint_options = (hr2d_lint_options)HR2D_LINT_OPTIONS_INIT;
  s->good_past_options = (hr2d_past_options){.struct_size = sizeof s->good_past_options};
  s->good_field_grid = (hr2d_field_grid)HR2D_FIELD_GRID_INIT;
  s->good_field_values = (hr2d_field_values){
      .struct_size = sizeof s->good_field_values, .mean = s->number, .place = s->byte};
  s->good_temperatures = (hr2d_temperatures){
      .struct_size = sizeof s->good_temperatures, .kelvin = s->number, .state = s->byte};
}

stage *stage_make(void) {
  stage *s = calloc(1, sizeof *s);
  ck_assert_ptr_nonnull(s);
  make_objects(s);
  make_arrays(s);
  make_structs(s);
  return s;
}

static void destroy_made(stage *s) {
  hr2d_clusters_destroy(s->made_clusters);
  hr2d_exchange_rows_destroy(s->made_rows);
  hr2d_enclosure_destroy(s->made_enclosure);
  hr2d_operator_destroy(s->made_op);
  hr2d_solution_destroy(s->made_solution);
  hr2d_linkset_destroy(s->made_links);
  hr2d_hierarchy_destroy(s->made_hierarchy);
  hr2d_scene_destroy(s->made_scene);
  s->made_clusters = NULL;
  s->made_rows = NULL;
  s->made_enclosure = NULL;
  s->made_op = NULL;
  s->made_solution = NULL;
  s->made_links = NULL;
  s->made_hierarchy = NULL;
  s->made_scene = NULL;
  while (s->cuts) free(s->cut[--s->cuts]);
}

void stage_renew(stage *s) {
  destroy_made(s);
  memset(s->number, 0, sizeof s->number);
  memset(s->field, 0, sizeof s->field);
  memset(s->index, 0, sizeof s->index);
  s->size = 0;
  make_arrays(s);
  make_structs(s);
}

void stage_end(stage *s) {
  destroy_made(s);
  hr2d_clusters_destroy(s->clusters);
  hr2d_exchange_rows_destroy(s->rows);
  hr2d_enclosure_destroy(s->enclosure);
  hr2d_solution_destroy(s->op_solution);
  hr2d_operator_destroy(s->op);
  hr2d_solution_destroy(s->solution);
  hr2d_solution_destroy(s->other);
  hr2d_linkset_destroy(s->free_links);
  hr2d_linkset_destroy(s->pair_links);
  hr2d_linkset_destroy(s->links);
  hr2d_linkset_destroy(s->other_links);
  hr2d_hierarchy_destroy(s->free_hierarchy);
  hr2d_hierarchy_destroy(s->pair_hierarchy);
  hr2d_hierarchy_destroy(s->hierarchy);
  hr2d_hierarchy_destroy(s->other_hierarchy);
  hr2d_scene_destroy(s->mirrored);
  hr2d_scene_destroy(s->pair);
  hr2d_scene_destroy(s->empty);
  hr2d_scene_destroy(s->drawn);
  hr2d_scene_destroy(s->scene);
  free(s->state.byte);
  free(s->scene_state.byte);
  free(s);
}
