/* SPDX-License-Identifier: GPL-3.0-or-later */
/* check-rank-solution KIND save|load FILE CASE ORDER: as check-rank-state, of a solution of
   shares.  Prints a hash of B on the leaves of the file.  Exit status 3: the file is refused,
   with the reason on standard error. */
#include <hr2d-petsc.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "petsc/petsc-scenes.h"
#include "petsc/petsc-viewer.h"

enum { REFUSED = 3 };

typedef struct job {
  const petsc_case *c;
  hr2d_refine_options refine;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  PetscViewer viewer;
} job;

/* Of bits; a sum, so that the order of elements does not matter. */
static void print_hash(const job *j) {
  const hr2d_hierarchy_counts n = hr2d_hierarchy_count(j->hierarchy);
  const hr2d_element *element = hr2d_hierarchy_elements(j->hierarchy);
  const size_t width =
      hr2d_hierarchy_order(j->hierarchy) * hr2d_scene_bands(hr2d_hierarchy_scene(j->hierarchy));
  const double *field = hr2d_solution_field(j->solution);
  uint64_t sum = 0;
  for (size_t e = 0; e < n.elements; e++) {
    if (element[e].child) continue;
    uint64_t hash = 0xcbf29ce484222325;
    const unsigned char *place = (const unsigned char *)&element[e].centre;
    const unsigned char *value = (const unsigned char *)(field + e * width);
    for (size_t k = 0; k < sizeof element[e].centre; k++)
      hash = (hash ^ place[k]) * 0x100000001b3;
    for (size_t k = 0; k < width * sizeof *field; k++) hash = (hash ^ value[k]) * 0x100000001b3;
    sum += hash;
  }
  (void)PetscPrintf(PETSC_COMM_WORLD, "%016" PRIx64 "\n", sum);
}

static PetscErrorCode save(job *j) {
  PetscFunctionBegin;
  PetscCheck(!hr2d_refine(j->links, &j->refine) && !hr2d_solve(j->links, NULL, &j->solution),
             PETSC_COMM_WORLD, PETSC_ERR_LIB, "%s", hr2d_linkset_message(j->links));
  PetscCall(hr2dp_save_solution(j->solution, j->viewer));
  print_hash(j);
  PetscFunctionReturn(0);
}

/* A solve from there has nothing to do. */
static PetscErrorCode go_on(const job *j) {
  PetscFunctionBegin;
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *next = NULL;
  options.start = j->solution;
  PetscCheck(!hr2d_solve(j->links, &options, &next), PETSC_COMM_WORLD, PETSC_ERR_LIB, "%s",
             hr2d_linkset_message(j->links));
  const hr2d_scene *scene = hr2d_hierarchy_scene(j->hierarchy);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const double was = hr2d_solution_average(j->solution, k, 0);
    const double off = fabs(hr2d_solution_average(next, k, 0) - was);
    PetscCheck(off <= 1e-12 * (1 + was), PETSC_COMM_WORLD, PETSC_ERR_PLIB,
               "B of %zu moves by %.1e", k, off);
  }
  const int iterations = (int)hr2d_solution_work(next).iterations;
  hr2d_solution_destroy(next);
  PetscCheck(iterations <= 2, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "%d iterations", iterations);
  PetscFunctionReturn(0);
}

static PetscErrorCode load(job *j, int *refused) {
  PetscFunctionBegin;
  const char *general;
  char *specific;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  const PetscErrorCode failed =
      hr2dp_load_solution(j->links, &j->refine, NULL, j->viewer, &j->solution);
  PetscCall(PetscPopErrorHandler());
  if (failed) {
    PetscCall(PetscErrorMessage(failed, &general, &specific));
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, stderr, "refused: %s\n", specific));
    *refused = REFUSED;
    PetscFunctionReturn(0);
  }
  PetscCheck(hr2d_linkset_epsilon(j->links) == j->c->epsilon, PETSC_COMM_WORLD, PETSC_ERR_PLIB,
             "epsilon is %g", hr2d_linkset_epsilon(j->links));
  print_hash(j);
  PetscCall(go_on(j));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv) {
  int refused = 0;
  job j = {.refine = HR2D_REFINE_OPTIONS_INIT};
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCheck(argc == 6, PETSC_COMM_WORLD, PETSC_ERR_USER,
             "usage: KIND save|load FILE CASE ORDER");
  const int saves = !strcmp(argv[2], "save");
  j.c = petsc_case_named(argv[4]);
  hr2d_scene *scene = j.c ? petsc_case_scene(j.c, NULL) : NULL;
  PetscCheck(scene && !hr2d_hierarchy_create(scene, &j.hierarchy) &&
                 !hr2d_hierarchy_set_order(j.hierarchy, (unsigned)atoi(argv[5])) &&
                 !hr2d_linkset_create(j.hierarchy, NULL, NULL, NULL, NULL, &j.links),
             PETSC_COMM_SELF, PETSC_ERR_LIB, "no scene");
  j.refine.epsilon = j.c->epsilon;
  PetscCall(hr2dp_share_create(PETSC_COMM_WORLD, &j.refine.share));
  PetscCall(
      petsc_viewer_open(argv[1], argv[3], saves ? FILE_MODE_WRITE : FILE_MODE_READ, &j.viewer));
  if (saves)
    PetscCall(save(&j));
  else
    PetscCall(load(&j, &refused));
  PetscCall(PetscViewerDestroy(&j.viewer));
  hr2d_solution_destroy(j.solution);
  hr2d_linkset_destroy(j.links);
  hr2d_hierarchy_destroy(j.hierarchy);
  PetscCall(hr2dp_share_destroy(&j.refine.share));
  hr2d_scene_destroy(scene);
  PetscCall(PetscFinalize());
  return refused;
}
