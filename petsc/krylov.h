/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Krylov methods for (I − S) y = b over all ranks, all bands at once, with the scalars of each
   band.  KSP has one scalar for all, and its inner products depend on the ranks. */
#ifndef HR2D_PETSC_KRYLOV_H
#define HR2D_PETSC_KRYLOV_H

#include "hr2dp-impl.h"

typedef struct hr2dpi_krylov_system {
  hr2dp *p;
  size_t size;          /* own items; fields are size × bands */
  const double *weight; /* of the inner product, per item */
  int symmetric;        /* S is self-adjoint in it */

  /* Collective: out = S in. */
  PetscErrorCode (*apply)(void *ctx, const double *in, double *out);
  /* Collective: the norms, per band, with which residuals of y are compared. */
  PetscErrorCode (*scale)(void *ctx, const double *y, double *norm);
  /* Collective: called at the start and after each iteration. */
  PetscErrorCode (*report)(void *ctx, double residual);
  void *ctx;

  double tolerance;
  unsigned max_iterations;
} hr2dpi_krylov_system;

/* Collective: improves y until ‖b − (I − S) y‖ ≤ tolerance·scale in every band.  *found becomes
   HR2D_OK or HR2D_ENOT_CONVERGED, the same on all ranks. */
PetscErrorCode hr2dpi_krylov(const hr2dpi_krylov_system *system, const double *b, double *y,
                             double *residual, hr2d_status *found);

/* Collective: inner products of two fields, per band, exact but for the rounding of each term
   and of the sum. */
PetscErrorCode hr2dpi_krylov_dot(const hr2dpi_krylov_system *system, const double *u,
                                 const double *v, double *product);

#endif
