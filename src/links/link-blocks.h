/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The blocks of all links of a set, for elements of an order above 1. */
#ifndef HR2D_SRC_LINKS_LINK_BLOCKS_H
#define HR2D_SRC_LINKS_LINK_BLOCKS_H

#include <hr2d/linkset.h>
#include <hr2d/refine.h>

#include "base/watch.h"
#include "links/block-numbers.h"

typedef struct hr2di_link_blocks {
  size_t order;
  uint64_t links;         /* so many links, the first ones, have blocks */
  int single;             /* numbers are floats, see block-numbers.h */
  void *value;            /* links × order × order numbers */
  unsigned char *distant; /* per link: integrated by one rule, as accurate as the order needs */
  uint64_t kernels;       /* evaluations of G it took */
} hr2di_link_blocks;

/* The bytes of a block, and block k. */
static inline size_t hr2di_link_blocks_stride(const hr2di_link_blocks *b) {
  return b->order * b->order * hr2di_number_size(b->single);
}

static inline void *hr2di_link_blocks_at(const hr2di_link_blocks *b, uint64_t k) {
  return (char *)b->value + k * hr2di_link_blocks_stride(b);
}

/* Whether all links of a set have blocks of this order, of floats or doubles as links->single
   says. */
int hr2di_link_blocks_made(const hr2d_linkset *links, size_t order);

/* Makes such blocks for all links of a set that have none, on as many threads as options ask
   for; no bit depends on their number.  Returns HR2D_OK, HR2D_ENOMEM, or the status of the
   watch.  On failure the set has no blocks. */
hr2d_status hr2di_link_blocks_init(hr2d_linkset *links, size_t order, unsigned threads,
                                   hr2di_watch *watch);

/* Keeps the first coefficients of all blocks alone.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_link_blocks_trim(hr2di_link_blocks *blocks, size_t order,
                                   const hr2d_allocator *alloc);

void hr2di_link_blocks_clear(hr2di_link_blocks *blocks, const hr2d_allocator *alloc);

#endif
