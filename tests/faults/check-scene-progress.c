/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every public call that can take long asks the callback of its scene where its options have
   none: on 10,000 patches each of them is refused at its first question, and says so.

   A function is in one of two lists, and the headers are read to see that none is missing: a
   new one has to be put somewhere. */
#include <check.h>
#include <hr2d/hr2d.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/random.h"
#include "support/settings.h"
#include "support/slow-phases.h"
#include "support/suite.h"

enum { PATCHES = 10000, REFUSAL = 78 };

typedef struct stage {
  slow_stage s;
  hr2d_scene *open; /* a copy that is not committed */
  hr2d_scene *empty;
  hr2d_linkset *new_links;  /* without a link */
  hr2d_hierarchy *new_tree; /* of these */
  hr2d_linkset *spare;      /* the same, to be changed */
  hr2d_hierarchy *spare_tree;
  char *bytes; /* a state or a scene */
  size_t size, at;
  double *field; /* an item per element */
  hr2d_operator *op;
  hr2d_solution *light; /* of it */
} stage;

typedef hr2d_status call_fn(stage *t);

static hr2d_status put(void *ctx, const void *bytes, size_t size) {
  stage *t = ctx;
  char *grown = realloc(t->bytes, t->size + size);
  if (!grown) return HR2D_ENOMEM;
  memcpy(grown + t->size, bytes, size);
  t->bytes = grown;
  t->size += size;
  return HR2D_OK;
}

static hr2d_status get(void *ctx, void *bytes, size_t size) {
  stage *t = ctx;
  if (size > t->size - t->at) return HR2D_ESYNTAX;
  memcpy(bytes, t->bytes + t->at, size);
  t->at += size;
  return HR2D_OK;
}

static hr2d_status no_row(void *ctx, const hr2d_exchange_row *row) {
  (void)ctx;
  return row->patch < PATCHES * 2 ? HR2D_OK : HR2D_EINVAL;
}

static hr2d_status no_field_row(void *ctx, const hr2d_field_row *row) {
  (void)ctx;
  return row->point < PATCHES ? HR2D_OK : HR2D_EINVAL;
}

static hr2d_status no_links(void *ctx, const hr2d_link *links, size_t count) {
  (void)ctx;
  return links || !count ? HR2D_OK : HR2D_EINVAL;
}

static hr2d_status no_near(void *ctx, const hr2d_pair *pairs, size_t count) {
  (void)ctx;
  return pairs || !count ? HR2D_OK : HR2D_EINVAL;
}

static hr2d_status no_warning(void *ctx, const hr2d_warning *warning) {
  (void)ctx;
  return warning->text ? HR2D_OK : HR2D_EINVAL;
}

/* ---- the calls */

static hr2d_status parse(stage *t) {
  return hr2d_scene_parse(t->empty, t->s.text, t->s.size);
}

static hr2d_status split(stage *t) {
  return hr2d_scene_split_crossings(t->open, NULL);
}

static hr2d_status snap(stage *t) {
  return hr2d_scene_snap(t->open, 1e-6, NULL);
}

static hr2d_status commit(stage *t) {
  return hr2d_scene_commit(t->open);
}

static hr2d_status lint(stage *t) {
  return hr2d_scene_lint(t->s.scene, no_warning, NULL, NULL);
}

static hr2d_status leaf_sums(stage *t) {
  return hr2d_leaf_sums(t->s.hierarchy, 0, 0, t->field, NULL);
}

/* Of 10,000 patches the matrix has 800 MB, which a refused call does not touch. */
static hr2d_status matrix(stage *t) {
  const size_t n = hr2d_scene_patches(t->s.scene);
  double *area = malloc(n * n * sizeof *area);
  const hr2d_status status =
      area ? hr2d_exchange_matrix(t->s.scene, NULL, area, NULL) : REFUSAL;
  free(area);
  return status;
}

static hr2d_status rows(stage *t) {
  hr2d_exchange_rows *made = NULL;
  const hr2d_status status = hr2d_exchange_rows_create(t->s.scene, NULL, &made, NULL);
  hr2d_exchange_rows_destroy(made);
  return status;
}

static hr2d_status visit_rows(stage *t) {
  return hr2d_exchange_rows_visit(t->s.scene, NULL, no_row, NULL, NULL);
}

static hr2d_status clusters(stage *t) {
  hr2d_clusters *made = NULL;
  const hr2d_status status = hr2d_clusters_create(t->s.scene, NULL, no_near, NULL, &made);
  hr2d_clusters_destroy(made);
  return status;
}

static hr2d_refine_options coarse(void) {
  hr2d_refine_options o = HR2D_REFINE_OPTIONS_INIT;
  o.epsilon = 10;
  return o;
}

static hr2d_status refine(stage *t) {
  const hr2d_refine_options o = coarse();
  return hr2d_refine(t->spare, &o);
}

static hr2d_status count(stage *t) {
  const hr2d_refine_options o = coarse();
  hr2d_refine_counts counts;
  return hr2d_refine_count(t->new_links, &o, &counts);
}

static hr2d_status visit(stage *t) {
  const hr2d_refine_options o = coarse();
  hr2d_refine_counts counts;
  return hr2d_refine_visit(t->new_links, &o, no_links, NULL, &counts);
}

static hr2d_status study(stage *t) {
  const double epsilon[] = {10, 5};
  const hr2d_refine_options o = coarse();
  hr2d_study_row made[2];
  return hr2d_study_run(t->new_links, &o, epsilon, 2, made, NULL);
}

static hr2d_status law(stage *t) {
  hr2d_study_constants constants;
  return hr2d_study_law(t->new_links, NULL, &constants);
}

static hr2d_status validate(stage *t) {
  return hr2d_linkset_validate(t->s.links);
}

static hr2d_status solve(stage *t) {
  hr2d_solution *made = NULL;
  const hr2d_status status = hr2d_solve(t->s.links, NULL, &made);
  hr2d_solution_destroy(made);
  return status;
}

static hr2d_status solve_to(stage *t) {
  hr2d_solution *made = NULL;
  const hr2d_status status = hr2d_solve_to(t->s.scene, NULL, &made, NULL);
  hr2d_solution_destroy(made);
  return status;
}

static hr2d_status solve_in_time(stage *t) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *made = NULL;
  target.seconds = 1000;
  const hr2d_status status = hr2d_solve_to(t->s.scene, &target, &made, NULL);
  hr2d_solution_destroy(made);
  return status;
}

static hr2d_status predict(stage *t) {
  hr2d_prediction prediction;
  return hr2d_predict(t->s.scene, NULL, &prediction);
}

static hr2d_status make_operator(stage *t) {
  hr2d_operator *made = NULL;
  const hr2d_status status = hr2d_operator_create(t->s.scene, NULL, &made, NULL);
  hr2d_operator_destroy(made);
  return status;
}

static hr2d_status solve_by_operator(stage *t) {
  hr2d_solution *made = NULL;
  const hr2d_status status = hr2d_operator_solve(t->op, NULL, NULL, &made, NULL);
  hr2d_solution_destroy(made);
  return status;
}

static hr2d_status respond(stage *t) {
  double *column = calloc(hr2d_scene_patches(t->s.scene), sizeof *column);
  const hr2d_status status = hr2d_operator_response(t->op, NULL, 0, 1, column);
  free(column);
  return status;
}

static hr2d_status differentiate(stage *t) {
  hr2d_gradient none = HR2D_GRADIENT_INIT;
  return hr2d_operator_gradient(t->op, t->light, NULL, NULL, &none);
}

static hr2d_status enclose(stage *t) {
  hr2d_enclosure *made = NULL;
  const hr2d_status status = hr2d_enclose(t->s.scene, NULL, &made, NULL);
  hr2d_enclosure_destroy(made);
  return status;
}

static hr2d_status find_error(stage *t) {
  hr2d_error error;
  return hr2d_solution_error(t->s.solution, NULL, &error, NULL);
}

static hr2d_status account(stage *t) {
  hr2d_account account;
  return hr2d_solution_account(t->s.solution, NULL, &account);
}

typedef hr2d_status gather_fn(const hr2d_solution *s, size_t patch, const double *t,
                              size_t number, double *value);

/* The floor of the room sees the most. */
static hr2d_status gather_by(stage *t, gather_fn *gather) {
  enum { POINTS = 900 };
  static double at[POINTS], value[POINTS];
  for (size_t k = 0; k < POINTS; k++) at[k] = ((double)k + .5) / POINTS;
  return gather(t->s.solution, 0, at, POINTS, value);
}

static hr2d_status gather(stage *t) {
  return gather_by(t, hr2d_solution_gather);
}

static hr2d_status gather_irradiance(stage *t) {
  return gather_by(t, hr2d_solution_gather_irradiance);
}

static hr2d_status gather_net_flux(stage *t) {
  return gather_by(t, hr2d_solution_gather_net_flux);
}

static hr2d_status beams_of_field(stage *t, int on_grid, int by_rows) {
  enum { SIDE = 40 };
  static double mean[SIDE * SIDE];
  static hr2d_point at[SIDE * SIDE], normal[SIDE * SIDE];
  hr2d_field_grid grid = HR2D_FIELD_GRID_INIT;
  const hr2d_field_values values = {.struct_size = sizeof values, .mean = mean};
  grid.low = (hr2d_point){1, 1};
  grid.high = (hr2d_point){40, 40};
  grid.columns = grid.rows = SIDE;
  if (on_grid) return hr2d_field_on_grid(t->s.solution, &grid, NULL, &values, NULL);
  for (size_t k = 0; k < SIDE * SIDE; k++) {
    at[k] = (hr2d_point){1 + (double)(k % SIDE), 1 + (double)(k / SIDE)};
    normal[k] = (hr2d_point){0, 1};
  }
  return by_rows ? hr2d_field_rows_visit(t->s.scene, at, normal, SIDE * SIDE, NULL,
                                         no_field_row, NULL)
                 : hr2d_field_at(t->s.solution, at, SIDE * SIDE, NULL, &values);
}

static hr2d_status field_at(stage *t) {
  return beams_of_field(t, 0, 0);
}

static hr2d_status field_on_grid(stage *t) {
  return beams_of_field(t, 1, 0);
}

static hr2d_status field_rows(stage *t) {
  return beams_of_field(t, 0, 1);
}

static hr2d_status write_state(stage *t) {
  t->size = 0;
  return hr2d_state_write(t->s.solution, put, t);
}

static hr2d_status read_state(stage *t) {
  hr2d_solution *made = NULL;
  hr2d_scene_set_progress(t->s.scene, NULL, NULL);
  ck_assert_int_eq(write_state(t), HR2D_OK);
  t->at = 0;
  hr2d_scene_set_progress(t->s.scene, t->s.ask, t->s.ctx);
  return hr2d_state_read(t->spare, get, t, &made);
}

static hr2d_status write_scene(stage *t) {
  t->size = 0;
  return hr2d_state_write_scene(t->s.scene, put, t);
}

static hr2d_status read_scene(stage *t) {
  hr2d_scene_set_progress(t->s.scene, NULL, NULL);
  ck_assert_int_eq(write_scene(t), HR2D_OK);
  t->at = 0;
  return hr2d_state_read_scene(t->empty, get, t);
}

static hr2d_status set_sky(stage *t) {
  hr2d_sky sky = HR2D_SKY_INIT;
  sky.irradiance = 1;
  sky.sun_elevation = 40;
  ck_assert_int_eq(hr2d_sky_cie(12, &sky), HR2D_OK);
  return hr2d_scene_set_continuous_sky(t->empty, &sky, 1);
}

/* What can take longer than 10 ms. */
static const struct {
  const char *name;
  call_fn *call;
} long_calls[] = {{"hr2d_scene_parse", parse},
                  {"hr2d_scene_set_continuous_sky", set_sky},
                  {"hr2d_scene_split_crossings", split},
                  {"hr2d_scene_snap", snap},
                  {"hr2d_scene_commit", commit},
                  {"hr2d_scene_lint", lint},
                  {"hr2d_leaf_sums", leaf_sums},
                  {"hr2d_exchange_matrix", matrix},
                  {"hr2d_exchange_rows_create", rows},
                  {"hr2d_exchange_rows_visit", visit_rows},
                  {"hr2d_clusters_create", clusters},
                  {"hr2d_refine", refine},
                  {"hr2d_refine_count", count},
                  {"hr2d_refine_visit", visit},
                  {"hr2d_study_run", study},
                  {"hr2d_study_law", law},
                  {"hr2d_linkset_validate", validate},
                  {"hr2d_solve", solve},
                  {"hr2d_solve_to", solve_to},
                  {"hr2d_solve_to, in a time", solve_in_time},
                  {"hr2d_predict", predict},
                  {"hr2d_enclose", enclose},
                  {"hr2d_operator_create", make_operator},
                  {"hr2d_operator_solve", solve_by_operator},
                  {"hr2d_operator_response", respond},
                  {"hr2d_operator_gradient", differentiate},
                  {"hr2d_solution_error", find_error},
                  {"hr2d_solution_account", account},
                  {"hr2d_solution_gather", gather},
                  {"hr2d_solution_gather_irradiance", gather_irradiance},
                  {"hr2d_solution_gather_net_flux", gather_net_flux},
                  {"hr2d_field_at", field_at},
                  {"hr2d_field_on_grid", field_on_grid},
                  {"hr2d_field_rows_visit", field_rows},
                  {"hr2d_state_write", write_state},
                  {"hr2d_state_read", read_state},
                  {"hr2d_state_write_scene", write_scene},
                  {"hr2d_state_read_scene", read_scene}};
enum { CALLS = sizeof long_calls / sizeof *long_calls };

static hr2d_status refuse(void *ctx, const hr2d_progress *progress) {
  ck_assert_str_ne(progress->phase, "");
  ++*(unsigned long *)ctx;
  return (hr2d_status)REFUSAL;
}

static void begin_set(const hr2d_scene *scene, hr2d_hierarchy **tree, hr2d_linkset **links) {
  ck_assert_int_eq(hr2d_hierarchy_create(scene, tree), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(*tree, hr2d_oracle_size(), NULL, NULL, NULL, links),
                   HR2D_OK);
}

static void begin(stage *t) {
  const slow_phase *phase = slow_phases;
  *t = (stage){
      .s = {.kind = SLOW_SQUARES, .count = PATCHES, .epsilon = 10, .order = 1, .threads = 1}};
  while (strcmp(phase->name, "gather") != 0) phase++;
  ck_assert_int_eq(phase->prepare(&t->s), HR2D_OK);
  t->s.text = slow_text(t->s.scene, &t->s.size);
  ck_assert_ptr_nonnull(t->s.text);
  ck_assert_int_eq(hr2d_scene_create(NULL, &t->empty), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_create(NULL, &t->open), HR2D_OK);
  ck_assert_int_eq(slow_add(t->open, SLOW_SQUARES, PATCHES), HR2D_OK);
  begin_set(t->s.scene, &t->new_tree, &t->new_links);
  begin_set(t->s.scene, &t->spare_tree, &t->spare);
  const hr2d_target rough = {.struct_size = sizeof rough, .error = 0.1, .no_error = 1};
  ck_assert_int_eq(hr2d_operator_create(t->s.scene, &rough, &t->op, NULL), HR2D_OK);
  ck_assert_msg(!hr2d_operator_solve(t->op, NULL, NULL, &t->light, NULL), "%s",
                hr2d_operator_message(t->op));
  t->field = calloc(hr2d_hierarchy_count(t->s.hierarchy).elements, sizeof *t->field);
  ck_assert_ptr_nonnull(t->field);
}

static void end(stage *t) {
  hr2d_solution_destroy(t->light);
  hr2d_operator_destroy(t->op);
  hr2d_linkset_destroy(t->new_links);
  hr2d_linkset_destroy(t->spare);
  hr2d_hierarchy_destroy(t->new_tree);
  hr2d_hierarchy_destroy(t->spare_tree);
  slow_clear(&t->s);
  hr2d_scene_destroy(t->open);
  hr2d_scene_destroy(t->empty);
  free(t->bytes);
  free(t->field);
}

START_TEST(long_calls_ask_the_scene) {
  stage t;
  begin(&t);
  for (size_t k = 0; k < CALLS; k++) {
    unsigned long asks = 0;
    t.s.ask = refuse;
    t.s.ctx = &asks;
    hr2d_scene_set_progress(t.s.scene, refuse, &asks);
    hr2d_scene_set_progress(t.open, refuse, &asks);
    hr2d_scene_set_progress(t.empty, refuse, &asks);
    const int status = (int)long_calls[k].call(&t);
    ck_assert_msg(asks == 1, "%s asks %lu times", long_calls[k].name, asks);
    ck_assert_msg(status == REFUSAL, "%s returns %d", long_calls[k].name, status);
  }
  end(&t);
}
END_TEST

/* Calls that return a status and end within 10 ms whatever the scene is.  Calls without a
   status return a number that is known, or free memory. */
static const char *const short_calls[] = {
    /* on a pair or on segments, without a scene */
    "hr2d_constant", "hr2d_blocks", "hr2d_exchange_area", "hr2d_exchange_area_occluded",
    "hr2d_exchange_area_past", "hr2d_study_fit_rows",
    /* one patch or value, or memory alone */
    "hr2d_scene_create", "hr2d_scene_add", "hr2d_scene_add_thermal", "hr2d_scene_add_gas",
    "hr2d_scene_add_mirror", "hr2d_scene_set_background", "hr2d_scene_set_period",
    "hr2d_scene_set_sky", "hr2d_sky_cie", "hr2d_sky_perez", "hr2d_scene_set_sun",
    "hr2d_scene_set_wavelengths", "hr2d_scene_set_weights", "hr2d_scene_force",
    "hr2d_scene_find", "hr2d_hierarchy_create", "hr2d_hierarchy_divide", "hr2d_linkset_create",
    "hr2d_linkset_read", "hr2d_solution_adopt", "hr2d_solution_temperatures",
    /* steps over patches */
    "hr2d_enclosure_error", "hr2d_solution_gas",
    /* steps over elements, which ask when these are many more */
    "hr2d_hierarchy_originals", "hr2d_hierarchy_set_order", "hr2d_hierarchy_pull",
    "hr2d_hierarchy_push",
    /* as hr2d_scene_parse(), as hr2d_clusters_create(), as hr2d_solution_gather() */
    "hr2d_scene_read", "hr2d_clusters_gather", "hr2d_solution_gather_temperature",
    /* the view of one point, which asks where it needs a plane */
    "hr2d_beams_visit"};

static int is_listed(const char *name) {
  int found = 0;
  for (size_t k = 0; k < CALLS; k++) found |= !strcmp(name, long_calls[k].name);
  for (size_t k = 0; k < sizeof short_calls / sizeof *short_calls; k++)
    found |= !strcmp(name, short_calls[k]);
  return found;
}

/* The calls of a header that return a status; returns their number. */
static size_t look_up_calls(const char *file) {
  static const char mark[] = "HR2D_API hr2d_status ";
  char line[256], name[128], path[128];
  size_t calls = 0;
  snprintf(path, sizeof path, "include/hr2d/%s", file);
  FILE *header = fopen(test_source_path(path), "r");
  ck_assert_msg(header != NULL, "%s", path);
  while (fgets(line, sizeof line, header)) {
    if (strncmp(line, mark, sizeof mark - 1) != 0) continue;
    ck_assert_int_eq(sscanf(line + sizeof mark - 1, "%127[a-z0-9_]", name), 1);
    ck_assert_msg(is_listed(name), "%s is neither among the long nor the short calls", name);
    calls++;
  }
  fclose(header);
  return calls;
}

START_TEST(every_call_of_the_headers_is_listed) {
  char line[256], file[64];
  size_t calls = 0;
  FILE *all = fopen(test_source_path("include/hr2d/hr2d.h"), "r");
  ck_assert_ptr_nonnull(all);
  while (fgets(line, sizeof line, all))
    if (sscanf(line, "#include <hr2d/%63[^>]>", file) == 1 && strcmp(file, "version.h") != 0)
      calls += look_up_calls(file);
  fclose(all);
  ck_assert_uint_ge(calls, CALLS);
}
END_TEST

TEST_SUITE("check-scene-progress") {
  ADD_TESTS("scene", long_calls_ask_the_scene, every_call_of_the_headers_is_listed);
}
