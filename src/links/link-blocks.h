/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The blocks of all links of a set, for elements of an order above 1. */
#ifndef HR2D_SRC_LINKS_LINK_BLOCKS_H
#define HR2D_SRC_LINKS_LINK_BLOCKS_H

#include <hr2d/linkset.h>
#include <hr2d/refine.h>

#include "base/watch.h"

typedef struct hr2di_link_blocks {
  size_t order;
  uint64_t links;         /* so many links, the first ones, have blocks */
  double *value;          /* links × order × order */
  unsigned char *distant; /* per link: integrated by one rule, as accurate as the order needs */
  uint64_t kernels;       /* evaluations of G it took */
} hr2di_link_blocks;

/* Makes blocks for all links of a set that have none of this order, on as many threads as
   options ask for; no bit depends on their number.  Returns HR2D_OK, HR2D_ENOMEM, or the status
   of the watch.  On failure the set has no blocks. */
hr2d_status hr2di_link_blocks_init(hr2d_linkset *links, size_t order, unsigned threads,
                                   hr2di_watch *watch);

/* Keeps the first coefficients of all blocks alone.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_link_blocks_trim(hr2di_link_blocks *blocks, size_t order,
                                   const hr2d_allocator *alloc);

void hr2di_link_blocks_clear(hr2di_link_blocks *blocks, const hr2d_allocator *alloc);

#endif
