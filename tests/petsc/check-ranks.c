/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refines and solves each case over all ranks, and on rank 0 alone by libhr2d.  Counts must be
   equal, B and H equal to 1e-12 of the largest on each patch.  Prints a line for each case with
   the hash of all bits of B and H, which the script compares between numbers of ranks.

   A negative control: if a rank does not ask for the originals of its images (touch() in
   petsc/trees.c), B of "streets" is off by a third on two ranks, and "quarter" fails. */
#include <hr2d-petsc.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "petsc/petsc-scenes.h"

static const double bar = 1e-12;

enum { VISIBILITY_TESTS = 6 }; /* its place among the counts */

/* What libhr2d makes of a case. */
typedef struct alone {
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
} alone;

static double first_epsilon(const petsc_case *c) {
  return c->from > 0 ? c->from : c->epsilon;
}

static hr2d_refine_options refine_options(const petsc_case *c, double epsilon) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  options.max_level = c->max_level;
  options.ordered = c->ordered;
  return options;
}

static hr2d_status solve_alone(const petsc_case *c, const hr2d_scene *scene, alone *a) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_status status = hr2d_hierarchy_create(scene, &a->hierarchy);
  if (!status)
    status = hr2d_linkset_create(a->hierarchy, c->oracle ? c->oracle() : NULL, NULL,
                                 c->policy ? c->policy() : NULL, NULL, &a->links);
  for (double e = first_epsilon(c); !status && e >= c->epsilon; e /= 2) {
    const hr2d_refine_options refine = refine_options(c, e);
    status = hr2d_refine(a->links, &refine);
  }
  options.closure = c->closure;
  if (!status) status = hr2d_solve(a->links, &options, &a->solution);
  if (status) fprintf(stderr, "%s alone: %s\n", c->name, hr2d_linkset_message(a->links));
  return status;
}

static void clear_alone(alone *a) {
  hr2d_solution_destroy(a->solution);
  hr2d_linkset_destroy(a->links);
  hr2d_hierarchy_destroy(a->hierarchy);
}

/* Which line classes a further refinement cuts in one go depends on the links that stand side
   by side, so that visibility tests are those of one process only for refinements from nothing.
 */
static int same_counts(const petsc_case *c, const hr2d_refine_counts *a,
                       const hr2d_refine_counts *b) {
  const uint64_t x[] = {a->elements,         a->leaves,         a->links,
                        a->limited_links,    a->oracle_calls,   a->facing_tests,
                        a->visibility_tests, a->exchange_areas, a->partial_links,
                        a->blocked_pairs,    a->dark_pairs,     a->levels};
  const uint64_t y[] = {b->elements,         b->leaves,         b->links,
                        b->limited_links,    b->oracle_calls,   b->facing_tests,
                        b->visibility_tests, b->exchange_areas, b->partial_links,
                        b->blocked_pairs,    b->dark_pairs,     b->levels};
  int same = 1;
  for (size_t k = 0; k < sizeof x / sizeof *x; k++) {
    if (x[k] == y[k] || (c->from > 0 && &x[k] == &x[VISIBILITY_TESTS])) continue;
    fprintf(stderr, "%s: count %zu is %" PRIu64 " alone and %" PRIu64 "\n", c->name, k, x[k],
            y[k]);
    same = 0;
  }
  return same;
}

/* The difference of a field from that of one process on one patch, leaf by leaf from left to
   right, relative to its largest value there; moves *field behind the patch. */
static double compare_patch(const alone *a, uint32_t patch, const double **field,
                            int irradiance) {
  const hr2d_element *element = hr2d_hierarchy_elements(a->hierarchy);
  const size_t bands = hr2d_scene_bands(hr2d_hierarchy_scene(a->hierarchy));
  uint32_t stack[1200];
  size_t depth = 0;
  double max = 0, off = 0, from = 0;
  stack[depth++] = patch;
  while (depth > 0) {
    const uint32_t e = stack[--depth];
    const double size = element[e].length / element[patch].length;
    if (element[e].child) {
      stack[depth++] = element[e].child + 1;
      stack[depth++] = element[e].child;
      continue;
    }
    for (size_t b = 0; b < bands; b++) {
      const double value =
          irradiance ? hr2d_solution_irradiance_at(a->solution, patch, from + size / 2, b)
                     : hr2d_solution_element(a->solution, e, b);
      const double other = *(*field)++;
      max = fmax(max, fabs(value));
      off = isfinite(other) ? fmax(off, fabs(value - other)) : HUGE_VAL;
    }
    from += size;
  }
  return max > 0 ? off / max : off;
}

/* The largest one of all patches. */
static double compare(const alone *a, const double *field, int irradiance) {
  double worst = 0;
  for (uint32_t k = 0; k < hr2d_scene_patches(hr2d_hierarchy_scene(a->hierarchy)); k++)
    worst = fmax(worst, compare_patch(a, k, &field, irradiance));
  return worst;
}

static uint64_t hash_of(uint64_t hash, const double *field, size_t count) {
  const unsigned char *byte = (const unsigned char *)field;
  for (size_t k = 0; k < count * sizeof *field; k++) hash = (hash ^ byte[k]) * 0x100000001b3;
  return hash;
}

/* A whole field on rank 0. */
static PetscErrorCode collect(Vec v, Vec *whole) {
  PetscFunctionBegin;
  VecScatter scatter;
  PetscCall(VecScatterCreateToZero(v, &scatter, whole));
  PetscCall(VecScatterBegin(scatter, v, *whole, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, v, *whole, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterDestroy(&scatter));
  PetscFunctionReturn(0);
}

/* The largest difference of averages, relative to the largest average. */
static double compare_averages(const alone *a, const hr2d_scene *scene, const double *average) {
  const size_t bands = hr2d_scene_bands(scene);
  double max = 0, off = 0;
  for (size_t k = 0; k < hr2d_scene_patches(scene) * bands; k++) {
    const double value = hr2d_solution_average(a->solution, k / bands, k % bands);
    max = fmax(max, fabs(value));
    off = fmax(off, fabs(value - average[k]));
  }
  return max > 0 ? off / max : off;
}

/* Prints the line of a case; returns 1 if something is not as it is alone. */
static int judge_fields(const petsc_case *c, const hr2d_scene *scene,
                        const hr2dp_counts *counts, const double *const field[2], size_t size,
                        const double *average) {
  alone a = {0};
  int failed = solve_alone(c, scene, &a) != HR2D_OK;
  if (!failed) {
    const hr2d_refine_counts n = hr2d_linkset_counts(a.links);
    const double off[] = {compare(&a, field[0], 0), compare(&a, field[1], 1),
                          compare_averages(&a, scene, average)};
    failed = !same_counts(c, &n, &counts->whole);
    if (!(off[0] <= bar && off[1] <= bar && off[2] <= bar)) {
      fprintf(stderr, "%s: B is off by %.2e, H by %.2e, averages by %.2e\n", c->name, off[0],
              off[1], off[2]);
      failed = 1;
    }
  }
  uint64_t hash = hash_of(0xcbf29ce484222325, field[0], size);
  hash = hash_of(hash, field[1], size);
  hash = hash_of(hash, average, hr2d_scene_patches(scene) * hr2d_scene_bands(scene));
  printf("%s: N %" PRIu64 ", L %" PRIu64 ", bits %016" PRIx64 "\n", c->name,
         counts->whole.elements, counts->whole.links, hash);
  clear_alone(&a);
  return failed;
}

static PetscErrorCode judge(const petsc_case *c, hr2dp *p, const hr2d_scene *scene, Vec b,
                            Vec h, const double *average, int *failed) {
  PetscFunctionBegin;
  PetscMPIInt rank;
  Vec whole[2];
  PetscInt size;
  const PetscScalar *field[2];
  hr2dp_counts counts = {.struct_size = sizeof counts};
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(hr2dp_get_counts(p, &counts));
  PetscCall(collect(b, &whole[0]));
  PetscCall(collect(h, &whole[1]));
  PetscCall(VecGetLocalSize(whole[0], &size));
  for (int k = 0; k < 2; k++) PetscCall(VecGetArrayRead(whole[k], &field[k]));
  if (rank == 0) *failed |= judge_fields(c, scene, &counts, field, (size_t)size, average);
  for (int k = 0; k < 2; k++) {
    PetscCall(VecRestoreArrayRead(whole[k], &field[k]));
    PetscCall(VecDestroy(&whole[k]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode run(const petsc_case *c, const hr2d_scene *scene, int *failed) {
  PetscFunctionBegin;
  hr2dp *p;
  Vec b, h;
  hr2dp_options options = HR2DP_OPTIONS_INIT;
  hr2dp_report report = HR2DP_REPORT_INIT;
  hr2d_solve_options how = HR2D_SOLVE_OPTIONS_INIT;
  double *average =
      malloc(hr2d_scene_patches(scene) * hr2d_scene_bands(scene) * sizeof *average);
  hr2d_power *power = malloc(hr2d_scene_bands(scene) * sizeof *power);
  PetscCheck(average && power, PETSC_COMM_SELF, PETSC_ERR_MEM, "out of memory");
  report.power = power;
  how.closure = c->closure;
  if (c->oracle) options.oracle = c->oracle();
  if (c->policy) options.policy = c->policy();
  PetscCall(hr2dp_create(PETSC_COMM_WORLD, scene, &options, &p));
  for (double e = first_epsilon(c); e >= c->epsilon; e /= 2) {
    const hr2d_refine_options refine = refine_options(c, e);
    PetscCall(hr2dp_refine(p, &refine));
  }
  PetscCall(hr2dp_vector(p, &b));
  PetscCall(hr2dp_vector(p, &h));
  PetscCall(hr2dp_solve(p, &how, b, h, &report));
  PetscCall(hr2dp_averages(p, b, average));
  PetscCall(judge(c, p, scene, b, h, average, failed));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&h));
  PetscCall(hr2dp_destroy(&p));
  free(average);
  free(power);
  PetscFunctionReturn(0);
}

static PetscErrorCode refuse(hr2d_scene *scene, int *failed) {
  PetscFunctionBegin;
  hr2dp *p = NULL;
  PetscCheck(!hr2d_scene_commit(scene), PETSC_COMM_SELF, PETSC_ERR_LIB, "no scene");
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  if (!hr2dp_create(PETSC_COMM_WORLD, scene, NULL, &p)) *failed = 1;
  PetscCall(PetscPopErrorHandler());
  PetscCall(hr2dp_destroy(&p));
  hr2d_scene_destroy(scene);
  PetscFunctionReturn(0);
}

/* Temperatures that divide what a patch emits among bands are not found by an hr2dp. */
static PetscErrorCode refuse_spectra(int *failed) {
  PetscFunctionBegin;
  static const double wavelength[] = {3}, emissivity[] = {0.5, 0.9};
  hr2d_scene *scene = NULL;
  hr2d_patch patch = HR2D_PATCH_INIT;
  hr2d_thermal heat = HR2D_THERMAL_INIT;
  patch.b.x = 1;
  heat.given = HR2D_HEAT_FLUX;
  heat.emissivity = emissivity;
  heat.emissivity_bands = 2;
  PetscCheck(!hr2d_scene_create(NULL, &scene) &&
                 !hr2d_scene_set_wavelengths(scene, wavelength, 1) &&
                 !hr2d_scene_add_thermal(scene, &patch, &heat, NULL),
             PETSC_COMM_SELF, PETSC_ERR_LIB, "no scene");
  PetscCall(refuse(scene, failed));
  PetscFunctionReturn(0);
}

/* Nor has it light that depends on its direction: a sun if `k` is 0, a piece of the sky if 1.
 */
static PetscErrorCode refuse_daylight(int k, int *failed) {
  PetscFunctionBegin;
  static const hr2d_sun sun = {{0, -1}, 1};
  static const hr2d_sky_piece piece = {0, 90};
  static const double one = 1;
  hr2d_scene *scene = NULL;
  hr2d_patch patch = HR2D_PATCH_INIT;
  patch.b.x = 1;
  PetscCheck(!hr2d_scene_create(NULL, &scene) &&
                 !(k ? hr2d_scene_set_sky(scene, &piece, 1, &one, 1)
                     : hr2d_scene_set_sun(scene, &sun, 1)) &&
                 !hr2d_scene_add(scene, &patch, NULL),
             PETSC_COMM_SELF, PETSC_ERR_LIB, "no scene");
  PetscCall(refuse(scene, failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv) {
  int failed = 0;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (size_t k = 0; petsc_case_at(k); k++) {
    if (argc > 1 && (size_t)atoi(argv[1]) != k) continue;
    hr2d_scene *scene = petsc_case_scene(petsc_case_at(k), NULL);
    PetscCheck(scene, PETSC_COMM_SELF, PETSC_ERR_LIB, "%s: no scene", petsc_case_at(k)->name);
    PetscCall(run(petsc_case_at(k), scene, &failed));
    hr2d_scene_destroy(scene);
  }
  PetscCall(refuse_spectra(&failed));
  for (int k = 0; k < 2; k++) PetscCall(refuse_daylight(k, &failed));
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  PetscCall(PetscFinalize());
  return failed;
}
