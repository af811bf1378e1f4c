/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy balance of components from which little escapes: the library's
   solve/energy-balance.h with sums over all ranks.  With B = c + z and H = c + h,

     h = Kz + S − mc,   z = Q − (1−ρ)c + ρh,   c = (∫Q + ∫S)/(∫(1−ρ) + ∫m),   m = 1 − K1:

   c grows like 1/(∫(1−ρ) + ∫m), and is as accurate as this denominator; z does not grow. */
#ifndef HR2D_PETSC_BALANCE_H
#define HR2D_PETSC_BALANCE_H

#include "exchange.h"
#include "transport.h"

#define HR2DPI_OPEN UINT32_MAX

typedef struct hr2dpi_balance {
  const hr2dpi_transport *t;
  size_t count;        /* balanced components; 0: there is nothing to do */
  uint32_t *component; /* per own leaf, or HR2DPI_OPEN */
  double *missing;     /* per own leaf: m; 0 where a component is closed, or not balanced */
  double *escape;      /* per component: ∫m; 0 for a closed one */
  double *loss;        /* count × bands: ∫(1−ρ) + ∫m */
  double *response;    /* count × bands: ∫(1−ρ) + ∫ρm */
  double *level;       /* count × bands: c */
  hr2dpi_sum *sum;     /* count × bands, work space */
} hr2dpi_balance;

/* Collective; call hr2dpi_balance_clear() in any case. */
PetscErrorCode hr2dpi_balance_init(hr2dpi_balance *b, hr2dpi_transport *t,
                                   const hr2dpi_exchange *x);
void hr2dpi_balance_clear(hr2dpi_balance *b);

/* Collective: sets c from a source on leaves and the light of the background per band, or
   NULL. */
PetscErrorCode hr2dpi_balance_set(hr2dpi_balance *b, const double *source,
                                  const double *background);

/* Collective: corrects c by what ∫(1−ρ)h + ∫mz is off 0. */
PetscErrorCode hr2dpi_balance_correct(hr2dpi_balance *b, const double *source, const double *h);

static inline int hr2dpi_balance_holds(const hr2dpi_balance *b, size_t leaf) {
  return b->count > 0 && b->component[leaf] != HR2DPI_OPEN;
}

/* c on a leaf; 0 outside the components. */
static inline double hr2dpi_balance_at(const hr2dpi_balance *b, size_t leaf, size_t band) {
  return hr2dpi_balance_holds(b, leaf) ? b->level[b->component[leaf] * b->t->p->bands + band]
                                       : 0;
}

#endif
