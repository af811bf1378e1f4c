/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The blocks of all links of a set, for elements of an order above 1. */
#ifndef HR2D_SRC_LINKS_LINK_BLOCKS_H
#define HR2D_SRC_LINKS_LINK_BLOCKS_H

#include <hr2d/linkset.h>
#include <hr2d/refine.h>

typedef struct hr2di_link_blocks {
  size_t order;
  uint64_t links;         /* the number of links when the blocks were made; 0: no blocks */
  double *value;          /* links × order × order */
  unsigned char *distant; /* per link: integrated by one rule, as accurate as the order needs */
  uint64_t kernels;       /* evaluations of G it took */
} hr2di_link_blocks;

/* Options of hr2di_link_blocks_init(). */
typedef struct hr2di_link_blocks_plan {
  unsigned threads; /* 0 for all; the result does not depend on it, bit for bit */
  hr2d_progress_fn progress;
  void *progress_ctx;
} hr2di_link_blocks_plan;

/* Makes new blocks for all links of a set.  Returns HR2D_OK, HR2D_ENOMEM, or the status of the
   progress callback.  On failure the set has no blocks. */
hr2d_status hr2di_link_blocks_init(hr2d_linkset *links, size_t order,
                                   const hr2di_link_blocks_plan *plan);

void hr2di_link_blocks_clear(hr2di_link_blocks *blocks, const hr2d_allocator *alloc);

#endif
