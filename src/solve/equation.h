/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discrete radiosity equation, with everything it takes: fields on leaves, Legendre
   coefficients × bands each. */
#ifndef HR2D_SRC_SOLVE_EQUATION_H
#define HR2D_SRC_SOLVE_EQUATION_H

#include <hr2d/solve.h>

#include "base/krylov.h"
#include "solve/energy-balance.h"
#include "solve/transport.h"

typedef struct hr2di_equation {
  hr2d_linkset *links;
  hr2d_solve_options options;
  hr2di_transport transport;
  hr2di_balance balance;
  int background;   /* light comes in from the surroundings */
  int *exponent;    /* per band: E, B and H are 2^exponent times what is held here */
  size_t items;     /* leaves × order */
  size_t field;     /* items × bands */
  double *space;    /* holds what follows */
  double *weight;   /* A of each item's leaf */
  double *source;   /* E at first */
  double *light;    /* per band: of the background */
  double *root_rho; /* √ρ */
  double *radiosity;
  double *irradiance; /* of `radiosity` */
  double *y, *b, *work;
  double *norm[2]; /* per band */
  uint64_t row_sums, kernels;
  double coefficients_seconds;
  uint64_t looks; /* at the residual: one before the first iteration, one after each */
} hr2di_equation;

/* Integrates blocks where links have none, and row sums where they are called for; HR2D_OK,
   HR2D_ENOMEM, or the status of the progress callback.  To be cleared in either case. */
hr2d_status hr2di_equation_init(hr2di_equation *eq, hr2d_linkset *links,
                                const hr2d_solve_options *options);
void hr2di_equation_clear(hr2di_equation *eq);

/* irradiance = K radiosity, and what comes from the background. */
void hr2di_equation_gather(hr2di_equation *eq, const double *radiosity);

/* Solves for radiosity and irradiance, from y as it is; leaves a message if it fails. */
hr2d_status hr2di_equation_solve(hr2di_equation *eq);

/* B = Q + √ρ y and its irradiance; all there is to do where nothing reflects.  HR2D_OK or
   HR2D_ENOMEM. */
hr2d_status hr2di_equation_take(hr2di_equation *eq);

/* Balances the source, so that y is that of h from then on; hr2di_equation_solve() does. */
void hr2di_equation_balance(hr2di_equation *eq);

/* out = Q + ρKB − B, with the digits that balance leaves of it; changes eq->work.  `out` may
   not be that, nor the irradiance, which it keeps. */
void hr2di_equation_defect(hr2di_equation *eq, const double *radiosity, double *out);

/* ‖Q + ρKB − B‖/‖B‖, the largest over the bands; changes y. */
double hr2di_equation_residual(hr2di_equation *eq);

#endif
