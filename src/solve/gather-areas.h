/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gathers over exchange areas, at order 1. */
#ifndef HR2D_SRC_SOLVE_GATHER_AREAS_H
#define HR2D_SRC_SOLVE_GATHER_AREAS_H

#include <stddef.h>

#include "links/store.h"

/* down_i += A up_j over the links of a chunk, and down_j += A up_i unless they are directed.
   Terms are added in the order of the links, so that no bit depends on how they are kept. */
void hr2di_gather_areas(const hr2di_store *store, size_t chunk, size_t bands, int directed,
                        const double *up, double *down);

#endif
