/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The blocks of all links of a set, for elements of an order above 1. */
#ifndef HR2D_SRC_LINKS_LINK_BLOCKS_H
#define HR2D_SRC_LINKS_LINK_BLOCKS_H

#include <hr2d/linkset.h>
#include <hr2d/refine.h>

typedef struct hr2di_link_blocks {
  size_t order;
  uint64_t links;         /* of the set when they were made; 0: there are none */
  double *value;          /* links × order × order */
  unsigned char *distant; /* per link: integrated by one rule, as good as the order asks */
  uint64_t kernels;       /* evaluations of G it took */
} hr2di_link_blocks;

/* How to make them. */
typedef struct hr2di_link_blocks_plan {
  unsigned threads; /* 0 for all; no bit depends on it */
  hr2d_progress_fn progress;
  void *progress_ctx;
} hr2di_link_blocks_plan;

/* Makes the blocks of a set's links anew; HR2D_OK, HR2D_ENOMEM, or the status of the progress
   callback.  On failure there are none. */
hr2d_status hr2di_link_blocks_init(hr2d_linkset *links, size_t order,
                                   const hr2di_link_blocks_plan *plan);

void hr2di_link_blocks_clear(hr2di_link_blocks *blocks, const hr2d_allocator *alloc);

#endif
