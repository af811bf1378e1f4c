/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result, with the keys and the titles of `hr2d solve`, and what ranks have. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "cli/scene.h"
#include "output/clock.h"
#include "output/complain.h"
#include "output/json.h"
#include "output/provenance.h"
#include "output/table.h"
#include "program.h"

typedef struct result {
  const job *j;
  hr2dp_counts n;
  double *average, *irradiance; /* patches × bands */
  double total;                 /* seconds */
  uint64_t peak_bytes, halo;    /* of the rank that has most */
} result;

static void print_patches(const result *r) {
  const hr2d_scene *scene = r->j->scene;
  const size_t bands = hr2d_scene_bands(scene);
  const int width = table_name_width(scene);
  table_patch_titles(width);
  printf("%s  %12s  %12s  %12s\n", bands > 1 ? "  band" : "", "average B", "average H",
         "B - H");
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    if (!table_patch(scene, k, width)) continue;
    for (size_t b = 0; b < bands; b++) {
      const double value = r->average[k * bands + b], h = r->irradiance[k * bands + b];
      if (b) printf("%*s", 7 + width + 14, "");
      if (bands > 1) printf("  %4zu", b);
      printf("  %12.6g  %12.6g  %12.6g\n", value, h, value - h);
    }
  }
}

static void print(const result *r) {
  const options *o = r->j->options;
  const hr2d_refine_counts *n = &r->n.whole;
  scene_print(o, 9, r->j->cuts);
  print_patches(r);
  puts("");
  if (o->enclosure)
    puts("method    enclosure: one radiosity for each patch");
  else
    printf("method    oracle %s, variant %s, epsilon %g\n", o->oracle->name, o->policy->name,
           o->epsilon);
  if (r->j->resumed > 0) printf("          from epsilon %g in %s\n", r->j->resumed, o->state);
  printf("elements  N = %llu, of which %llu leaves, on levels 0 to %u\n",
         (unsigned long long)n->elements, (unsigned long long)n->leaves, n->levels);
  printf("links     L = %llu\n", (unsigned long long)n->links);
  printf("ranks     %d, with at most %llu links, %llu elements and %.0f MB\n", r->j->ranks,
         (unsigned long long)r->n.max_links, (unsigned long long)r->n.max_elements,
         (double)r->peak_bytes / 1e6);
  printf("work      %llu sweeps, %llu iterations, residual %.1e\n",
         (unsigned long long)r->j->report.sweeps, (unsigned long long)r->j->report.iterations,
         r->j->report.residual);
  printf("seconds   refine %.3f, solve %.3f, total %.3f\n", r->j->refine_seconds,
         r->j->solve_seconds, r->total);
}

static json_t *json_patches(const result *r) {
  const size_t bands = hr2d_scene_bands(r->j->scene);
  json_t *list = json_array();
  for (size_t k = 0; k < hr2d_scene_patches(r->j->scene); k++) {
    json_t *patch = json_patch(r->j->scene, k);
    json_put(&patch, "average", json_numbers(r->average + k * bands, bands));
    json_put(&patch, "irradiance", json_numbers(r->irradiance + k * bands, bands));
    json_push(&list, patch);
  }
  return list;
}

static json_t *json_work(const result *r) {
  const hr2d_refine_counts *n = &r->n.whole;
  json_t *object = json_object();
  json_put(&object, "oracle_calls", json_count(n->oracle_calls));
  json_put(&object, "repeated_calls", json_count(r->n.repeated_calls));
  json_put(&object, "facing_tests", json_count(n->facing_tests));
  json_put(&object, "visibility_tests", json_count(n->visibility_tests));
  json_put(&object, "exchange_areas", json_count(n->exchange_areas));
  json_put(&object, "partial_links", json_count(n->partial_links));
  json_put(&object, "blocked_pairs", json_count(n->blocked_pairs));
  json_put(&object, "dark_pairs", json_count(n->dark_pairs));
  json_put(&object, "sweeps", json_count(r->j->report.sweeps));
  json_put(&object, "iterations", json_count(r->j->report.iterations));
  json_put(&object, "row_sums", json_count(r->j->report.row_sums));
  return object;
}

/* Of the rank that has most, and of all ranks together. */
static json_t *json_ranks(const result *r) {
  json_t *object = json_object();
  json_put(&object, "count", json_count((uint64_t)r->j->ranks));
  json_put(&object, "most_links", json_count(r->n.max_links));
  json_put(&object, "most_visibility_tests", json_count(r->n.max_tests));
  json_put(&object, "most_elements", json_count(r->n.max_elements));
  json_put(&object, "most_halo_elements", json_count(r->halo));
  json_put(&object, "most_bytes", json_count(r->peak_bytes));
  return object;
}

static json_t *json_seconds(const result *r) {
  json_t *object = json_object();
  json_put(&object, "refine", json_number(r->j->refine_seconds));
  json_put(&object, "solve", json_number(r->j->solve_seconds));
  json_put(&object, "total", json_number(r->total));
  return object;
}

static json_t *json_power(const result *r) {
  json_t *list = json_array();
  for (size_t b = 0; b < hr2d_scene_bands(r->j->scene); b++) {
    const hr2d_power *p = &r->j->report.power[b];
    json_t *band = json_object();
    json_put(&band, "emitted", json_number(p->emitted));
    json_put(&band, "received", json_number(p->received));
    json_put(&band, "absorbed", json_number(p->absorbed));
    json_put(&band, "escaped", json_number(p->escaped));
    json_push(&list, band);
  }
  return list;
}

static int write_json(const result *r, const char *path) {
  const options *o = r->j->options;
  const hr2d_refine_counts *n = &r->n.whole;
  json_t *root = json_object();
  json_put(&root, "scene", json_text(o->scene));
  json_put(&root, "provenance", provenance_json());
  json_put(&root, "cuts", json_count(r->j->cuts));
  json_put(&root, "patches", json_patches(r));
  json_put(&root, "elements", json_count(n->elements));
  json_put(&root, "leaves", json_count(n->leaves));
  json_put(&root, "links", json_count(n->links));
  json_put(&root, "limited_links", json_count(n->limited_links));
  json_put(&root, "levels", json_count(n->levels));
  json_put(&root, "order", json_count(1));
  json_put(&root, "epsilon", o->enclosure ? json_null() : json_number(o->epsilon));
  json_put(&root, "oracle", json_text(o->enclosure ? "enclosure" : o->oracle->name));
  json_put(&root, "variant", o->enclosure ? json_null() : json_text(o->policy->name));
  json_put(&root, "effects", json_effects(r->j->scene));
  json_put(&root, "work", json_work(r));
  json_put(&root, "ranks", json_ranks(r));
  json_put(&root, "seconds", json_seconds(r));
  json_put(&root, "power", json_power(r));
  json_put(&root, "residual", json_number(r->j->report.residual));
  json_put(&root, "status", json_text("ok"));
  return json_write(root, path);
}

/* The largest peak and the largest halo of a rank. */
static void find_max(result *r) {
  struct rusage usage;
  uint64_t max[] = {getrusage(RUSAGE_SELF, &usage) ? 0 : (uint64_t)usage.ru_maxrss * 1024,
                    r->n.halo_elements};
  MPI_Allreduce(MPI_IN_PLACE, max, 2, MPI_UINT64_T, MPI_MAX, PETSC_COMM_WORLD);
  r->peak_bytes = max[0];
  r->halo = max[1];
}

static int tell(const result *r) {
  const options *o = r->j->options;
  int status = 0;
  if (options_want_table(o)) print(r);
  if (o->json) status = write_json(r, o->json);
  return status;
}

int job_report(job *j) {
  const size_t values = hr2d_scene_patches(j->scene) * hr2d_scene_bands(j->scene);
  result r = {.j = j, .n = {.struct_size = sizeof r.n}};
  r.average = calloc(2 * values, sizeof *r.average);
  int failed = !r.average || !j->report.power;
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  int status = failed ? (j->rank == 0 ? complain_memory() : EXIT_FAILED) : 0;
  if (!failed) {
    r.irradiance = r.average + values;
    PetscErrorCode code = hr2dp_averages(j->p, j->b, r.average);
    if (!code) code = hr2dp_averages(j->p, j->h, r.irradiance);
    if (!code) code = hr2dp_get_counts(j->p, &r.n);
    find_max(&r);
    r.total = clock_seconds() - j->start;
    if (code)
      status = job_complain(j, code);
    else if (j->rank == 0)
      status = tell(&r);
  }
  free(r.average);
  free(j->report.power);
  return job_agree(status);
}
