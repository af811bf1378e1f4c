/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy balance of components from which little escapes, with the digits that (I − ρK)⁻¹
   would lose.

   With m = 1 − K1, which is 0 where a component is closed, write B = c + z and H = c + h.  Then
     h = Kz + S − mc,   z = Q − (1−ρ)c + ρh
   for a source Q and irradiance S from outside of the scene.  As K is symmetric, the power that
   is absorbed and the power that escapes add up to the power that comes in, ∫(1−ρ)H + ∫mB = ∫Q
   + ∫S,   and   c = (∫Q + ∫S)/(∫(1−ρ) + ∫m)   makes   ∫(1−ρ)h + ∫mz = 0. c is the part that
   grows like 1/(∫(1−ρ) + ∫m), and it is as accurate as this denominator; 1−ρ is exact for ρ ≥
   ½.  z does not grow, so the roundings of Kz become roundings of c.  On panes S stands for ρ,
   see scattering.h, and 1 − ρ − τ for 1 − ρ: c is the same on both sides. */
#ifndef HR2D_SRC_SOLVE_ENERGY_BALANCE_H
#define HR2D_SRC_SOLVE_ENERGY_BALANCE_H

#include "base/neumaier-sum.h"
#include "solve/transport.h"

#define HR2DI_OPEN UINT32_MAX

typedef struct hr2di_balance {
  hr2d_allocator alloc;
  size_t count;         /* the number of balanced components; 0: there is nothing to do */
  uint32_t *component;  /* of each leaf, or HR2DI_OPEN */
  double *missing;      /* m: leaves × order; 0 on leaves that are closed or not balanced */
  double *length;       /* of each component */
  double *escape;       /* ∫m of each component; 0 for a closed one */
  double *loss;         /* count × bands: ∫(1−ρ) + ∫m */
  double *response;     /* count × bands: ∫(1−ρ) + ∫ρm */
  double *level;        /* count × bands: c */
  hr2di_sum *sum;       /* count × bands, work space */
  unsigned char *sends; /* count × bands: some leaf emits, or reflects what comes in; where none
                           does B is 0, to the last bit, and so is c */
} hr2di_balance;

/* Finds the components of a symmetric K with closure.  Returns HR2D_OK, HR2D_ENOMEM or the
   status of the watch.  Call hr2di_balance_clear() in any case. */
hr2d_status hr2di_balance_init(hr2di_balance *b, hr2di_transport *t);

/* Takes ρ of the scene, for a start or when it has changed. */
void hr2di_balance_set_losses(hr2di_balance *b, const hr2di_transport *t);
void hr2di_balance_clear(hr2di_balance *b);

/* Sets c from a source and the irradiance from outside of the scene, or NULL; c is 0 where
   nothing is lost, and where nothing is sent. */
void hr2di_balance_set(hr2di_balance *b, const hr2di_transport *t, const double *source,
                       const double *outside);

/* Corrects c by the amount that ∫(1−ρ)h + ∫mz is off 0, for h = Kz + S − mc and
   z = Q − (1−ρ)c + ρh. */
void hr2di_balance_correct(hr2di_balance *b, const hr2di_transport *t, const double *source,
                           const double *h);

/* Whether a leaf belongs to a balanced component, and to a closed one. */
static inline int hr2di_balance_holds(const hr2di_balance *b, size_t leaf) {
  return b->count > 0 && b->component[leaf] != HR2DI_OPEN;
}

static inline int hr2di_balance_closed(const hr2di_balance *b, size_t leaf) {
  return hr2di_balance_holds(b, leaf) && !(b->escape[b->component[leaf]] > 0);
}

/* c on a leaf; 0 outside the components. */
double hr2di_balance_at(const hr2di_balance *b, const hr2di_transport *t, size_t leaf,
                        size_t band);

/* field += c; field −= (1−ρ)c; field −= mc. */
void hr2di_balance_add(const hr2di_balance *b, const hr2di_transport *t, double *field);
void hr2di_balance_absorb(const hr2di_balance *b, const hr2di_transport *t, double *field);
void hr2di_balance_release(const hr2di_balance *b, const hr2di_transport *t, double *field);

/* The relative error of c that a rounding of ∫m may cause, the largest over components and
   bands. */
double hr2di_balance_doubt(const hr2di_balance *b, const hr2di_transport *t);

#endif
