/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the blocks of links that a set had before some of its elements were divided. */
#ifndef HR2D_SRC_LINKS_FORMER_BLOCKS_H
#define HR2D_SRC_LINKS_FORMER_BLOCKS_H

#include <hr2d/linkset.h>
#include <stdint.h>

#include "base/watch.h"

typedef struct hr2di_former_blocks {
  const hr2d_linkset *links; /* NULL: there are none */
  uint32_t *place;           /* 1 + the number of a link, by the hash of its pair; 0: none */
  uint64_t mask;
} hr2di_former_blocks;

/* Of links on elements that have the same numbers still; `links` may be NULL, or have no blocks
   of this order.  HR2D_OK, HR2D_ENOMEM or the status of the watch; to be cleared in any case.
 */
hr2d_status hr2di_former_blocks_init(hr2di_former_blocks *former, const hr2d_linkset *links,
                                     size_t order, const hr2d_allocator *alloc,
                                     hr2di_watch *watch);
void hr2di_former_blocks_clear(hr2di_former_blocks *former, const hr2d_allocator *alloc);

/* The block of a pair, or NULL; with it whether one rule made it. */
const double *hr2di_former_block(const hr2di_former_blocks *former, hr2d_pair pair,
                                 unsigned char *distant);

#endif
