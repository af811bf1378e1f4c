/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gathers over the blocks of links, one behind the other. */
#ifndef HR2D_SRC_SOLVE_GATHER_LINKS_H
#define HR2D_SRC_SOLVE_GATHER_LINKS_H

#include <hr2d/linkset.h>
#include <stddef.h>

#include "links/block-numbers.h"

typedef struct hr2di_link_run {
  const hr2d_link *link;
  hr2di_stored_block block; /* of the first link; those of the others are behind it */
  size_t count;
  int directed; /* the second element of a link does not receive */
} hr2di_link_run;

/* down_i += C up_j and down_j += Cᵀ up_i over the links of a run, whose blocks are of this
   order. */
void hr2di_gather_links(const hr2di_link_run *run, size_t order, size_t bands, const double *up,
                        double *down);

#endif
