/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the elements of a rank's hierarchy are among the units. */
#ifndef HR2D_PETSC_TREES_IMPL_H
#define HR2D_PETSC_TREES_IMPL_H

#include "trees.h"

#define HR2DPI_NONE UINT32_MAX

typedef struct hr2dpi_places {
  size_t elements;
  uint32_t *first;        /* per element: the first unit below, or its unit */
  unsigned char *level;   /* per element, at most cut + 1 */
  unsigned char *touched; /* per element: some link of this rank is there */
  uint32_t *base;         /* per unit: its root, or the leaf above the cut whose first unit it
                             is; else HR2DPI_NONE */
  unsigned levels;        /* the deepest one */
} hr2dpi_places;

/* Whether an element is above the cut, with children. */
static inline int hr2dpi_is_top(const hr2dp *p, const hr2dpi_places *at,
                                const hr2d_element *element, uint32_t e) {
  return at->level[e] < p->units.cut && element[e].child;
}

/* Sets `first` and `level` of all elements that there are now.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2dpi_places_find(hr2dp *p, hr2dpi_places *at);

/* exchange-shapes.c, collective: tells owners how their units are divided here and which
   elements links need; divides those of this rank alike, and makes the halo. */
PetscErrorCode hr2dpi_shapes_exchange(hr2dp *p, const hr2dpi_places *at);

#endif
