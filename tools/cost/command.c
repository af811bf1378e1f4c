/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d cost`: a reference first, then each method for as long as its share of time lasts. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/load.h"
#include "cost/cost.h"
#include "output/complain.h"
#include "output/output.h"

/* Well below what any method but the automatic one comes to. */
#define REFERENCE_ERROR 1e-14

double cost_prediction_target(int k) {
  static const double target[COST_PREDICTIONS] = {1e-3, 1e-6, 1e-9, 1e-12};
  return target[k];
}

double cost_floor(const cost *c) {
  return fmax(c->reference.average.bound, 1e-15);
}

double cost_error(const cost *c, double (*get)(const void *ctx, size_t patch, size_t band),
                  const void *ctx) {
  const size_t patches = hr2d_scene_patches(c->scene), bands = hr2d_scene_bands(c->scene);
  double worst = 0;
  for (size_t k = 0; k < patches; k++)
    for (size_t b = 0; b < bands; b++) {
      const double exact = c->average[k * bands + b];
      const double difference = fabs(get(ctx, k, b) - exact);
      if (difference > 0) worst = fmax(worst, difference / fabs(exact));
    }
  return worst;
}

hr2d_status cost_add(cost *c, const cost_row *row) {
  if (c->count == c->capacity) {
    const size_t capacity = c->capacity ? 2 * c->capacity : 64;
    cost_row *grown = realloc(c->rows, capacity * sizeof *grown);
    if (!grown) return HR2D_ENOMEM;
    c->rows = grown;
    c->capacity = capacity;
  }
  c->rows[c->count++] = *row;
  return HR2D_OK;
}

pace pace_start(void) {
  return (pace){.growth = 4};
}

void pace_note(pace *p, double once, double spent) {
  if (p->last > 0) p->growth = fmin(16, fmax(2, once / p->last));
  p->last = once;
  p->spent += spent;
}

int pace_allows(const cost *c, const pace *p) {
  return p->spent + p->growth * p->last <= c->share;
}

int pace_repeats(double time) {
  return time < 0.01 ? 5 : time < 0.05 ? 3 : 1;
}

static hr2d_target make_target(cost *c, double error) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = error;
  target.threads = c->options->threads;
  target.progress = progress_show;
  target.progress_ctx = &c->line;
  return target;
}

/* As good as doubles and time allow will do where 1e-14 is out of reach; it may take as long as
   all methods together. */
static int make_reference(cost *c) {
  const size_t patches = hr2d_scene_patches(c->scene), bands = hr2d_scene_bands(c->scene);
  hr2d_target target = make_target(c, REFERENCE_ERROR);
  hr2d_solution *solution = NULL;
  target.seconds = c->options->max_seconds;
  const hr2d_status status = hr2d_solve_to(c->scene, &target, &solution, &c->reference);
  progress_clear(&c->line);
  if (status && status != HR2D_EACCURACY) return fail_call(c->options->scene, "", status);
  if (!solution) return fail(c->options->scene, "the time was too short for a reference");
  c->average = calloc(patches, bands * sizeof *c->average);
  for (size_t k = 0; c->average && k < patches * bands; k++)
    c->average[k] = hr2d_solution_average(solution, k / bands, k % bands);
  hr2d_solution_destroy(solution);
  return c->average ? EXIT_DONE : fail_memory();
}

/* Where that is not all that was asked for, the dear ones are left out. */
static int predict(cost *c) {
  const double start = seconds();
  for (int k = 0; k < COST_PREDICTIONS; k++) {
    const hr2d_target target = make_target(c, cost_prediction_target(k));
    if (!c->options->predict && seconds() - start > 0.1 * c->options->max_seconds) break;
    const hr2d_status status = hr2d_predict(c->scene, &target, &c->prediction[k]);
    progress_clear(&c->line);
    if (status) return fail_call(c->options->scene, "", status);
    c->predictions++;
  }
  return EXIT_DONE;
}

/* Whether --methods has a method; without it all are wanted. */
static int is_wanted(const cost *c, const cost_method *m) {
  const size_t size = strlen(m->name);
  for (const char *word = c->options->methods; word; word = strchr(word, ',')) {
    word += *word == ',';
    if (!strncmp(word, m->name, size) && strchr(",", word[size])) return 1;
  }
  return !c->options->methods;
}

static int run_method(cost *c, const cost_method *m) {
  const size_t first = c->count;
  *c->message = '\0';
  const hr2d_status status = m->run(c, m);
  progress_clear(&c->line);
  if (!c->quiet) cost_print_rows(c, first);
  if (status == HR2D_STOPPED) return fail_call(c->options->scene, "", status);
  return status ? fail(c->options->scene, "%s: %s", m->name,
                       *c->message ? c->message : hr2d_strerror(status))
                : EXIT_DONE;
}

/* A method that fails leaves the others. */
static int run_methods(cost *c) {
  unsigned wanted = 0;
  int status = 0;
  const cost_method *m;
  for (size_t k = 0; (m = cost_method_at(k)); k++) wanted += (unsigned)is_wanted(c, m);
  c->share = c->options->max_seconds / wanted;
  c->line.steps = wanted;
  for (size_t k = 0; (m = cost_method_at(k)) && status != EXIT_INTERRUPTED; k++) {
    if (!is_wanted(c, m)) continue;
    const int code = run_method(c, m);
    if (code) status = code;
    c->line.step++;
  }
  c->incomplete = status != 0;
  return status;
}

static int report(const cost *c) {
  const options *o = c->options;
  int status = 0;
  progress_end();
  if (!c->quiet && !o->predict) cost_print_fits(c);
  if (o->csv) status = cost_write_csv(c);
  if (o->json && !status) status = cost_write_json(c);
  if (o->plot && !status) status = cost_draw(c);
  return status;
}

static int measure(cost *c) {
  int status = predict(c);
  if (!status && !c->options->predict) status = make_reference(c);
  if (status) return status;
  if (!c->quiet) cost_print_head(c);
  if (!c->options->predict) status = run_methods(c);
  const int reporting = report(c);
  return status ? status : reporting;
}

int cost_command(const options *o) {
  hr2d_scene *scene = NULL;
  cost c = {.options = o, .quiet = o->quiet || to_stdout(o->json) || to_stdout(o->csv)};
  int status = output_check(o->json);
  if (!status) status = output_check(o->csv);
  if (!status) status = output_check(o->plot);
  if (!status) status = load_scene(o, o->force, &scene, &c.cuts);
  if (status) return status;
  c.scene = scene;
  progress_start(&c.line, o->quiet);
  status = measure(&c);
  free(c.rows);
  free(c.average);
  hr2d_scene_destroy(scene);
  return status;
}
