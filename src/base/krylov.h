/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Krylov methods for (I − S) y = b, all bands at once. */
#ifndef HR2D_SRC_BASE_KRYLOV_H
#define HR2D_SRC_BASE_KRYLOV_H

#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stdint.h>

#include "base/watch.h"

typedef struct hr2di_krylov_system {
  const hr2d_allocator *alloc;
  size_t size, bands;   /* fields are size × bands */
  const double *weight; /* of the inner product, per item: Σ weight x y */
  int symmetric;        /* S is self-adjoint in this product */

  /* out = S in */
  void (*apply)(void *ctx, const double *in, double *out);
  /* Writes the norms, per band, with which the residuals of y are compared. */
  void (*scale)(void *ctx, const double *y, double *norm);
  /* Whether the residual r of the y that scale() was called for is small enough for other
     reasons than its norm; NULL: it never is. */
  int (*enough)(void *ctx, const double *r);
  /* Called at the start and after each iteration with the largest relative residual; any status
     but HR2D_OK ends the iteration. */
  hr2d_status (*report)(void *ctx, double residual);
  void *ctx;
  hr2di_watch *watch;

  double tolerance;
  unsigned max_iterations;
} hr2di_krylov_system;

/* Improves y until ‖b − (I − S) y‖ ≤ tolerance·scale in every band, or it is enough.  *residual
   becomes the last residual relative to the scale, the largest over the bands.  Returns
   HR2D_OK, HR2D_ENOMEM, HR2D_ENOT_CONVERGED or the status of `report`.  HR2D_ENOT_CONVERGED is
   also returned if a symmetric I − S turns out not to be positive definite. */
hr2d_status hr2di_krylov(const hr2di_krylov_system *system, const double *b, double *y,
                         double *residual);

/* Weighted inner product of two fields, per band. */
void hr2di_krylov_dot(const hr2di_krylov_system *system, const double *u, const double *v,
                      double *product);

#endif
