/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discrete radiosity equation on the own leaves of all ranks, as in the library's
   solve/equation.h: with B = Q + √ρ y it is (I − √ρ K √ρ) y = √ρ K Q, which is self-adjoint in
   Σ A x y.  In balanced components Q' = Q − (1−ρ)c and z stand for Q and B. */
#ifndef HR2D_PETSC_EQUATION_H
#define HR2D_PETSC_EQUATION_H

#include "balance.h"
#include "closure.h"
#include "krylov.h"

typedef struct hr2dpi_equation {
  hr2dp *p;
  hr2d_solve_options options;
  hr2dpi_exchange exchange;
  hr2dpi_transport transport;
  hr2dpi_balance balance;
  int background; /* light comes in from the surroundings */
  int *exponent;  /* per band: E, B and H are 2^exponent times the values held here */
  double *light;  /* per band: of the background */
  size_t leaves, field;
  double *space;  /* holds all arrays below */
  double *weight; /* per leaf: A */
  double *square; /* per leaf: A², where a solve takes the norm of powers; else NULL */
  double *source, *root_rho, *radiosity, *irradiance, *y, *b, *work;
  double *norm[2]; /* per band */
  uint64_t looks;
} hr2dpi_equation;

/* Collective; call hr2dpi_equation_clear() in any case. */
PetscErrorCode hr2dpi_equation_init(hr2dpi_equation *eq, hr2dp *p,
                                    const hr2d_solve_options *options);
void hr2dpi_equation_clear(hr2dpi_equation *eq);

/* Sets y from a start, B in its unit; 0 everywhere is none. */
PetscErrorCode hr2dpi_equation_start(hr2dpi_equation *eq, const double *radiosity);

/* Collective: solves for radiosity and irradiance, starting from y. */
PetscErrorCode hr2dpi_equation_solve(hr2dpi_equation *eq);

/* Collective: sets B = Q + √ρ y and its irradiance. */
PetscErrorCode hr2dpi_equation_take(hr2dpi_equation *eq);

/* Collective, power.c: adds what the residual, measured by power, still calls for. */
PetscErrorCode hr2dpi_equation_settle_power(hr2dpi_equation *eq);

/* Collective, power.c: the powers of all bands, in scene lengths. */
PetscErrorCode hr2dpi_equation_power(hr2dpi_equation *eq, hr2d_power *power);

/* Collective: refuses a B that is negative, as links that reflect too much light make it. */
PetscErrorCode hr2dpi_equation_check_sign(hr2dpi_equation *eq);

/* Collective: ‖Q + ρKB − B‖/‖B‖, the largest over the bands; changes y. */
PetscErrorCode hr2dpi_equation_residual(hr2dpi_equation *eq, double *residual);

/* y from the source and a radiosity in the unit held here; sets c. */
PetscErrorCode hr2dpi_equation_set_unknown(hr2dpi_equation *eq, const double *radiosity);

#endif
