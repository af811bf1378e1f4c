/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units: patches, or the elements on one level of each patch, in the order of patches and of
   positions. */
#ifndef HR2D_PETSC_UNITS_H
#define HR2D_PETSC_UNITS_H

#include "hr2dp-impl.h"

/* Chooses the cut and shares out units evenly.  HR2D_OK or HR2D_ENOMEM; not collective. */
hr2d_status hr2dpi_units_init(hr2dp *p);
void hr2dpi_units_clear(hr2dp *p);

/* Shares out units so that each rank has about the same weight. */
void hr2dpi_ranges_cut(const hr2dp *p, const double *weight, hr2dpi_ranges *ranges);

/* The rank that owns a unit. */
int hr2dpi_ranges_owner(const hr2dp *p, const hr2dpi_ranges *ranges, uint64_t unit);

/* The first unit below an element, and how many there are: 1 below the cut. */
uint64_t hr2dpi_unit_of(const hr2dp *p, const hr2d_element *elements, uint32_t element,
                        uint64_t *count);

/* Pairs whose first element is above units [from, to); with `above`, of these only the pairs
   whose first element is above the cut. */
typedef struct hr2dpi_claim {
  const hr2dp *p;
  uint64_t from, to;
  int above;
} hr2dpi_claim;

/* An hr2d_claim_fn. */
hr2d_status hr2dpi_claim_pairs(void *ctx, const hr2d_batch *batch, unsigned char *claimed);

#endif
