/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact row sums of leaves: closure, and the form factor of the background. */
#ifndef HR2D_PETSC_CLOSURE_H
#define HR2D_PETSC_CLOSURE_H

#include "exchange.h"
#include "transport.h"

/* Collective: sets what the scene calls for; without `closure` only the background. */
PetscErrorCode hr2dpi_closure_set(hr2dpi_transport *t, const hr2dpi_exchange *x, int closure);

/* Where the mean of the closure over a patch is a rounding, H takes the place of B in d·B; as
   in the library's closure-mean.c. */
void hr2dpi_closure_move_mean(const hr2dpi_transport *t, const double *radiosity,
                              double *irradiance);

#endif
