/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The temperatures of patches of given flux in several bands, on the links of one solve.

   The unknowns are S_k = σT_k⁴ of the patches k of given flux.  With a = 1 − ρ, the part f of
   the black body, and H̄ the average irradiance of a patch, which the radiosity equation gives
   for the emissions E_kb = a_kb f_b(T_k) S_k, the heat balance is

     g_k(S) = Σ_b (E_kb − a_kb H̄_kb) − q_k = 0.

   E_kb rises with S_k, and every H̄ with every E.  So g is off-diagonally antitone; and as no
   more than all that is emitted can arrive, Σ A_k g_k rises with each S_j, strictly unless what
   j emits comes back to these patches in full.  Such a g is an M-function (Rheinboldt 1970):
   it has one zero, and g(S) ≤ g(S') implies S ≤ S'.  J = ∂g/∂S is an M-matrix, J⁻¹ ≥ 0.

   Newton's step J δ = −g has J = D − C, D_k = Σ_b E'_kb.  C v are averages of one linear solve
   with the emissions E' v, and D⁻¹C has a spectral radius below 1: BiCGSTAB takes few solves.
   A step is one of what patches emit in all bands, Σ_b E_kb: then only their spectra are not
   linear.  It is halved while |g| does not fall.

   A shield is one unknown of two patches: its S is that of both sides, and g is the sum of
   theirs.  The theorem holds as for one patch that stands in both rooms.

   Where ε depends on T, ρ does as well, and E' has a part of it.  If ε falls with T the theorem
   need not hold: errors are then those of a linear problem near the T that is found. */
#ifndef HR2D_SRC_SOLVE_HEAT_BALANCE_H
#define HR2D_SRC_SOLVE_HEAT_BALANCE_H

#include "scene/frozen-temperatures.h"
#include "solve/equation.h"

#define HR2DI_NO_BACK SIZE_MAX

typedef struct hr2di_heat_balance {
  hr2d_scene *scene; /* of frozen temperatures */
  hr2di_equation eq;
  size_t count;     /* unknowns: patches of given flux that heat reaches, and shields */
  size_t sides;     /* the patches of these: one of each, and then the backs of shields */
  size_t *patch;    /* per side: its index, */
  size_t *of;       /* and its unknown */
  size_t *back;     /* per unknown: the side that is the back of a shield, or HR2DI_NO_BACK */
  double *space;    /* holds all arrays below, of `count` values unless said otherwise */
  double *radiance; /* S */
  double *defect;   /* g */
  double *size;     /* of its terms */
  double *slope;    /* D */
  double *length;   /* A */
  double *step, *gain, *old, *right;
  double *emission; /* sides × bands */
  double *rise;     /* likewise: ∂E/∂S */
  double *average;  /* patches × bands: of B or of H, after a solve */
  double worst;     /* the largest |g|/size */
  double power;     /* ΣA|g| */
  unsigned solves;
  int depends;        /* the ε of some patch depends on T */
  hr2d_status failed; /* of a solve within a Krylov step */
} hr2di_heat_balance;

/* The sides of an unknown, from `side` = 0 on; HR2DI_NO_BACK behind the last one. */
static inline size_t hr2di_heat_side(const hr2di_heat_balance *h, size_t unknown, int side) {
  return side == 0 ? unknown : side == 1 ? h->back[unknown] : HR2DI_NO_BACK;
}

/* Sets up the balance on links of the scene or of its origin; `start` of the options does not
   matter.  Call hr2di_heat_balance_clear() in any
   case; the struct must not be moved. */
hr2d_status hr2di_heat_balance_init(hr2di_heat_balance *balance, hr2d_scene *frozen,
                                    hr2d_linkset *links, const hr2d_solve_options *options);
void hr2di_heat_balance_clear(hr2di_heat_balance *balance);

/* Finds S, from that of the scene on; the scene has it then, with E.  HR2D_OK,
   HR2D_ENOT_CONVERGED, HR2D_ENOMEM or the status of the progress callback, with a message of
   the links. */
hr2d_status hr2di_heat_balance_settle(hr2di_heat_balance *balance);

/* Gives the equation the E of the scene of frozen temperatures, for a solve with these options.
 */
hr2d_status hr2di_heat_balance_source(hr2di_heat_balance *balance,
                                      const hr2d_solve_options *options);

/* radiance = J⁻¹ off: how far S is off if the averages of the balance are. Both have `count`
   values; `off` ≥ 0. */
hr2d_status hr2di_heat_balance_spread(hr2di_heat_balance *balance, const double *off,
                                      double *radiance);

/* The averages over all patches, per band, of the B and H that changes of S alone make. */
hr2d_status hr2di_heat_balance_respond(hr2di_heat_balance *balance, const double *radiance,
                                       double *radiosity, double *irradiance);

#endif
