/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The union of the trees of all ranks: each owner has its units as all ranks together have
   divided them. */
#ifndef HR2D_PETSC_TREES_H
#define HR2D_PETSC_TREES_H

#include "hr2dp-impl.h"

/* Collective: unites trees, chooses owners of units if there are none, and makes the halo. Sets
   the counts of elements. */
PetscErrorCode hr2dpi_trees_unite(hr2dp *p);
PetscErrorCode hr2dpi_trees_clear(hr2dp *p);

#endif
