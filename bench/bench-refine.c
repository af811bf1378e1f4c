/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the cost of the public vtables against the plainest recursion that does the same
   work, and of a sweep against the plainest loop over the same links.

   Both refine two unit patches at distance 0.1 with max(A)/r ≤ ε, original variant,
   in rounds that alternate.  Medians of processor time, their ratios, and the bars of these are
   printed.  The recursion grows the same trees (N is counted, too), decides by A² ≤ ε²r², and
   stores what a link needs, with the textbook's crossed strings. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plain.h"
#include "solve/transport.h"
#include "timing.h"

enum { ROUNDS = 7, SWEEPS = 5 };

typedef struct set {
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
} set;

static set make_set(hr2d_scene *scene) {
  set s = {NULL, NULL};
  if (hr2d_hierarchy_create(scene, &s.hierarchy) ||
      hr2d_linkset_create(s.hierarchy, NULL, NULL, NULL, NULL, &s.links))
    exit(EXIT_FAILURE);
  return s;
}

static void free_set(set *s) {
  hr2d_linkset_destroy(s->links);
  hr2d_hierarchy_destroy(s->hierarchy);
}

typedef enum work { COUNTED, STORED, PACKED } work;

static double run_library(hr2d_scene *scene, double epsilon, work kind, uint64_t *links,
                          double *bytes) {
  const double start = cpu_seconds();
  set s = make_set(scene);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2d_refine_counts counts = {0};
  options.epsilon = epsilon;
  options.packed = kind == PACKED;
  if (kind == COUNTED ? hr2d_refine_count(s.links, &options, &counts)
                      : hr2d_refine(s.links, &options))
    exit(EXIT_FAILURE);
  const double seconds = cpu_seconds() - start;
  *links = kind == COUNTED ? counts.links : hr2d_linkset_size(s.links);
  *bytes = (double)hr2d_linkset_bytes(s.links) / (double)*links;
  free_set(&s);
  return seconds;
}

/* Gather, push and pull of one transport, and the loop over the same links. */
static void run_sweeps(hr2d_scene *scene, double epsilon, int packed, uint64_t *links,
                       double *library, double *plain) {
  set s = make_set(scene);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  options.packed = packed;
  hr2di_transport t;
  if (hr2d_refine(s.links, &options) || hr2di_transport_init(&t, s.links, 0, 1, NULL))
    exit(EXIT_FAILURE);
  *links = hr2d_linkset_size(s.links);
  hr2d_link *copy = malloc((size_t)*links * sizeof *copy);
  double *field = calloc(2 * t.leaves, sizeof *field);
  if (!copy || !field) exit(EXIT_FAILURE);
  for (uint64_t k = 0; k < *links; k++) copy[k] = hr2d_linkset_get(s.links, k);
  for (size_t k = 0; k < t.leaves; k++) field[k] = 1;
  hr2di_transport_apply(&t, field, field + t.leaves);
  const double start = cpu_seconds();
  for (int k = 0; k < SWEEPS; k++) hr2di_transport_apply(&t, field, field + t.leaves);
  *library = (cpu_seconds() - start) / SWEEPS;
  *plain = plain_sweeps(copy, *links, t.elements, SWEEPS) / SWEEPS;
  free(copy);
  free(field);
  hr2di_transport_clear(&t);
  free_set(&s);
}

static hr2d_scene *make_scene(void) {
  const double half = 0.5, one = 1;
  const hr2d_patch floor = {.a = {0, 0},
                            .b = {1, 0},
                            .emission = &one,
                            .emission_bands = 1,
                            .reflectance = &half,
                            .reflectance_bands = 1};
  const hr2d_patch ceiling = {
      .a = {1, .1}, .b = {0, .1}, .reflectance = &half, .reflectance_bands = 1};
  hr2d_scene *scene = NULL;
  if (hr2d_scene_create(NULL, &scene) || hr2d_scene_add(scene, &floor, NULL) ||
      hr2d_scene_add(scene, &ceiling, NULL) || hr2d_scene_commit(scene))
    exit(EXIT_FAILURE);
  return scene;
}

enum {
  PLAIN_STORED,
  LIBRARY_STORED,
  LIBRARY_PACKED,
  PLAIN_COUNTED,
  LIBRARY_COUNTED,
  PLAIN_REGISTERS,
  LIBRARY_SWEEP,
  PLAIN_SWEEP,
  PACKED_SWEEP,
  PLAIN_AGAIN,
  TIMES
};

/* A bar of 0 stands for none. */
static void print(const char *what, double library, double plain, double bar) {
  printf("%-38s%9.2f%9.2f%8.2f", what, library, plain, library / plain);
  if (bar > 0) printf("%8.2f  %s", bar, library <= bar * plain ? "holds" : "MISSED");
  printf("\n");
}

int main(int argc, char **argv) {
  const double epsilon = argc > 1 ? strtod(argv[1], NULL) : 1. / 256;
  hr2d_scene *scene = make_scene();
  double time[TIMES][ROUNDS], bytes = 0, packed = 0, unused;
  uint64_t links[TIMES];
  for (int k = 0; k < ROUNDS; k++) {
    time[PLAIN_STORED][k] = plain_run(0.1, epsilon, 1, &links[PLAIN_STORED]);
    time[LIBRARY_STORED][k] =
        run_library(scene, epsilon, STORED, &links[LIBRARY_STORED], &bytes);
    time[LIBRARY_PACKED][k] =
        run_library(scene, epsilon, PACKED, &links[LIBRARY_PACKED], &packed);
    time[PLAIN_COUNTED][k] = plain_run(0.1, epsilon, 0, &links[PLAIN_COUNTED]);
    time[LIBRARY_COUNTED][k] =
        run_library(scene, epsilon, COUNTED, &links[LIBRARY_COUNTED], &unused);
    time[PLAIN_REGISTERS][k] = plain_count(0.1, epsilon, &links[PLAIN_REGISTERS]);
    run_sweeps(scene, epsilon, 0, &links[LIBRARY_SWEEP], &time[LIBRARY_SWEEP][k],
               &time[PLAIN_SWEEP][k]);
    run_sweeps(scene, epsilon, 1, &links[PACKED_SWEEP], &time[PACKED_SWEEP][k],
               &time[PLAIN_AGAIN][k]);
    links[PLAIN_SWEEP] = links[LIBRARY_SWEEP];
    links[PLAIN_AGAIN] = links[PACKED_SWEEP];
  }
  hr2d_scene_destroy(scene);
  double ns[TIMES];
  for (int k = 0; k < TIMES; k++) {
    if (links[k] != links[0]) {
      fprintf(stderr, "bench_refine: the numbers of links differ\n");
      return EXIT_FAILURE;
    }
    ns[k] = 1e9 * median_of(time[k], ROUNDS) / (double)links[k];
  }
  printf("two unit patches, d = 0.1, epsilon = %g: L = %llu; ns per link, medians of %d\n",
         epsilon, (unsigned long long)links[0], ROUNDS);
  printf("%-38s%9s%9s%8s%8s\n", "", "library", "plain", "ratio", "bar");
  print("refine, exact areas, stored", ns[LIBRARY_STORED], ns[PLAIN_STORED], 1);
  print("refine, exact areas, packed", ns[LIBRARY_PACKED], ns[PLAIN_STORED], 0);
  print("count, with trees", ns[LIBRARY_COUNTED], ns[PLAIN_COUNTED], 0.7);
  print("count, plain without trees or N", ns[LIBRARY_COUNTED], ns[PLAIN_REGISTERS], 0);
  print("sweep with push and pull, plain: links", ns[LIBRARY_SWEEP], ns[PLAIN_SWEEP], 0);
  print("the same, links packed", ns[PACKED_SWEEP], ns[PLAIN_AGAIN], 1.3 / 1.9);
  print("bytes per stored link", bytes, 16, 0);
  print("bytes per packed link", packed, 16, 12. / 16);
  return EXIT_SUCCESS;
}
