/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A coarse link spreads its exchange evenly over all leaves below it.  So the row sum K·1 of
   a leaf is off, although the row sum of the patch is exact.  Adding d(x)·B(x) on each leaf,
   with d = σ − K·1 and σ the leaf's exact row sum, makes rows exact.

   It keeps the operator symmetric, because d is on the diagonal, and makes it positive:
     Σ A B (I − K − D) B = Σ A (1−σ) B² + ½ Σ AF_ij (B_i − B_j)² ≥ 0.
   So the discrete equation has one solution wherever ρ < 1, for every ε.  Its matrix
   I − ρ(K + D) is an M-matrix with row sums 1 − ρσ, and so B ≥ 0. */
#include "solve/closure.h"

#include "base/alloc.h"

hr2d_status hr2di_closure_set(hr2di_transport *t, const hr2di_row_sums *rows) {
  const size_t field = t->leaves * t->bands;
  double *closure = hr2di_alloc(&t->alloc, t->leaves, sizeof *closure);
  double *one = hr2di_alloc(&t->alloc, field, sizeof *one);
  double *row = hr2di_alloc(&t->alloc, field, sizeof *row);
  const int room = closure && one && row;
  if (room) {
    for (size_t k = 0; k < field; k++) one[k] = 1;
    hr2di_transport_apply(t, one, row);
    for (size_t k = 0; k < t->leaves; k++)
      closure[k] = rows->front[t->leaf[k]] - row[k * t->bands];
    t->closure = closure;
  } else {
    hr2di_alloc_free(&t->alloc, closure);
  }
  hr2di_alloc_free(&t->alloc, one);
  hr2di_alloc_free(&t->alloc, row);
  return room ? HR2D_OK : HR2D_ENOMEM;
}
