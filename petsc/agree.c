/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Agreement of all ranks on status and numbers before they go on together. */
#include <stdarg.h>
#include <stdio.h>

#include "hr2dp-impl.h"

hr2d_status hr2dpi_fail(hr2dp *p, hr2d_status status, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vsnprintf(p->message, sizeof p->message, format, args);
  va_end(args);
  return status;
}

PetscErrorCode hr2dpi_agree(hr2dp *p, hr2d_status status) {
  PetscFunctionBegin;
  int first = status ? p->rank : p->ranks, kind = (int)status;
  if (status && !p->message[0])
    snprintf(p->message, sizeof p->message, "%s", hr2d_strerror(status));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, p->comm));
  if (first == p->ranks) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Bcast(&kind, 1, MPI_INT, first, p->comm));
  PetscCallMPI(MPI_Bcast(p->message, sizeof p->message, MPI_CHAR, first, p->comm));
  p->status = (hr2d_status)kind;
  SETERRQ(p->comm, PETSC_ERR_LIB, "rank %d: %s", first, p->message);
}

PetscErrorCode hr2dpi_sum_all(hr2dp *p, hr2dpi_sum *sum, size_t count) {
  PetscFunctionBegin;
  for (size_t k = 0; k < count; k++) hr2dpi_sum_carry(&sum[k]);
  for (size_t k = 0; k < count; k += 1 << 16) {
    const int some = (int)(count - k < 1 << 16 ? count - k : 1 << 16);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum + k, some * HR2DPI_DIGITS, MPI_INT64_T,
                               MPI_SUM, p->comm));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_add_counts(hr2dp *p, uint64_t *count, int size) {
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, size, MPI_UINT64_T, MPI_SUM, p->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_max_counts(hr2dp *p, uint64_t *count, int size) {
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, size, MPI_UINT64_T, MPI_MAX, p->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_max_doubles(hr2dp *p, double *value, int size) {
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, value, size, MPI_DOUBLE, MPI_MAX, p->comm));
  PetscFunctionReturn(0);
}
