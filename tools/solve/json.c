/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result of a run for programs. */
#include "output/json.h"

#include <math.h>
#include <stdlib.h>

#include "cli/scene.h"
#include "output/provenance.h"
#include "solve/solve.h"

static json_t *per_band(const run *r, size_t patch,
                        double (*get)(const hr2d_solution *, size_t, size_t)) {
  json_t *array = json_array();
  for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++)
    json_push(&array, json_number(get(r->solution, patch, b)));
  return array;
}

/* What comes straight from the sun, over a patch or at a fraction t of it; t < 0: over it. */
static json_t *sunlight(const run *r, size_t patch, double t) {
  json_t *array = json_array();
  for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++)
    json_push(&array, json_number(t < 0 ? hr2d_scene_sunlight(r->scene, patch, b)
                                        : hr2d_scene_sunlight_at(r->scene, patch, t, b)));
  return array;
}

static json_t *error_of(double estimate, double bound) {
  json_t *object = json_object();
  json_put(&object, "estimate", json_number(estimate));
  json_put(&object, "bound", json_number(bound));
  return object;
}

/* Keys of scenes with temperatures or fluxes; null where a temperature is not known. */
static void put_heat(json_t **patch, const run_heat *heat, size_t k) {
  const hr2d_temperatures *of = &heat->of;
  json_put(patch, "temperature", json_number(of->kelvin[k]));
  json_put(patch, "temperature_error", error_of(of->estimate[k], of->bound[k]));
  json_put(patch, "temperature_state", json_text(run_heat_word(of->state[k])));
  json_put(patch, "heat", json_number(of->heat[k]));
  json_put(patch, "heat_error", error_of(of->heat_estimate[k], of->heat_bound[k]));
}

static json_t *patches(const run *r) {
  run_heat heat;
  json_t *list = run_heat_find(r, &heat) ? NULL : json_array();
  for (size_t k = 0; k < hr2d_scene_patches(r->scene); k++) {
    json_t *patch = json_patch(r->scene, k);
    json_put(&patch, "average", per_band(r, k, hr2d_solution_average));
    json_put(&patch, "irradiance", per_band(r, k, hr2d_solution_irradiance));
    json_put(&patch, "net_flux", per_band(r, k, hr2d_solution_net_flux));
    json_put(&patch, "net_power", per_band(r, k, hr2d_solution_net_power));
    if (run_sun_exists(r->scene)) json_put(&patch, "sunlight", sunlight(r, k, -1));
    if (heat.exists && list) put_heat(&patch, &heat, k);
    json_push(&list, patch);
  }
  run_heat_release(&heat);
  return list;
}

static json_t *place_entry(const run *r, size_t k) {
  const size_t bands = hr2d_scene_bands(r->scene);
  double *value = malloc(2 * bands * sizeof *value);
  json_t *entry = value && !run_place(r, k, value, value + bands) ? json_object() : NULL;
  json_put(&entry, "patch", json_count(r->places[k]));
  json_put(&entry, "t", json_number(r->options->at.items[k].t));
  json_put(&entry, "value", entry ? json_numbers(value, bands) : NULL);
  json_put(&entry, "irradiance", entry ? json_numbers(value + bands, bands) : NULL);
  if (entry && run_sun_exists(r->scene))
    json_put(&entry, "sunlight", sunlight(r, r->places[k], r->options->at.items[k].t));
  if (entry && run_heat_exists(r->scene))
    json_put(
        &entry, "temperature",
        json_number(run_heat_at(r, r->places[k], r->options->at.items[k].t, value[bands])));
  free(value);
  return entry;
}

static json_t *places(const run *r) {
  json_t *list = json_array();
  for (size_t k = 0; k < r->options->at.count; k++) json_push(&list, place_entry(r, k));
  return list;
}

static json_t *work(const run *r, const hr2d_refine_counts *n) {
  json_t *object = json_object();
  json_put(&object, "oracle_calls", json_count(n->oracle_calls));
  json_put(&object, "facing_tests", json_count(n->facing_tests));
  json_put(&object, "visibility_tests", json_count(n->visibility_tests));
  json_put(&object, "exchange_areas", json_count(n->exchange_areas));
  json_put(&object, "partial_links", json_count(n->partial_links));
  json_put(&object, "blocked_pairs", json_count(n->blocked_pairs));
  json_put(&object, "dark_pairs", json_count(n->dark_pairs));
  json_put(&object, "rounds", json_count(r->rounds));
  json_put(&object, "sweeps", json_count(r->work.gathers));
  json_put(&object, "iterations", json_count(r->work.iterations));
  json_put(&object, "row_sums", json_count(r->work.row_sums));
  json_put(&object, "background_rows", json_count(r->work.background_rows));
  json_put(&object, "kernels", json_count(r->work.kernels));
  return object;
}

/* At order 1 exchange areas are computed during refinement and have no time of their own. */
static json_t *times(const run *r, double total_seconds) {
  const hr2d_account *a = &r->account;
  json_t *object = json_object();
  json_put(&object, "refine", json_number(a->refine_seconds));
  json_put(&object, "coefficients", json_number(a->order > 1 ? a->coefficients_seconds : NAN));
  json_put(&object, "solve", json_number(a->solve_seconds));
  json_put(&object, "error", json_number(a->error_seconds));
  json_put(&object, "total", json_number(total_seconds));
  return object;
}

static json_t *power(const run *r) {
  json_t *list = json_array();
  for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++) {
    const hr2d_power p = hr2d_solution_power(r->solution, b);
    json_t *band = json_object();
    json_put(&band, "emitted", json_number(p.emitted));
    json_put(&band, "received", json_number(p.received));
    json_put(&band, "absorbed", json_number(p.absorbed));
    json_put(&band, "escaped", json_number(p.escaped));
    json_put(&band, "relative_error", json_number(run_power_error(&p)));
    if (hr2d_scene_cut_off(r->scene) > 0)
      json_put(&band, "cut_off", json_number(hr2d_solution_power_cut_off(r->solution, b)));
    const double unknown = hr2d_scene_sunlight_cut_off(r->scene, b);
    if (unknown > 0) json_put(&band, "sunlight_cut_off", json_number(unknown));
    json_push(&list, band);
  }
  return list;
}

static json_t *error_pair(const hr2d_error *average, const hr2d_error *sup) {
  json_t *object = json_object();
  json_put(&object, "estimate", json_number(average->estimate));
  json_put(&object, "bound", json_number(average->bound));
  json_put(&object, "sup_estimate", json_number(sup->estimate));
  json_put(&object, "sup_bound", json_number(sup->bound));
  return object;
}

/* Of B, and as a member those of H. */
static json_t *errors(const run *r) {
  const hr2d_account *a = &r->account;
  json_t *object = error_pair(&a->average, &a->sup);
  json_put(&object, "irradiance", error_pair(&a->irradiance, &a->irradiance_sup));
  if (run_assumes_kinks(r)) json_put(&object, "assumes", json_string("kinks within target"));
  return object;
}

static json_t *optional(double x) {
  return x > 0 ? json_number(x) : json_null();
}

/* The indices of --importance; null if all patches count. */
static json_t *importance(const run *r) {
  if (!r->options->importance.count) return json_null();
  json_t *list = json_array();
  for (size_t k = 0; k < r->options->importance.count; k++)
    json_push(&list, json_count(run_important(r)[k]));
  return list;
}

/* The target or budget; null if the options choose the method instead. */
static json_t *target(const run *r) {
  const options *o = r->options;
  if (!options_targeted(o)) return json_null();
  json_t *object = json_object();
  json_put(&object, "error", optional(o->target_error));
  json_put(&object, "norm", json_text(o->norm == HR2D_NORM_SUP ? "sup" : "average"));
  json_put(&object, "seconds", optional(o->time_budget));
  json_put(&object, "importance", importance(r));
  json_put(&object, "floor", json_number(o->floor > 0 ? o->floor : HR2D_FLOOR));
  json_put(&object, "reason", json_text(r->account.reason));
  return object;
}

static json_t *gas_in(const run *r, size_t gas, size_t band) {
  double emission = NAN, heat = NAN;
  json_t *object = json_object();
  hr2d_solution_gas(r->solution, gas, band, &emission, &heat);
  json_put(&object, "gas", json_count(gas));
  json_put(&object, "band", json_count(band));
  json_put(&object, "absorption", json_number(hr2d_scene_absorption(r->scene, gas, band)));
  json_put(&object, "emission", json_number(emission));
  json_put(&object, "heat", json_number(heat));
  return object;
}

/* Of each gas and band; nothing is said without gas. */
static json_t *gas(const run *r) {
  json_t *list = json_array();
  for (size_t k = 0; k < hr2d_scene_gases(r->scene); k++)
    for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++) json_push(&list, gas_in(r, k, b));
  return list;
}

/* The keys of the method, which every solve has; null if they mean nothing to it. */
static void put_method(json_t **root, const run *r) {
  const options *o = r->options;
  const int free_choice = !options_targeted(o) && !o->enclosure;
  json_put(root, "order", json_count(r->account.order));
  json_put(root, "epsilon", free_choice ? json_number(o->epsilon) : json_null());
  json_put(root, "oracle",
           json_text(free_choice    ? o->oracle->name
                     : o->enclosure ? "enclosure"
                                    : "separation"));
  json_put(root, "variant", free_choice ? json_text(o->policy->name) : json_null());
  json_put(root, "target", target(r));
}

static void put_counts(json_t **root, const run *r, const hr2d_refine_counts *n) {
  json_put(root, "elements", json_count(n->elements));
  json_put(root, "leaves", json_count(n->leaves));
  json_put(root, "links", json_count(r->account.links));
  json_put(root, "limited_links", json_count(n->limited_links));
  json_put(root, "levels", json_count(n->levels));
}

/* Of the rank that has most. */
static json_t *ranks(const run *r) {
  json_t *object = json_object();
  json_put(&object, "count", json_count(r->share->count));
  json_put(&object, "most_links", json_count(r->max_links));
  json_put(&object, "most_visibility_tests", json_count(r->max_tests));
  json_put(&object, "most_bytes", json_count(r->max_bytes));
  return object;
}

static double *ends_of(const run *r, double read(const hr2d_enclosure *, size_t, size_t),
                       size_t patch) {
  const size_t bands = hr2d_scene_bands(r->scene);
  double *end = malloc(bands * sizeof *end);
  for (size_t b = 0; end && b < bands; b++) end[b] = read(r->enclosure, patch, b);
  return end;
}

/* One end of the averages of all patches and bands. */
static json_t *ends(const run *r, double read(const hr2d_enclosure *, size_t, size_t)) {
  json_t *list = json_array();
  for (size_t k = 0; k < hr2d_scene_patches(r->scene); k++) {
    double *end = ends_of(r, read, k);
    json_push(&list, end ? json_numbers(end, hr2d_scene_bands(r->scene)) : NULL);
    free(end);
  }
  return list;
}

/* Of --enclose; null without it. */
static json_t *enclosed(const run *r) {
  const hr2d_enclosure_account *a = &r->enclosed;
  double average, irradiance;
  if (!r->enclosure) return json_null();
  run_enclosed_errors(r, &average, &irradiance);
  json_t *object = json_object(), *h = json_object();
  json_put(&object, "error", json_number(average));
  json_put(&object, "lower", ends(r, hr2d_enclosure_lower));
  json_put(&object, "upper", ends(r, hr2d_enclosure_upper));
  json_put(&h, "error", json_number(irradiance));
  json_put(&h, "lower", ends(r, hr2d_enclosure_lower_irradiance));
  json_put(&h, "upper", ends(r, hr2d_enclosure_upper_irradiance));
  json_put(&object, "irradiance", h);
  json_put(&object, "gap", json_number(a->gap));
  json_put(&object, "links", json_count(a->links));
  json_put(&object, "seconds", json_number(a->seconds));
  json_put(&object, "reason", json_text(a->reason));
  return object;
}

json_t *solve_json(const run *r, double total_seconds) {
  const options *o = r->options;
  const hr2d_refine_counts counts = hr2d_linkset_counts(r->links);
  json_t *root = json_object();
  json_put(&root, "scene", json_text(o->scene));
  json_put(&root, "provenance", provenance_json());
  json_put(&root, "cuts", json_count(r->cuts));
  json_put(&root, "patches", patches(r));
  json_put(&root, "at", places(r));
  put_counts(&root, r, &counts);
  put_method(&root, r);
  json_put(&root, "effects", json_effects(r->scene));
  json_put(&root, "work", work(r, &counts));
  json_put(&root, "seconds", times(r, total_seconds));
  json_put(&root, "peak_bytes", json_count(run_peak_bytes()));
  if (r->share) json_put(&root, "ranks", ranks(r));
  json_put(&root, "power", power(r));
  if (scene_has_gas(r->scene)) json_put(&root, "gas", gas(r));
  json_put(&root, "residual", json_number(hr2d_solution_residual(r->solution)));
  json_put(&root, "error", errors(r));
  if (r->options->enclose > 0) json_put(&root, "enclosed", enclosed(r));
  json_put(&root, "warnings", json_incref(r->warnings->list));
  json_put(&root, "status", json_text(r->inaccurate ? "inaccurate" : "ok"));
  return root;
}

int solve_write_json(const run *r, double total_seconds, const char *path) {
  return json_write(solve_json(r, total_seconds), path);
}
