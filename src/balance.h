/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The balance of closed components, to digits that (I − ρK)⁻¹ would lose.

   Where nothing escapes, K1 = 1 and ∫KB = ∫B.  Write the irradiance as H = c + h and B = c + z.
   Then z = Q' + ρKz with the source Q' = Q − (1−ρ)c, in which 1−ρ is exact for ρ ≥ ½, and

     ∫(1−ρ)H = ∫Q   makes   c = ∫Q/∫(1−ρ)   and   ∫(1−ρ)h = 0.

   c carries what grows like 1/(1−ρ), and is good to a rounding; z does not grow, so that the
   roundings of Kz, times 1/(1−ρ), are roundings of c. */
#ifndef HR2D_SRC_BALANCE_H
#define HR2D_SRC_BALANCE_H

#include "sum.h"
#include "transport.h"

#define HR2DI_OPEN UINT32_MAX

typedef struct hr2di_balance {
  hr2d_allocator alloc;
  size_t count;        /* of closed components; 0: there is nothing to do */
  uint32_t *component; /* of each leaf, or HR2DI_OPEN */
  double *absorbance;  /* count × bands: ∫(1−ρ) */
  double *level;       /* count × bands: c */
  hr2di_sum *sum;      /* count × bands, work space */
} hr2di_balance;

/* Finds the closed components of a symmetric K with closure.  HR2D_OK or HR2D_ENOMEM; to be
   cleared in either case. */
hr2d_status hr2di_balance_make(hr2di_balance *b, hr2di_transport *t);
void hr2di_balance_clear(hr2di_balance *b);

/* Sets c to that of a source; to 0 where nothing absorbs. */
void hr2di_balance_set(hr2di_balance *b, const hr2di_transport *t, const double *source);

/* Changes c so that ∫(1−ρ)(c + h) is what ∫(1−ρ)c was. */
void hr2di_balance_correct(hr2di_balance *b, const hr2di_transport *t, const double *h);

/* Whether a leaf is of a closed component. */
static inline int hr2di_balance_holds(const hr2di_balance *b, size_t leaf) {
  return b->count > 0 && b->component[leaf] != HR2DI_OPEN;
}

/* c on a leaf; 0 outside the closed components. */
double hr2di_balance_at(const hr2di_balance *b, const hr2di_transport *t, size_t leaf,
                        size_t band);

/* field += factor·c, or factor·(1−ρ)·c. */
void hr2di_balance_add(const hr2di_balance *b, const hr2di_transport *t, double factor,
                       int absorbed, double *field);

#endif
