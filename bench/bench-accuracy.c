/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the cost of accuracy: hr2d_solve_to() against the paper's algorithm, the dense
   matrix and the plainest refinement; the cost per order; the predictions; scenes of many
   patches.

   bench_accuracy [--many [SECONDS]]: with --many also scenes of 100 to 10,000 patches, each
   with a time limit, 20 seconds unless given. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "dense.h"
#include "estimate/graded-solve.h"
#include "many.h"
#include "plain.h"
#include "support/radiosity-scenes.h"
#include "timing.h"

enum { ROUNDS = 9, FEW = 3 };

static radiosity_scenes scenes;

static void die(const char *what, hr2d_status status) {
  fprintf(stderr, "bench_accuracy: %s: %s\n", what, hr2d_strerror(status));
  exit(EXIT_FAILURE);
}

static const radiosity_scene *named(const char *name) {
  const radiosity_scene *scene = radiosity_scenes_find(&scenes, name);
  if (!scene) die(name, HR2D_EIO);
  return scene;
}

static hr2d_scene *make(const radiosity_scene *known) {
  hr2d_scene *scene = radiosity_scene_make(known, NULL);
  if (!scene) die(known->name, HR2D_ESCENE);
  return scene;
}

/* Median seconds of hr2d_solve_to(); the error of the last. */
static double time_solve_to(const radiosity_scene *known, double target_error, int rounds,
                            double *error, hr2d_account *account) {
  double time[ROUNDS];
  for (int k = 0; k < rounds; k++) {
    hr2d_scene *scene = make(known);
    hr2d_target target = HR2D_TARGET_INIT;
    hr2d_solution *solution = NULL;
    target.error = target_error;
    const double start = hr2di_clock_now();
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, account);
    time[k] = hr2di_clock_now() - start;
    if (!solution) die("hr2d_solve_to", status);
    *error = radiosity_average_error(known, solution);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
  return median_of(time, rounds);
}

/* The paper's algorithm: refinement by size and a solve, as exact as the error is worth. */
static double time_paper(const radiosity_scene *known, double epsilon, int closure,
                         double *error, uint64_t *links) {
  hr2d_scene *scene = make(known);
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *set = NULL;
  hr2d_solution *solution = NULL;
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  refine.epsilon = epsilon;
  solve.closure = closure ? HR2D_CLOSURE_ON : HR2D_CLOSURE_OFF;
  solve.tolerance = 1e-7;
  const double start = hr2di_clock_now();
  hr2d_status status = hr2d_hierarchy_create(scene, &hierarchy);
  if (!status) status = hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &set);
  if (!status) status = hr2d_refine(set, &refine);
  if (!status) status = hr2d_solve(set, &solve, &solution);
  const double seconds = hr2di_clock_now() - start;
  if (status) die("the paper's algorithm", status);
  *error = radiosity_average_error(known, solution);
  *links = hr2d_linkset_size(set);
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(set);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
  return seconds;
}

/* The largest ε = 2^(−k/4) that reaches the error, and the median time there. */
static double time_paper_to(const radiosity_scene *known, double target, int closure,
                            double *error, double *epsilon, uint64_t *links) {
  double time[FEW];
  *epsilon = 0.5;
  while (time_paper(known, *epsilon, closure, error, links) >= 0 && *error > target)
    *epsilon *= exp2(-0.25);
  for (int k = 0; k < FEW; k++) time[k] = time_paper(known, *epsilon, closure, error, links);
  return median_of(time, FEW);
}

static void compare_with_paper(const radiosity_scene *known) {
  double error, epsilon;
  uint64_t links;
  hr2d_account account;
  const double ours = time_solve_to(known, 1e-10, ROUNDS, &error, &account);
  printf("(a) two unit patches, d = 0.1; averages of B\n");
  printf("  hr2d_solve_to(1e-10)                %8.2f ms, error %.1e, order %u, L = %llu\n",
         1e3 * ours, error, account.order, (unsigned long long)account.links);
  for (int closure = 0; closure < 2; closure++) {
    const double paper = time_paper_to(known, 1e-5, closure, &error, &epsilon, &links);
    printf("  the paper's algorithm to 1e-5, %s %8.2f ms, error %.1e, ε = %.5f, L = %llu: "
           "%.1f times\n",
           closure ? "closed" : "plain ", 1e3 * paper, error, epsilon,
           (unsigned long long)links, paper / ours);
  }
}

static double dense_error(const radiosity_scene *known, size_t elements, dense_solver solver,
                          dense_times *times) {
  double average[RADIOSITY_MOST_PATCHES], worst = 0;
  hr2d_scene *scene = make(known);
  if (dense_radiosity(scene, elements, solver, average, times)) die("dense", HR2D_ENOMEM);
  for (size_t k = 0; k < known->patches; k++)
    worst = fmax(worst, fabs(average[k] / known->average[k] - 1));
  hr2d_scene_destroy(scene);
  return worst;
}

/* The error falls like the square of the elements' size: a guess from few of them, and a few
   more until it holds. */
static size_t dense_elements(const radiosity_scene *known, double target, dense_solver solver) {
  dense_times times;
  size_t elements = 128;
  double error;
  while ((error = dense_error(known, elements, solver, &times)) > target)
    elements = (size_t)ceil((double)elements * fmax(sqrt(error / target), 1.02));
  return elements;
}

static void compare_with_dense(const radiosity_scene *known) {
  double error;
  hr2d_account account;
  const double ours = time_solve_to(known, 1e-6, ROUNDS, &error, &account);
  const dense_solver fast = dense_has(DENSE_LAPACK) ? DENSE_LAPACK : DENSE_GSL;
  const size_t elements = dense_elements(known, 1e-6, fast);
  printf("(b) the same, to 1e-6\n");
  printf("  hr2d_solve_to(1e-6)                 %8.2f ms, error %.1e\n", 1e3 * ours, error);
  for (int k = 0; k < 2; k++) {
    const dense_solver solver = k ? DENSE_LAPACK : DENSE_GSL;
    double time[FEW], off = 0;
    dense_times times = {0, 0};
    if (!dense_has(solver)) continue;
    for (int n = 0; n < FEW; n++) {
      off = dense_error(known, elements, solver, &times);
      time[n] = times.matrix + times.solve;
    }
    const double dense = median_of(time, FEW);
    printf("  dense, LU by %-22s %8.0f ms, error %.1e, 2 × %zu elements: %.0f times%s\n",
           dense_name(solver), 1e3 * dense, off, elements, dense / ours,
           dense >= 100 * ours ? "" : " (LESS THAN 100)");
  }
}

static void compare_with_plain(const radiosity_scene *known) {
  double time[ROUNDS], error;
  uint64_t links = 0;
  hr2d_account account;
  const double ours = time_solve_to(known, 1e-12, ROUNDS, &error, &account);
  for (int k = 0; k < ROUNDS; k++) time[k] = plain_run(0.1, 1. / 128, 1, &links);
  const double stored = median_of(time, ROUNDS);
  for (int k = 0; k < ROUNDS; k++) time[k] = plain_count(0.1, 1. / 128, &links);
  const double counted = median_of(time, ROUNDS);
  printf("(c) the plainest recursion for %llu links alone\n", (unsigned long long)links);
  printf("  hr2d_solve_to(1e-12)                %8.2f ms, error %.1e\n", 1e3 * ours, error);
  printf("  trees, links and areas, stored      %8.2f ms: %.1f times\n", 1e3 * stored,
         stored / ours);
  printf("  links counted in registers          %8.2f ms: %.1f times\n", 1e3 * counted,
         counted / ours);
}

/* Graded trees for 3.3^−2p at order p: links, unknowns, ms and the error of averages. */
static void print_order(const radiosity_scene *known, unsigned order) {
  double time[FEW], error = 0, unknowns = 0, links = 0;
  for (int k = 0; k < FEW; k++) {
    hr2d_scene *scene = make(known);
    const hr2di_resolution fineness = {
        .order = order, .target = pow(3.3, -2.0 * order), .generations = order > 8 ? 2 : 1};
    const hr2d_target target = HR2D_TARGET_INIT;
    hr2di_graded answer = {0};
    hr2di_message message = {0};
    const double start = hr2di_clock_now();
    hr2d_status status = hr2di_graded_refine(&answer, scene, &fineness, &target, &message);
    if (!status) status = hr2di_graded_solve(&answer, &fineness, &target, &message);
    time[k] = hr2di_clock_now() - start;
    if (status) die(known->name, status);
    error = radiosity_average_error(known, answer.solution);
    unknowns = (double)(order * hr2d_hierarchy_count(answer.hierarchy).leaves);
    links = (double)hr2d_linkset_size(answer.links);
    hr2di_graded_clear(&answer);
    hr2d_scene_destroy(scene);
  }
  printf("  %-28s%4u%8.0f%8.0f%10.2f%10.1e\n", known->name, order, links, unknowns,
         1e3 * median_of(time, FEW), error);
}

static void print_orders(void) {
  printf("(d) orders, on trees graded for 3.3^-2p\n  %-28s%4s%8s%8s%10s%10s\n", "scene", "p",
         "links", "unknowns", "ms", "error");
  for (size_t k = 0; k < scenes.count; k++)
    for (unsigned order = 2; order <= 16; order += 2) print_order(&scenes.scene[k], order);
}

static void print_predictions(void) {
  double worst = 1;
  printf("(e) hr2d_predict() beside hr2d_solve_to(), ms and their ratio\n  %-28s%8s%10s%10s%8s"
         "%10s%10s%10s%10s\n",
         "scene", "target", "predicted", "taken", "ratio", "to tell", "true", "estimate",
         "bound");
  for (size_t k = 0; k < scenes.count; k++)
    for (double target_error = 1e-3; target_error > 5e-13; target_error *= 1e-3) {
      hr2d_scene *scene = make(&scenes.scene[k]);
      hr2d_target target = HR2D_TARGET_INIT;
      hr2d_prediction prediction;
      hr2d_account account;
      double error;
      target.error = target_error;
      const double start = hr2di_clock_now();
      const hr2d_status status = hr2d_predict(scene, &target, &prediction);
      const double telling = hr2di_clock_now() - start;
      if (status) die("hr2d_predict", status);
      hr2d_scene_destroy(scene);
      const double taken = time_solve_to(&scenes.scene[k], target_error, FEW, &error, &account);
      const double ratio = prediction.seconds / taken;
      worst = fmax(worst, fmax(ratio, 1 / ratio));
      printf("  %-28s%8.0e%10.2f%10.2f%8.2f%10.2f%10.1e%10.1e%10.1e%s\n", scenes.scene[k].name,
             target_error, 1e3 * prediction.seconds, 1e3 * taken, ratio, 1e3 * telling, error,
             account.average.estimate, account.average.bound,
             error > target_error            ? " MISSED"
             : error > account.average.bound ? " ABOVE THE BOUND"
                                             : "");
    }
  printf("  worst ratio, either way: %.2f\n", worst);
}

static hr2d_status stop_late(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  return hr2di_clock_now() > *(const double *)ctx ? HR2D_STOPPED : HR2D_OK;
}

/* 0 if it took longer than the limit. */
static int print_many(const many_kind *kind, size_t patches, double target_error,
                      double limit) {
  const double start = cpu_seconds();
  hr2d_scene *scene = kind->make(patches);
  const double made = cpu_seconds() - start;
  if (!scene) die(kind->name, HR2D_ESCENE);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  hr2d_account account = {0};
  const double begin = cpu_seconds(), wall = hr2di_clock_now();
  double end = wall + limit;
  target.error = target_error;
  target.progress = stop_late;
  target.progress_ctx = &end;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
  const double seconds = cpu_seconds() - begin, passed = hr2di_clock_now() - wall;
  printf("  %-20s%8zu%8.0e%10llu%12llu%8.1f%10.0f%10.0f%10.1e%10.1e  %s %s\n", kind->name,
         hr2d_scene_patches(scene), target_error, (unsigned long long)account.leaves,
         (unsigned long long)account.links,
         (double)account.links / (double)hr2d_scene_patches(scene), 1e3 * made, 1e3 * seconds,
         account.average.estimate, account.average.bound, status ? hr2d_strerror(status) : "",
         status == HR2D_STOPPED ? "" : account.reason);
  fflush(stdout);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return passed < limit && made < limit;
}

static void print_all_many(double limit) {
  static const size_t patches[] = {100, 300, 1000, 3000, 10000};
  printf("(f) many patches, at most %g s each\n  %-20s%8s%8s%10s%12s%8s%10s%10s%10s%10s\n",
         limit, "scene", "patches", "target", "leaves", "links", "L/n", "commit ms", "solve ms",
         "estimate", "bound");
  for (size_t k = 0; k < many_kind_count; k++)
    for (double target = 1e-3; target > 1e-7; target *= 1e-3)
      for (size_t n = 0; n < sizeof patches / sizeof *patches; n++)
        if (!print_many(&many_kinds[k], patches[n], target, limit)) break;
}

static void read_scenes(void) {
  const char *folder = getenv("HR2D_TEST_DATA");
  char path[4096];
  snprintf(path, sizeof path, "%s/radiosity_fine.csv", folder ? folder : BENCH_DATA);
  if (radiosity_scenes_read(path, &scenes)) die(path, HR2D_EIO);
}

int main(int argc, char **argv) {
  const int many = argc > 1 && strcmp(argv[1], "--many") == 0;
  if (argc > 1 && !many) {
    fprintf(stderr, "usage: bench-accuracy [--many [SECONDS]]\n");
    return 2;
  }
  read_scenes();
  const radiosity_scene *plates = named("par_d0.1_rho0.5");
  compare_with_paper(plates);
  compare_with_dense(plates);
  compare_with_plain(plates);
  print_orders();
  print_predictions();
  if (many) print_all_many(argc > 2 ? strtod(argv[2], NULL) : 20);
  return EXIT_SUCCESS;
}
