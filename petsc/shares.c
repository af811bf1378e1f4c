/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shares of a solve over the ranks of a communicator: statuses are compared first, so that no
   rank waits for the values of one that has failed. */
#include <limits.h>
#include <stdlib.h>

#include "hr2dp-impl.h"

typedef struct ranked {
  hr2d_share share; /* the first member, for its owner */
  MPI_Comm comm;
} ranked;

/* The status of the lowest rank that has one. */
static hr2d_status agree(const ranked *r, hr2d_status status) {
  int first = status ? (int)r->share.number : INT_MAX, code = (int)status;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, r->comm);
  if (first == INT_MAX) return HR2D_OK;
  MPI_Bcast(&code, 1, MPI_INT, first, r->comm);
  return (hr2d_status)code;
}

/* In pieces, as MPI counts in int.  Sums are exact in any order of their terms. */
static hr2d_status combine(void *ctx, hr2d_status status, hr2d_combine how, double *value,
                           size_t count) {
  const size_t piece = 1 << 27;
  const ranked *r = ctx;
  const hr2d_status found = agree(r, status);
  for (size_t at = 0; at < count && !found; at += piece)
    MPI_Allreduce(MPI_IN_PLACE, value + at, (int)(count - at < piece ? count - at : piece),
                  MPI_DOUBLE, how == HR2D_COMBINE_SUM ? MPI_SUM : MPI_MAX, r->comm);
  return found;
}

PetscErrorCode hr2dp_share_create(MPI_Comm comm, hr2d_share **share) {
  PetscFunctionBegin;
  int rank, ranks, failed;
  ranked *made = malloc(sizeof *made);
  *share = NULL;
  failed = !made;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, comm));
  if (failed) free(made);
  PetscCheck(!failed, comm, PETSC_ERR_MEM, "out of memory");
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  PetscCallMPI(MPI_Comm_dup(comm, &made->comm));
  made->share =
      (hr2d_share){sizeof made->share, (unsigned)rank, (unsigned)ranks, combine, made, HR2D_OK};
  *share = &made->share;
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_share_destroy(hr2d_share **share) {
  PetscFunctionBegin;
  ranked *r = *share ? (*share)->ctx : NULL;
  *share = NULL;
  if (!r) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_free(&r->comm));
  free(r);
  PetscFunctionReturn(0);
}
