/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The summary of a run for people. */
#include <stdio.h>

#include "report.h"
#include "run.h"

static void print_patches(const run *r) {
  const size_t bands = hr2d_scene_bands(r->scene);
  const int width = name_width(r->scene);
  printf("\npatch  ");
  print_padded(stdout, "name", width);
  printf("  %12s", "length");
  for (size_t b = 0; b < bands; b++) {
    char title[32] = "average B";
    if (bands > 1) snprintf(title, sizeof title, "average B%zu", b);
    printf("  %12s", title);
  }
  puts("");
  for (size_t k = 0; k < hr2d_scene_patches(r->scene); k++) {
    printf("%5zu  ", k);
    print_padded(stdout, hr2d_scene_name(r->scene, k), width);
    printf("  %12.6g", hr2d_scene_length(r->scene, k));
    for (size_t b = 0; b < bands; b++)
      printf("  %12.6g", hr2d_solution_average(r->solution, k, b));
    puts("");
  }
  puts("");
}

static void print_places(const run *r) {
  const options *o = r->options;
  for (size_t k = 0; k < o->at_count; k++) {
    printf("at %s:%g ", o->at[k].patch, o->at[k].t);
    for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++)
      printf(" %.9g", hr2d_solution_at(r->solution, r->places[k], o->at[k].t, b));
    puts("");
  }
  if (o->at_count) puts("");
}

static void print_counts(const run *r, const hr2d_refine_counts *n) {
  printf("elements  N = %llu, of which %llu leaves, on levels 0 to %u\n",
         (unsigned long long)n->elements, (unsigned long long)n->leaves, n->levels);
  printf("links     L = %llu, each for %s\n", (unsigned long long)n->links,
         hr2d_linkset_directed(r->links) ? "one direction" : "both directions");
  if (!n->limited_links) return;
  const int corner = hr2d_scene_effect(r->scene, HR2D_EFFECT_CORNER, NULL);
  printf("          recursion limit acted on %llu links at level %u%s\n",
         (unsigned long long)n->limited_links, r->options->max_level,
         corner ? " (touching patches)" : "");
}

static void print_power(const run *r) {
  const size_t bands = hr2d_scene_bands(r->scene);
  for (size_t b = 0; b < bands; b++) {
    const hr2d_power p = hr2d_solution_power(r->solution, b);
    char title[32] = "power";
    if (bands > 1) snprintf(title, sizeof title, "power %zu", b);
    printf("%-9s emitted %.6g = absorbed %.6g + escaped %.6g\n", title, p.emitted, p.absorbed,
           p.escaped);
  }
}

void print_run(const run *r, double total_seconds) {
  const options *o = r->options;
  const hr2d_refine_counts counts = hr2d_linkset_counts(r->links);
  printf("scene     %s\n", o->scene);
  printf("method    oracle %s, variant %s, epsilon %g\n", o->oracle->name, o->policy->name,
         o->epsilon);
  print_patches(r);
  print_places(r);
  print_counts(r, &counts);
  print_power(r);
  printf("solve     %llu sweeps, relative residual %.1e\n", (unsigned long long)r->sweeps,
         hr2d_solution_residual(r->solution));
  printf("seconds   refine (with coefficients) %.3f, solve %.3f, total %.3f\n",
         r->refine_seconds, r->solve_seconds, total_seconds);
  printf("memory    %.1f MB at the peak\n", (double)peak_bytes() / 1e6);
}
