/* SPDX-License-Identifier: GPL-3.0-or-later */
/* check-rank-state KIND save|load FILE CASE: saves the B of a case by a viewer, "binary" or
   "hdf5", or loads it and goes on from there, which must take no iteration to speak of and
   leave B where it is.  Prints the hash of the B in the file.  Exit status 3: the file is
   refused, with the reason on standard error. */
#include <hr2d-petsc.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "petsc/petsc-scenes.h"
#include "petsc/petsc-viewer.h"

enum { REFUSED = 3 };

static PetscErrorCode print_hash(Vec b) {
  PetscFunctionBegin;
  VecScatter scatter;
  Vec whole;
  PetscInt size;
  const PetscScalar *value;
  uint64_t hash = 0xcbf29ce484222325;
  PetscCall(VecScatterCreateToZero(b, &scatter, &whole));
  PetscCall(VecScatterBegin(scatter, b, whole, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, b, whole, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetLocalSize(whole, &size));
  PetscCall(VecGetArrayRead(whole, &value));
  const unsigned char *byte = (const unsigned char *)value;
  for (size_t k = 0; k < (size_t)size * sizeof *value; k++)
    hash = (hash ^ byte[k]) * 0x100000001b3;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%016" PRIx64 "\n", hash));
  PetscCall(VecRestoreArrayRead(whole, &value));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&whole));
  PetscFunctionReturn(0);
}

static PetscErrorCode save(hr2dp *p, const char *kind, const char *path, double epsilon) {
  PetscFunctionBegin;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  Vec b;
  PetscViewer viewer;
  options.epsilon = epsilon;
  PetscCall(hr2dp_refine(p, &options));
  PetscCall(hr2dp_vector(p, &b));
  PetscCall(hr2dp_solve(p, NULL, b, NULL, NULL));
  PetscCall(petsc_viewer_open(kind, path, FILE_MODE_WRITE, &viewer));
  PetscCall(hr2dp_save(p, b, viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscCall(print_hash(b));
  PetscCall(VecDestroy(&b));
  PetscFunctionReturn(0);
}

static PetscErrorCode go_on(hr2dp *p, Vec b) {
  PetscFunctionBegin;
  hr2dp_report report = HR2DP_REPORT_INIT;
  Vec next;
  PetscReal max, off;
  PetscCall(VecDuplicate(b, &next));
  PetscCall(VecCopy(b, next));
  PetscCall(hr2dp_solve(p, NULL, next, NULL, &report));
  PetscCall(VecNorm(b, NORM_INFINITY, &max));
  PetscCall(VecAXPY(next, -1, b));
  PetscCall(VecNorm(next, NORM_INFINITY, &off));
  PetscCheck(off <= 1e-12 * max, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "B moves by %.1e",
             off / max);
  PetscCheck(report.iterations <= 2, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "%d iterations",
             (int)report.iterations);
  PetscCall(VecDestroy(&next));
  PetscFunctionReturn(0);
}

static PetscErrorCode load(hr2dp *p, const char *kind, const char *path, double epsilon,
                           int *refused) {
  PetscFunctionBegin;
  Vec b;
  PetscViewer viewer;
  double found;
  PetscCall(petsc_viewer_open(kind, path, FILE_MODE_READ, &viewer));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  const PetscErrorCode failed = hr2dp_load(p, NULL, viewer, &b, &found);
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscViewerDestroy(&viewer));
  if (failed) {
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, stderr, "refused: %s\n", hr2dp_message(p)));
    *refused = REFUSED;
    PetscFunctionReturn(0);
  }
  PetscCheck(found == epsilon, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "epsilon is %g", found);
  PetscCall(print_hash(b));
  PetscCall(go_on(p, b));
  PetscCall(VecDestroy(&b));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv) {
  int refused = 0;
  hr2dp *p;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCheck(argc == 5, PETSC_COMM_WORLD, PETSC_ERR_USER, "usage: KIND save|load FILE CASE");
  const petsc_case *c = petsc_case_named(argv[4]);
  PetscCheck(c, PETSC_COMM_WORLD, PETSC_ERR_USER, "no case %s", argv[4]);
  hr2d_scene *scene = petsc_case_scene(c, NULL);
  PetscCheck(scene, PETSC_COMM_SELF, PETSC_ERR_LIB, "no scene");
  PetscCall(hr2dp_create(PETSC_COMM_WORLD, scene, NULL, &p));
  if (!strcmp(argv[2], "save"))
    PetscCall(save(p, argv[1], argv[3], c->epsilon));
  else
    PetscCall(load(p, argv[1], argv[3], c->epsilon, &refused));
  PetscCall(hr2dp_destroy(&p));
  hr2d_scene_destroy(scene);
  PetscCall(PetscFinalize());
  return refused;
}
