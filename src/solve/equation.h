/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discrete radiosity equation.  Its fields have order × bands Legendre coefficients on each
   leaf. */
#ifndef HR2D_SRC_SOLVE_EQUATION_H
#define HR2D_SRC_SOLVE_EQUATION_H

#include <hr2d/solve.h>

#include "base/krylov.h"
#include "solve/energy-balance.h"
#include "solve/scattering.h"
#include "solve/transport.h"
#include "visibility/beam-cache.h"

/* When a solve may end before its residual has the tolerance: see stopping-test.c. */
typedef struct hr2di_stopping_test {
  double part;          /* that the residual may have; 0: the tolerance alone counts */
  double floor;         /* without weights: no leaf counts as less bright, relative to the
                           brightest */
  const double *weight; /* leaves × bands: of values that are solved for; NULL: each leaf is
                           compared with what it reflects */
  int summed;           /* sums over all leaves are compared, not the largest values */
} hr2di_stopping_test;

typedef struct hr2di_equation {
  hr2d_linkset *links;
  hr2d_solve_options options;
  hr2di_watch watch; /* asks the callback of the options, or that of the scene */
  hr2di_transport transport;
  hr2di_balance balance;
  int background;         /* light comes in from the surroundings */
  double *outside;        /* a field: the irradiance that this light makes; NULL for none */
  int *exponent;          /* per band: E, B and H are 2^exponent times the values held here */
  size_t items;           /* leaves × order */
  size_t field;           /* items × bands */
  double *space;          /* holds all arrays below */
  double *weight;         /* A of each item's leaf */
  double *square;         /* A² where a solve takes the norm of powers, else NULL */
  double *source;         /* E at first */
  double *light;          /* per band: of the background */
  double *root_rho;       /* √ρ; 1 on panes */
  hr2di_scattering panes; /* has what leaves of panes do */
  double *radiosity;
  double *irradiance; /* of `radiosity` */
  double *y, *b, *work;
  double *norm[2]; /* per band */
  hr2di_stopping_test enough;
  uint64_t row_sums, kernels;
  double coefficients_seconds;
  uint64_t residuals; /* residuals seen: one before the first iteration, one after each */
} hr2di_equation;

/* What no public option says of an equation. */
typedef struct hr2di_equation_how {
  size_t order;                 /* coefficients on each leaf; 0: those of the hierarchy */
  size_t block_order;           /* links get blocks for so many, if these are more */
  int single;                   /* blocks that are made are of floats */
  const hr2di_roots *roots;     /* whose clusters exchange light, as long as the equation lives;
                                   NULL: those of the links */
  hr2di_beam_cache *beam_cache; /* keeps what patches see; NULL: nothing is kept */
  hr2di_stopping_test enough;
  const hr2d_solution *start; /* a solve begins with it if it is given no other start: of
                                 elements of which these are a copy, some divided; NULL: none */
} hr2di_equation_how;

/* As hr2d_solve() has it: blocks stay of floats if they are. */
hr2di_equation_how hr2di_equation_how_of(const hr2d_linkset *links);

/* For E and ρ of a scene: that of the links, or one of frozen temperatures of it, see
   frozen-temperatures.h.  Integrates blocks if the links have none, and row sums if they are
   called for.  Returns HR2D_OK, HR2D_ENOMEM, or the status of the progress callback.  Call
   hr2di_equation_clear() in any case.  The struct must not be moved. */
hr2d_status hr2di_equation_init(hr2di_equation *eq, hr2d_linkset *links,
                                const hr2d_scene *scene, const hr2di_equation_how *how,
                                const hr2d_solve_options *options);
void hr2di_equation_clear(hr2di_equation *eq);

/* Takes √ρ of the scene where it has changed.  Returns HR2D_OK or the status of the watch. */
hr2d_status hr2di_equation_set_surfaces(hr2di_equation *eq);

/* Takes E, √ρ and the light from outside of the scene, once the scene has changed them; what
   was found for the former ones is forgotten.  Returns HR2D_OK, HR2D_ENOMEM or the status of
   the watch. */
hr2d_status hr2di_equation_set_light(hr2di_equation *eq);

/* Makes the fields of an equation that has its transport, all 0 but weights.  Returns HR2D_OK
   or HR2D_ENOMEM. */
hr2d_status hr2di_equation_reserve(hr2di_equation *eq);

/* field = ρ field, and on panes S field: the light that leaves the leaves on which it falls. */
void hr2di_equation_scatter(const hr2di_equation *eq, double *field);

/* y on panes, of B and with the balance set: the part of B = Q + Sc + Ly that has an inverse.
 */
void hr2di_equation_set_panes_unknown(hr2di_equation *eq, const double *radiosity);

/* eq->irradiance = K radiosity + the irradiance from the background. */
void hr2di_equation_gather(hr2di_equation *eq, const double *radiosity);

/* Solves for radiosity and irradiance, starting from y.  Returns HR2D_OK, HR2D_ENOMEM,
   HR2D_ENOT_CONVERGED or the status of the progress callback; the last two leave a message. */
hr2d_status hr2di_equation_solve(hr2di_equation *eq);

/* Whether a residual r of y is small enough for eq->enough, with the B of y in eq->radiosity.
 */
int hr2di_equation_is_enough(const hr2di_equation *eq, const double *r);

/* Sets B = Q + √ρ y and its irradiance; this is the whole solve where nothing reflects.
   Returns HR2D_OK, HR2D_ENOMEM or the status of the progress callback. */
hr2d_status hr2di_equation_take(hr2di_equation *eq);

/* Adds to a solution what its residual, measured by power, still calls for.  Returns HR2D_OK,
   HR2D_ENOMEM, HR2D_ENOT_CONVERGED with a message or the status of the progress callback. */
hr2d_status hr2di_equation_settle_power(hr2di_equation *eq);

/* If B = Q + ρKB and neither K nor Q is negative, B is negative nowhere.  Returns HR2D_OK,
   HR2D_ENOT_CONVERGED or HR2D_ENO_SOLUTION with a message, or the status of the watch. */
hr2d_status hr2di_equation_check_sign(hr2di_equation *eq);

/* Sets c from the source, so that y = √ρ h from then on; hr2di_equation_solve() does it. */
void hr2di_equation_balance(hr2di_equation *eq);

/* out = Q + ρKB − B, with the digits that the energy balance keeps; changes eq->work.  `out`
   must be neither eq->work nor eq->irradiance; the latter is unchanged. */
void hr2di_equation_defect(hr2di_equation *eq, const double *radiosity, double *out);

/* ‖Q + ρKB − B‖/‖B‖, the largest over the bands; changes y. */
double hr2di_equation_residual(hr2di_equation *eq);

#endif
