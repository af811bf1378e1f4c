/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gathers over the blocks of links, one behind the other. */
#ifndef HR2D_SRC_SOLVE_GATHER_LINKS_H
#define HR2D_SRC_SOLVE_GATHER_LINKS_H

#include <hr2d/linkset.h>
#include <stddef.h>

typedef struct hr2di_link_run {
  const hr2d_link *link;
  const void *block; /* of the first link; that of the next is stride² numbers behind it */
  int single;        /* which are floats, see block-numbers.h */
  size_t stride;
  size_t count;
  int directed; /* the second element of a link does not receive */
} hr2di_link_run;

/* down_i += C up_j and down_j += Cᵀ up_i over the links of a run, with the first coefficients
   of their blocks. */
void hr2di_gather_links(const hr2di_link_run *run, size_t order, size_t bands, const double *up,
                        double *down);

#endif
