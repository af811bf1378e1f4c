/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The first rows and columns of many blocks, one behind the other.  A gather with coefficients
   of a lower order reads just these: between the others they take as much time as all. */
#ifndef HR2D_SRC_SOLVE_LEADING_BLOCKS_H
#define HR2D_SRC_SOLVE_LEADING_BLOCKS_H

#include <hr2d/memory.h>

#include "base/watch.h"

/* Sets *to, which the caller frees, to the first `order` rows and columns of each of `count`
   blocks of the order `all`, of numbers of `number` bytes.  HR2D_OK, HR2D_ENOMEM or the status
   of the watch; *to may be set in any case. */
hr2d_status hr2di_leading_blocks(void **to, const void *from, size_t number, uint64_t count,
                                 size_t all, size_t order, const hr2d_allocator *alloc,
                                 unsigned threads, hr2di_watch *watch);

#endif
