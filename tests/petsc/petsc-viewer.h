/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of states, for tests over ranks. */
#ifndef HR2D_TESTS_PETSC_VIEWER_H
#define HR2D_TESTS_PETSC_VIEWER_H

#include <petscviewer.h>
#include <string.h>

/* `kind` is "binary" or "hdf5". */
static inline PetscErrorCode petsc_viewer_open(const char *kind, const char *path,
                                               PetscFileMode mode, PetscViewer *viewer) {
  PetscFunctionBegin;
  PetscCall(PetscViewerCreate(PETSC_COMM_WORLD, viewer));
  PetscCall(
      PetscViewerSetType(*viewer, strcmp(kind, "hdf5") ? PETSCVIEWERBINARY : PETSCVIEWERHDF5));
  PetscCall(PetscViewerFileSetMode(*viewer, mode));
  PetscCall(PetscViewerFileSetName(*viewer, path));
  PetscFunctionReturn(0);
}

#endif
