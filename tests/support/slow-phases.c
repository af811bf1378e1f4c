/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/slow-phases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/alloc.h"
#include "clusters/root-pairs.h"
#include "mesh/events.h"

static void forget_solution(slow_stage *s) {
  hr2d_solution_destroy(s->solution);
  hr2d_linkset_destroy(s->links);
  hr2d_hierarchy_destroy(s->hierarchy);
  s->solution = NULL;
  s->links = NULL;
  s->hierarchy = NULL;
}

void slow_clear(slow_stage *s) {
  forget_solution(s);
  hr2d_scene_destroy(s->scene);
  free(s->area);
  free(s->text);
  s->scene = NULL;
  s->area = NULL;
  s->text = NULL;
  s->size = s->at = 0;
}

/* Calls without options ask the callback of the scene. */
static hr2d_status by_scene(slow_stage *s, hr2d_status (*call)(slow_stage *s)) {
  hr2d_scene_set_progress(s->scene, s->ask, s->ctx);
  const hr2d_status status = call(s);
  hr2d_scene_set_progress(s->scene, s->hurry, s->ctx);
  return status;
}

static hr2d_status make_open(slow_stage *s) {
  const hr2d_status status = hr2d_scene_create(s->hooks, &s->scene);
  if (!status) hr2d_scene_set_progress(s->scene, s->hurry, s->ctx);
  return status ? status : slow_add(s->scene, s->kind, s->count);
}

static hr2d_status make_crossing(slow_stage *s) {
  const hr2d_status status = hr2d_scene_create(s->hooks, &s->scene);
  return status ? status : slow_add_crossing(s->scene, s->count);
}

static hr2d_status make_text(slow_stage *s) {
  hr2d_scene *source = NULL;
  hr2d_status status = hr2d_scene_create(NULL, &source);
  if (!status) status = slow_add(source, s->kind, s->count);
  if (!status && !(s->text = slow_text(source, &s->size))) status = HR2D_ENOMEM;
  hr2d_scene_destroy(source);
  return status ? status : hr2d_scene_create(s->hooks, &s->scene);
}

static hr2d_status make_scene(slow_stage *s) {
  const hr2d_status status = make_open(s);
  return status ? status : hr2d_scene_commit(s->scene);
}

static hr2d_status make_set(slow_stage *s, const hr2d_oracle *oracle) {
  hr2d_status status = make_scene(s);
  if (!status) status = hr2d_hierarchy_create(s->scene, &s->hierarchy);
  if (!status) status = hr2d_hierarchy_set_order(s->hierarchy, s->order);
  return status ? status
                : hr2d_linkset_create(s->hierarchy, oracle, NULL, NULL, NULL, &s->links);
}

static hr2d_status make_empty(slow_stage *s) {
  return make_set(s, hr2d_oracle_size());
}

static hr2d_status make_grid(slow_stage *s) {
  return make_set(s, hr2d_oracle_l1_grid());
}

static hr2d_refine_options fine(const slow_stage *s) {
  hr2d_refine_options o = HR2D_REFINE_OPTIONS_INIT;
  o.epsilon = s->epsilon;
  o.threads = s->threads;
  return o;
}

static hr2d_status make_links(slow_stage *s) {
  const hr2d_status status = make_empty(s);
  const hr2d_refine_options o = fine(s);
  return status ? status : hr2d_refine(s->links, &o);
}

static hr2d_target target_of(const slow_stage *s) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = s->target > 0 ? s->target : .1;
  target.threads = s->threads;
  return target;
}

/* Refinement of so many patches that clusters are needed is a solve to a target. */
static hr2d_status make_solution_to(slow_stage *s) {
  hr2d_target target = target_of(s);
  target.no_error = 1;
  const hr2d_status status = make_scene(s);
  return status ? status : hr2d_solve_to(s->scene, &target, &s->solution, NULL);
}

static hr2d_status make_solution(slow_stage *s) {
  if (s->target > 0) return make_solution_to(s);
  const hr2d_status status = make_links(s);
  hr2d_solve_options o = HR2D_SOLVE_OPTIONS_INIT;
  o.threads = s->threads;
  return status ? status : hr2d_solve(s->links, &o, &s->solution);
}

static hr2d_status make_matrix(slow_stage *s) {
  const hr2d_status status = make_scene(s);
  const size_t n = status ? 0 : hr2d_scene_patches(s->scene);
  s->area = malloc((n * n + 1) * sizeof *s->area);
  return status ? status : s->area ? HR2D_OK : HR2D_ENOMEM;
}

static hr2d_status keep(void *ctx, const void *bytes, size_t size) {
  slow_stage *s = ctx;
  char *grown = realloc(s->text, s->size + size);
  if (!grown) return HR2D_ENOMEM;
  memcpy(grown + s->size, bytes, size);
  s->text = grown;
  s->size += size;
  return HR2D_OK;
}

static hr2d_status give(void *ctx, void *bytes, size_t size) {
  slow_stage *s = ctx;
  if (size > s->size - s->at) return HR2D_ESYNTAX;
  memcpy(bytes, s->text + s->at, size);
  s->at += size;
  return HR2D_OK;
}

/* A state, and an empty set to read it into. */
static hr2d_status make_state(slow_stage *s) {
  hr2d_status status = make_solution(s);
  if (!status) status = hr2d_state_write(s->solution, keep, s);
  forget_solution(s);
  if (!status) status = hr2d_hierarchy_create(s->scene, &s->hierarchy);
  return status ? status
                : hr2d_linkset_create(s->hierarchy, hr2d_oracle_size(), NULL, NULL, NULL,
                                      &s->links);
}

static hr2d_status parse(slow_stage *s) {
  return hr2d_scene_parse(s->scene, s->text, s->size);
}

static hr2d_status read_file(slow_stage *s) {
  return by_scene(s, parse);
}

static hr2d_status cut(slow_stage *s) {
  size_t cuts;
  return hr2d_scene_split_crossings(s->scene, &cuts);
}

static hr2d_status split(slow_stage *s) {
  return by_scene(s, cut);
}

static hr2d_status commit_scene(slow_stage *s) {
  return hr2d_scene_commit(s->scene);
}

static hr2d_status commit(slow_stage *s) {
  return by_scene(s, commit_scene);
}

static hr2d_status snap_scene(slow_stage *s) {
  return hr2d_scene_snap(s->scene, 1e-9, NULL);
}

static hr2d_status snap(slow_stage *s) {
  return by_scene(s, snap_scene);
}

static hr2d_status ignore(void *ctx, const hr2d_warning *warning) {
  (void)ctx;
  return warning->text ? HR2D_OK : HR2D_EINVAL;
}

static hr2d_status lint(slow_stage *s) {
  hr2d_lint_options o = HR2D_LINT_OPTIONS_INIT;
  o.progress = s->ask;
  o.progress_ctx = s->ctx;
  return hr2d_scene_lint(s->scene, ignore, NULL, &o);
}

static hr2d_allocator hooks_of(const slow_stage *s) {
  return s->hooks ? *s->hooks : hr2di_alloc_default();
}

static hr2d_status find_events(slow_stage *s) {
  const hr2d_allocator alloc = hooks_of(s);
  hr2di_events events;
  hr2di_watch watch;
  hr2di_watch_init(&watch, s->ask, s->ctx, "events");
  const hr2d_status status =
      hr2di_events_init(&events, s->scene, &alloc, 2, 8 * s->count, NULL, &watch);
  hr2di_events_clear(&events);
  return status == HR2D_EMAX_ELEMENTS ? HR2D_OK : status;
}

static hr2d_status find_roots(slow_stage *s) {
  const hr2d_allocator alloc = hooks_of(s);
  hr2di_roots roots;
  hr2di_watch watch;
  hr2di_watch_init(&watch, s->ask, s->ctx, "roots");
  const hr2d_status status =
      hr2di_roots_init(&roots, s->scene, &alloc, 1e-4, s->threads, &watch);
  hr2di_roots_clear(&roots, &alloc);
  return status;
}

static hr2d_status ignore_near(void *ctx, const hr2d_pair *pairs, size_t count) {
  (void)ctx;
  (void)pairs;
  (void)count;
  return HR2D_OK;
}

static hr2d_status sum_clusters(slow_stage *s) {
  const size_t n = hr2d_scene_patches(s->scene);
  const hr2d_clusters_options o = {.struct_size = sizeof o,
                                   .accuracy = 1e-4,
                                   .threads = s->threads,
                                   .progress = s->ask,
                                   .progress_ctx = s->ctx};
  hr2d_clusters *clusters = NULL;
  double *value = calloc(2 * n, sizeof *value);
  hr2d_status status = value ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = hr2d_clusters_create(s->scene, &o, ignore_near, NULL, &clusters);
  if (!status) status = hr2d_clusters_gather(clusters, &o, 1, 1, value, value + n);
  hr2d_clusters_destroy(clusters);
  free(value);
  return status == HR2D_EUNSUPPORTED ? HR2D_OK : status; /* images */
}

static hr2d_status find_factors(slow_stage *s) {
  hr2d_matrix_options o = HR2D_MATRIX_OPTIONS_INIT;
  o.threads = s->threads;
  o.progress = s->ask;
  o.progress_ctx = s->ctx;
  return hr2d_exchange_matrix(s->scene, &o, s->area, NULL);
}

static hr2d_status find_rows(slow_stage *s) {
  hr2d_matrix_options o = HR2D_MATRIX_OPTIONS_INIT;
  hr2d_exchange_rows *rows = NULL;
  o.threads = s->threads;
  o.progress = s->ask;
  o.progress_ctx = s->ctx;
  const hr2d_status status = hr2d_exchange_rows_create(s->scene, &o, &rows, NULL);
  hr2d_exchange_rows_destroy(rows);
  return status;
}

static hr2d_status pass_over(void *ctx, const hr2d_exchange_row *row) {
  (void)ctx;
  (void)row;
  return HR2D_OK;
}

static hr2d_status visit_rows(slow_stage *s) {
  hr2d_matrix_options o = HR2D_MATRIX_OPTIONS_INIT;
  o.threads = s->threads;
  o.progress = s->ask;
  o.progress_ctx = s->ctx;
  return hr2d_exchange_rows_visit(s->scene, &o, pass_over, NULL, NULL);
}

static hr2d_status refine(slow_stage *s) {
  hr2d_refine_options o = fine(s);
  o.progress = s->ask;
  o.progress_ctx = s->ctx;
  return hr2d_refine(s->links, &o);
}

/* The integrals of this oracle are slow: some of them are enough. */
static hr2d_status refine_some(slow_stage *s) {
  hr2d_refine_options o = fine(s);
  o.max_links = 200;
  o.progress = s->ask;
  o.progress_ctx = s->ctx;
  const hr2d_status status = hr2d_refine(s->links, &o);
  return status == HR2D_EMAX_LINKS ? HR2D_OK : status;
}

static hr2d_status count_links(slow_stage *s) {
  hr2d_refine_options o = fine(s);
  hr2d_refine_counts counts;
  o.progress = s->ask;
  o.progress_ctx = s->ctx;
  return hr2d_refine_count(s->links, &o, &counts);
}

static hr2d_status validate_links(slow_stage *s) {
  return hr2d_linkset_validate(s->links);
}

static hr2d_status validate(slow_stage *s) {
  return by_scene(s, validate_links);
}

static hr2d_status solve(slow_stage *s) {
  hr2d_solve_options o = HR2D_SOLVE_OPTIONS_INIT;
  o.threads = s->threads;
  o.progress = s->ask;
  o.progress_ctx = s->ctx;
  return hr2d_solve(s->links, &o, &s->solution);
}

static hr2d_status solve_to(slow_stage *s) {
  hr2d_target target = target_of(s);
  target.progress = s->ask;
  target.progress_ctx = s->ctx;
  const hr2d_status status = hr2d_solve_to(s->scene, &target, &s->solution, NULL);
  return status == HR2D_EACCURACY ? HR2D_OK : status;
}

static hr2d_status predict(slow_stage *s) {
  hr2d_target target = target_of(s);
  hr2d_prediction prediction;
  target.progress = s->ask;
  target.progress_ctx = s->ctx;
  return hr2d_predict(s->scene, &target, &prediction);
}

static hr2d_status gather_some(slow_stage *s) {
  const double t[] = {0, 0.25, 0.5, 0.75, 1};
  double value[5];
  return hr2d_solution_gather(s->solution, 5, t, 5, value);
}

static hr2d_status gather(slow_stage *s) {
  return by_scene(s, gather_some);
}

/* From points between the patches, or on them. */
static hr2d_status look_round(slow_stage *s) {
  enum { POINTS = 200 };
  hr2d_point at[POINTS];
  double mean[POINTS];
  const size_t n = hr2d_scene_patches(s->scene);
  for (size_t k = 0; k < POINTS; k++) {
    const hr2d_point p = hr2d_scene_segment(s->scene, k * 7 % n).a,
                     q = hr2d_scene_segment(s->scene, k * 13 % n).b;
    at[k] = (hr2d_point){.25 * p.x + .75 * q.x, .25 * p.y + .75 * q.y};
  }
  const hr2d_field_options o = {.struct_size = sizeof o,
                                .threads = s->threads,
                                .progress = s->ask,
                                .progress_ctx = s->ctx};
  const hr2d_field_values values = {.struct_size = sizeof values, .mean = mean};
  return hr2d_field_at(s->solution, at, POINTS, &o, &values);
}

/* On a grid that is fine enough for borders of light to be looked for. */
static hr2d_status draw_light(slow_stage *s) {
  const size_t side = 20 + 4 * (size_t)sqrt((double)hr2d_scene_patches(s->scene));
  hr2d_field_grid grid = HR2D_FIELD_GRID_INIT;
  grid.low = grid.high = hr2d_scene_segment(s->scene, 0).a;
  for (size_t k = 0; k < hr2d_scene_patches(s->scene); k++) {
    const hr2d_point p = hr2d_scene_segment(s->scene, k).a;
    grid.low = (hr2d_point){fmin(grid.low.x, p.x), fmin(grid.low.y, p.y)};
    grid.high = (hr2d_point){fmax(grid.high.x, p.x), fmax(grid.high.y, p.y)};
  }
  grid.columns = grid.rows = side;
  grid.tolerance = 0.01;
  const hr2d_field_options o = {.struct_size = sizeof o,
                                .threads = s->threads,
                                .progress = s->ask,
                                .progress_ctx = s->ctx};
  double *mean = malloc(side * side * sizeof *mean);
  if (!mean) return HR2D_ENOMEM;
  const hr2d_field_values values = {.struct_size = sizeof values, .mean = mean};
  const hr2d_status status = hr2d_field_on_grid(s->solution, &grid, &o, &values, NULL);
  free(mean);
  return status;
}

static hr2d_status put_state(slow_stage *s) {
  s->size = 0;
  return hr2d_state_write(s->solution, keep, s);
}

static hr2d_status write_state(slow_stage *s) {
  return by_scene(s, put_state);
}

static hr2d_status get_state(slow_stage *s) {
  s->at = 0;
  return hr2d_state_read(s->links, give, s, &s->solution);
}

static hr2d_status read_state(slow_stage *s) {
  return by_scene(s, get_state);
}

/* The longest distance in the scene, past all patches. */
static hr2d_status pass(slow_stage *s) {
  const size_t n = hr2d_scene_patches(s->scene);
  hr2d_segment *segment = malloc((n + 1) * sizeof *segment);
  if (!segment) return HR2D_ENOMEM;
  for (size_t k = 0; k < n; k++) segment[k] = hr2d_scene_segment(s->scene, k);
  const hr2d_past_options o = {
      .struct_size = sizeof o, .alloc = s->hooks, .progress = s->ask, .progress_ctx = s->ctx};
  double area;
  const hr2d_status status =
      hr2d_exchange_area_past(&segment[0], &segment[2], segment, n, &o, &area);
  free(segment);
  return status;
}

const slow_phase slow_phases[SLOW_PHASES] = {
    {"read", make_text, read_file},
    {"split", make_crossing, split},
    {"commit", make_open, commit},
    {"events", make_scene, find_events},
    {"roots", make_scene, find_roots},
    {"clusters", make_scene, sum_clusters},
    {"factors", make_matrix, find_factors},
    {"rows", make_scene, find_rows},
    {"visit", make_scene, visit_rows},
    {"refine", make_empty, refine},
    {"refine l1", make_grid, refine_some},
    {"count", make_empty, count_links},
    {"validate", make_links, validate},
    {"solve", make_links, solve},
    {"gather", make_solution, gather},
    {"write", make_solution, write_state},
    {"resume", make_state, read_state},
    {"past", make_open, pass},
    {"lint", make_scene, lint},
    {"snap", make_crossing, snap},
    {"field", make_solution, look_round},
    {"grid", make_solution, draw_light},
    {"predict", make_scene, predict},
    {"to", make_scene, solve_to},
};
