/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The file of --state: written beside the old one, whose place it takes when it is whole. */
#include <stdio.h>
#include <unistd.h>

#include "program.h"

static PetscErrorCode open_file(const char *path, PetscFileMode mode, PetscViewer *viewer) {
  PetscFunctionBegin;
  PetscCall(PetscViewerCreate(PETSC_COMM_WORLD, viewer));
  PetscCall(PetscViewerSetType(*viewer, PETSCVIEWERBINARY));
  PetscCall(PetscViewerBinarySetSkipInfo(*viewer, PETSC_TRUE));
  PetscCall(PetscViewerFileSetMode(*viewer, mode));
  PetscCall(PetscViewerFileSetName(*viewer, path));
  PetscFunctionReturn(0);
}

PetscErrorCode state_file_open(const char *path, int rank, PetscViewer *viewer) {
  PetscFunctionBegin;
  *viewer = NULL;
  if (path && job_agree(rank == 0 && !access(path, F_OK)))
    PetscCall(open_file(path, FILE_MODE_READ, viewer));
  PetscFunctionReturn(0);
}

static PetscErrorCode name_beside(const char *path, char *beside, size_t size) {
  PetscFunctionBegin;
  PetscCheck(snprintf(beside, size, "%s.new", path) < (int)size, PETSC_COMM_WORLD,
             PETSC_ERR_FILE_OPEN, "the name of the state is too long");
  PetscFunctionReturn(0);
}

/* 0, or 1 if one of the files cannot be read or written. */
static int copy(const char *from, const char *to) {
  char bytes[4096];
  size_t count;
  FILE *in = fopen(from, "rb"), *out = in ? fopen(to, "wb") : NULL;
  int failed = !out;
  while (!failed && (count = fread(bytes, 1, sizeof bytes, in)) > 0)
    failed = fwrite(bytes, 1, count, out) != count;
  failed = failed || ferror(in);
  if (in) fclose(in);
  if (out && fclose(out)) failed = 1;
  return failed;
}

PetscErrorCode state_file_write(const char *path, int rank, int adds, PetscViewer *viewer) {
  PetscFunctionBegin;
  char beside[4096];
  PetscCall(name_beside(path, beside, sizeof beside));
  const int failed = job_agree(rank == 0 && adds && copy(path, beside));
  PetscCheck(!failed, PETSC_COMM_WORLD, PETSC_ERR_FILE_WRITE, "%s: cannot be copied", path);
  PetscCall(open_file(beside, adds ? FILE_MODE_APPEND : FILE_MODE_WRITE, viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode state_file_finish(const char *path, int rank, PetscViewer *viewer) {
  PetscFunctionBegin;
  char beside[4096];
  PetscCall(name_beside(path, beside, sizeof beside));
  PetscCall(PetscViewerDestroy(viewer));
  const int failed = job_agree(rank == 0 && rename(beside, path));
  PetscCheck(!failed, PETSC_COMM_WORLD, PETSC_ERR_FILE_WRITE, "%s: cannot be written", path);
  PetscFunctionReturn(0);
}

PetscErrorCode state_file_has_more(PetscViewer viewer, int rank, int *more) {
  PetscFunctionBegin;
  int file;
  *more = 0;
  PetscCall(PetscViewerBinaryGetDescriptor(viewer, &file));
  if (rank == 0) {
    const off_t at = lseek(file, 0, SEEK_CUR), end = lseek(file, 0, SEEK_END);
    *more = at >= 0 && end > at && lseek(file, at, SEEK_SET) == at;
  }
  *more = job_agree(*more);
  PetscFunctionReturn(0);
}
