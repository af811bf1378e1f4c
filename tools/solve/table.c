/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The summary of a run for people. */
#include "output/table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/scene.h"
#include "output/complain.h"
#include "output/printable.h"
#include "solve/solve.h"

/* A line for each band; lines after the first are indented. */
static void print_values(const run *r, size_t patch, int indent) {
  const size_t bands = hr2d_scene_bands(r->scene);
  for (size_t b = 0; b < bands; b++) {
    if (b) printf("%*s", indent, "");
    if (bands > 1) printf("  %4zu", b);
    printf("  %12.6g  %12.6g  %12.6g", hr2d_solution_average(r->solution, patch, b),
           hr2d_solution_irradiance(r->solution, patch, b),
           hr2d_solution_net_flux(r->solution, patch, b));
    if (run_sun_exists(r->scene)) printf("  %12.6g", hr2d_scene_sunlight(r->scene, patch, b));
    puts("");
  }
}

static void print_patches(const run *r) {
  const int width = table_name_width(r->scene);
  table_patch_titles(width);
  printf("%s  %12s  %12s  %12s", hr2d_scene_bands(r->scene) > 1 ? "  band" : "", "average B",
         "average H", "B - H");
  if (run_sun_exists(r->scene)) printf("  %12s", "H of the sun");
  puts("");
  for (size_t k = 0; k < hr2d_scene_patches(r->scene); k++)
    if (table_patch(r->scene, k, width)) print_values(r, k, 7 + width + 14);
}

static void print_bounded(double value, double bound) {
  printf("  %14.9g", value);
  if (isnan(bound))
    printf("  %8s", "unknown");
  else
    printf("  %8.1e", bound);
}

/* Temperatures and the heat that leaves, with the bounds of their errors if they are known. */
static int print_heat(const run *r) {
  run_heat heat;
  const int status = run_heat_find(r, &heat);
  const int width = table_name_width(r->scene);
  if (heat.exists && !status) {
    table_patch_titles(width);
    printf("  %14s  %8s  %14s  %8s\n", "T in K", "at most", "heat in W/m", "at most");
  }
  for (size_t k = 0; heat.exists && !status && k < hr2d_scene_patches(r->scene); k++) {
    if (!table_patch(r->scene, k, width)) continue;
    if (isnan(heat.of.kelvin[k]))
      printf("  %14s  %8s", run_heat_word(heat.state[k]), "");
    else if (heat.state[k] == HR2D_TEMPERATURE_GIVEN)
      printf("  %14.9g  %8s", heat.of.kelvin[k], "given");
    else
      print_bounded(heat.of.kelvin[k], heat.of.bound[k]);
    print_bounded(heat.of.heat[k], heat.of.heat_bound[k]);
    puts("");
  }
  run_heat_release(&heat);
  return status;
}

/* B and H at the points of --at.  Values of a high order have more digits than constants. */
static int print_places(const run *r) {
  const options *o = r->options;
  const size_t bands = hr2d_scene_bands(r->scene);
  const int digits = r->account.order > 1 ? 12 : 9;
  double *value = o->at.count ? malloc(2 * bands * sizeof *value) : NULL;
  int status = o->at.count && !value ? complain_memory() : EXIT_DONE;
  for (size_t k = 0; !status && k < o->at.count; k++) {
    status = run_place(r, k, value, value + bands);
    if (status) break;
    printf("at %s:%g ", o->at.items[k].patch, o->at.items[k].t);
    for (size_t b = 0; b < bands; b++) printf(" %.*g", digits, value[b]);
    printf("  H");
    for (size_t b = 0; b < bands; b++) printf(" %.*g", digits, value[bands + b]);
    if (run_sun_exists(r->scene)) printf("  sun");
    for (size_t b = 0; b < bands && run_sun_exists(r->scene); b++)
      printf(" %.*g", digits,
             hr2d_scene_sunlight_at(r->scene, r->places[k], o->at.items[k].t, b));
    const double kelvin = run_heat_at(r, r->places[k], o->at.items[k].t, value[bands]);
    if (!isnan(kelvin)) printf("  T %.*g", digits, kelvin);
    puts("");
  }
  if (o->at.count) puts("");
  free(value);
  return status;
}

static void print_method(const run *r) {
  const options *o = r->options;
  if (o->enclosure) {
    puts("method    enclosure: one radiosity for each patch");
    return;
  }
  if (!options_targeted(o)) {
    printf("method    oracle %s, variant %s, epsilon %g\n", o->oracle->name, o->policy->name,
           o->epsilon);
    if (r->rounds > 1)
      printf("          %u rounds, each by the light of the last\n", r->rounds);
    if (r->resumed > 0) printf("          from epsilon %g in %s\n", r->resumed, o->state);
    return;
  }
  printf("target   ");
  if (o->target_error > 0)
    printf(" error %g %s", o->target_error,
           o->norm == HR2D_NORM_SUP ? "at all points" : "in averages");
  for (size_t k = 0; k < o->importance.count; k++) {
    fputs(k ? ", " : " of ", stdout);
    printable_put(o->importance.items[k].patch, stdout);
  }
  if (o->time_budget > 0)
    printf("%s %g seconds", o->target_error > 0 ? " within" : " best within", o->time_budget);
  puts("");
}

/* Errors at points that nobody asked for are not measured. */
static void print_error_of(const char *title, const char *what, const hr2d_error *e) {
  if (isnan(e->estimate)) return;
  if (isinf(e->estimate))
    printf("%-9s %s unknown\n", title, what);
  else
    printf("%-9s %s about %.1e, at most %.1e\n", title, what, e->estimate, e->bound);
}

/* What an enclosure says about the averages. */
static void print_enclosed(const run *r) {
  double average, irradiance;
  if (!r->enclosure) return;
  run_enclosed_errors(r, &average, &irradiance);
  if (isinf(average) && isinf(irradiance))
    printf("enclosed  error of averages unknown");
  else
    printf(
        "enclosed  error of averages at most %.1e, of H %.1e, for certain\n          ends are "
        "%.1e apart",
        average, irradiance, r->enclosed.gap);
  printf(", by %llu links in %.3f s\n", (unsigned long long)r->enclosed.links,
         r->enclosed.seconds);
}

/* Relative errors of B and H. */
static void print_error(const run *r) {
  const hr2d_account *a = &r->account;
  if (isnan(a->average.estimate)) {
    puts("error     not measured");
    return;
  }
  print_error_of("error", "of averages", &a->average);
  print_error_of("", "at points", &a->sup);
  print_error_of("", "of averages of H", &a->irradiance);
  print_error_of("", "of H at points", &a->irradiance_sup);
  if (run_assumes_kinks(r)) puts("          if kinks make no more than the target");
}

static void print_seconds(const run *r, double total_seconds) {
  const hr2d_account *a = &r->account;
  if (a->order > 1)
    printf("seconds   refine %.3f, coefficients %.3f", a->refine_seconds,
           a->coefficients_seconds);
  else
    printf("seconds   refine (with coefficients) %.3f", a->refine_seconds);
  printf(", solve %.3f", a->solve_seconds);
  if (a->error_seconds > 0) printf(", error %.3f", a->error_seconds);
  printf(", total %.3f\n", total_seconds);
}

static void print_counts(const run *r, const hr2d_refine_counts *n) {
  printf("elements  N = %llu, of which %llu leaves, on levels 0 to %u\n",
         (unsigned long long)n->elements, (unsigned long long)n->leaves, n->levels);
  printf("links     L = %llu, each for %s\n", (unsigned long long)r->account.links,
         hr2d_linkset_directed(r->links) ? "one direction" : "both directions");
  if (r->account.links > n->links)
    printf("          %llu of them between clusters of patches\n",
           (unsigned long long)(r->account.links - n->links));
  if (n->partial_links)
    printf("          %llu of them around occluders\n", (unsigned long long)n->partial_links);
  /* With a target all elements exist before the links, and no limit acts. */
  if (!n->limited_links || options_targeted(r->options)) return;
  const int corner = hr2d_scene_effect(r->scene, HR2D_EFFECT_CORNER, NULL);
  printf("          recursion limit acted on %llu links at level %u%s\n",
         (unsigned long long)n->limited_links, r->options->max_level,
         corner ? " (touching patches)" : "");
}

/* From a closed scene no power escapes: a tiny number is rounding, which is larger at a high
   order with its many coefficients. */
static double beyond_rounding(double power, double in) {
  return fabs(power) > 1e-13 * in ? power : 0;
}

static void print_power(const run *r) {
  const size_t bands = hr2d_scene_bands(r->scene);
  for (size_t b = 0; b < bands; b++) {
    const hr2d_power p = hr2d_solution_power(r->solution, b);
    const double in = p.emitted + p.received;
    char title[32] = "power";
    if (bands > 1) snprintf(title, sizeof title, "power %zu", b);
    printf("%-9s emitted %.6g", title, p.emitted);
    if (p.received > 0) printf(" + received %.6g", p.received);
    printf(" = absorbed %.6g + escaped %.6g (relative error %.1e)\n",
           beyond_rounding(p.absorbed, in), beyond_rounding(p.escaped, in),
           run_power_error(&p));
    const double cut_off = hr2d_solution_power_cut_off(r->solution, b);
    if (cut_off > 0)
      printf("%-9s images that are cut off may make %.1e of what is received or escapes\n", "",
             cut_off);
  }
}

/* What a gas gives to the patches, or takes from them. */
static void print_gas_in(const run *r, size_t gas, size_t band) {
  char title[48] = "gas";
  double emission, heat;
  if (hr2d_solution_gas(r->solution, gas, band, &emission, &heat)) return;
  if (hr2d_scene_gases(r->scene) > 1) snprintf(title, sizeof title, "gas %zu", gas);
  if (hr2d_scene_bands(r->scene) > 1) {
    const size_t end = strlen(title);
    snprintf(title + end, sizeof title - end, "%s%zu", end > 3 ? ", band " : " ", band);
  }
  if (hr2d_scene_absorption(r->scene, gas, band) > 0)
    printf("%-9s emission %.6g, gives %.6g to %s\n", title, emission, heat,
           hr2d_scene_gases(r->scene) > 1 ? "patches and other gases" : "the patches");
  else
    printf("%-9s lets all light of this band through\n", title);
}

static void print_gas(const run *r) {
  for (size_t k = 0; k < hr2d_scene_gases(r->scene) && scene_has_gas(r->scene); k++)
    for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++) print_gas_in(r, k, b);
}

static void print_effort(const run *r, const hr2d_refine_counts *n) {
  const effort list[] = {
      {"oracle calls", n->oracle_calls},   {"exchange areas", n->exchange_areas},
      {"facing tests", n->facing_tests},   {"visibility tests", n->visibility_tests},
      {"blocked pairs", n->blocked_pairs}, {"dark pairs", n->dark_pairs},
      {"row sums", r->work.row_sums},      {"kernels", r->work.kernels}};
  table_print_work(list, sizeof list / sizeof *list);
}

int solve_print(const run *r, double total_seconds) {
  const hr2d_refine_counts counts = hr2d_linkset_counts(r->links);
  scene_print(r->options, 10, r->cuts);
  print_method(r);
  print_patches(r);
  int status = print_heat(r);
  puts("");
  if (!status) status = print_places(r);
  print_counts(r, &counts);
  printf("order     p = %u\n", r->account.order);
  print_power(r);
  print_gas(r);
  print_error(r);
  print_enclosed(r);
  print_effort(r, &counts);
  printf("solve     %llu gathers, %llu iterations, relative residual %.1e\n",
         (unsigned long long)r->work.gathers, (unsigned long long)r->work.iterations,
         hr2d_solution_residual(r->solution));
  print_seconds(r, total_seconds);
  printf("memory    %.1f MB at the peak\n", (double)run_peak_bytes() / 1e6);
  if (r->share)
    printf("ranks     %u, with at most %llu links and %.1f MB\n", r->share->count,
           (unsigned long long)r->max_links, (double)r->max_bytes / 1e6);
  return status;
}
