/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches by the links of all ranks: how much each lacks of a whole row, and which exchange
   light with each other.  All ranks have the same. */
#ifndef HR2D_PETSC_EXCHANGE_H
#define HR2D_PETSC_EXCHANGE_H

#include "hr2dp-impl.h"

typedef struct hr2dpi_exchange {
  double *length;        /* per patch, in units of the scene */
  double *defect;        /* per patch: A − Σ AF over its links */
  uint32_t *component;   /* per patch: the first patch that it exchanges light with */
  uint32_t *number;      /* per patch: its component, numbered from 0 by their first patches */
  size_t count;          /* of components */
  unsigned char *closed; /* per patch: sees patches in every direction */
  unsigned char *linked; /* per patch: has links */
} hr2dpi_exchange;

/* Collective; call hr2dpi_exchange_clear() in any case. */
PetscErrorCode hr2dpi_exchange_find(hr2dpi_exchange *x, hr2dp *p);
void hr2dpi_exchange_clear(hr2dpi_exchange *x, const hr2dp *p);

/* Refuses light that neither is absorbed nor escapes, as hr2d_solve() does: HR2D_OK or
   HR2D_ENO_SOLUTION with a message, the same on all ranks. */
hr2d_status hr2dpi_exchange_check(const hr2dpi_exchange *x, hr2dp *p);

/* A defect of at most this part of a length is a rounding; light cannot escape by one of at
   most that part.  They are the bounds of hr2d_solve(). */
#define HR2DPI_CLOSED    1e-14
#define HR2DPI_NO_ESCAPE 1e-13

#endif
