/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The summary of a run for people. */
#include <math.h>
#include <stdio.h>

#include "report.h"
#include "run.h"

/* Of many bands each has a line. */
static void print_values(const run *r, size_t patch, int indent) {
  const size_t bands = hr2d_scene_bands(r->scene);
  for (size_t b = 0; b < bands; b++) {
    if (b) printf("%*s", indent, "");
    if (bands > 1) printf("  %4zu", b);
    printf("  %12.6g  %12.6g  %12.6g\n", hr2d_solution_average(r->solution, patch, b),
           hr2d_solution_irradiance(r->solution, patch, b),
           hr2d_solution_net_flux(r->solution, patch, b));
  }
}

static void print_patches(const run *r) {
  const size_t count = hr2d_scene_patches(r->scene);
  const int width = name_width(r->scene);
  printf("\npatch  ");
  print_padded(stdout, "name", width);
  printf("  %12s%s  %12s  %12s  %12s\n", "length",
         hr2d_scene_bands(r->scene) > 1 ? "  band" : "", "average B", "average H", "B - H");
  for (size_t k = 0; k < count; k++) {
    if (is_skipped(k, count)) continue;
    printf("%5zu  ", k);
    print_padded(stdout, hr2d_scene_name(r->scene, k), width);
    printf("  %12.6g", hr2d_scene_length(r->scene, k));
    print_values(r, k, 7 + width + 14);
  }
  puts("");
}

static void print_places(const run *r) {
  const options *o = r->options;
  for (size_t k = 0; k < o->at_count; k++) {
    printf("at %s:%g ", o->at[k].patch, o->at[k].t);
    for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++)
      printf(" %.9g", hr2d_solution_at(r->solution, r->places[k], o->at[k].t, b));
    printf("  H");
    for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++)
      printf(" %.9g", hr2d_solution_irradiance_at(r->solution, r->places[k], o->at[k].t, b));
    puts("");
  }
  if (o->at_count) puts("");
}

static void print_counts(const run *r, const hr2d_refine_counts *n) {
  printf("elements  N = %llu, of which %llu leaves, on levels 0 to %u\n",
         (unsigned long long)n->elements, (unsigned long long)n->leaves, n->levels);
  printf("links     L = %llu, each for %s\n", (unsigned long long)n->links,
         hr2d_linkset_directed(r->links) ? "one direction" : "both directions");
  if (n->partial_links)
    printf("          %llu of them around occluders\n", (unsigned long long)n->partial_links);
  if (!n->limited_links) return;
  const int corner = hr2d_scene_effect(r->scene, HR2D_EFFECT_CORNER, NULL);
  printf("          recursion limit acted on %llu links at level %u%s\n",
         (unsigned long long)n->limited_links, r->options->max_level,
         corner ? " (touching patches)" : "");
}

/* Nothing escapes from a closed scene but rounding. */
static double beyond_rounding(double power, double in) {
  return fabs(power) > 1e-15 * in ? power : 0;
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
           beyond_rounding(p.absorbed, in), beyond_rounding(p.escaped, in), power_error(&p));
  }
}

static void print_effort(const run *r, const hr2d_refine_counts *n) {
  const effort list[] = {
      {"oracle calls", n->oracle_calls},   {"exchange areas", n->exchange_areas},
      {"facing tests", n->facing_tests},   {"visibility tests", n->visibility_tests},
      {"blocked pairs", n->blocked_pairs}, {"dark pairs", n->dark_pairs},
      {"row sums", r->work.row_sums}};
  print_work(list, sizeof list / sizeof *list);
}

void print_run(const run *r, double total_seconds) {
  const options *o = r->options;
  const hr2d_refine_counts counts = hr2d_linkset_counts(r->links);
  print_scene(o, 10, r->cuts);
  printf("method    oracle %s, variant %s, epsilon %g\n", o->oracle->name, o->policy->name,
         o->epsilon);
  print_patches(r);
  print_places(r);
  print_counts(r, &counts);
  print_power(r);
  print_effort(r, &counts);
  printf("solve     %llu gathers, %llu iterations, relative residual %.1e\n",
         (unsigned long long)r->work.gathers, (unsigned long long)r->work.iterations,
         hr2d_solution_residual(r->solution));
  printf("seconds   refine (with coefficients) %.3f, solve %.3f, total %.3f\n",
         r->refine_seconds, r->solve_seconds, total_seconds);
  printf("memory    %.1f MB at the peak\n", (double)peak_bytes() / 1e6);
}
