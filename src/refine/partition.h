/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts accepted pairs from refused ones. */
#ifndef HR2D_SRC_REFINE_PARTITION_H
#define HR2D_SRC_REFINE_PARTITION_H

#include <hr2d/oracle.h>
#include <stddef.h>

/* Writes the pairs whose flag is not 0 to `yes` and the others to `no`, in their order.  Both
   have room for `count` pairs, and what is behind those written is lost.  Returns the number
   of pairs in `yes`. */
size_t hr2di_partition(const hr2d_pair *pairs, const unsigned char *flag, size_t count,
                       hr2d_pair *yes, hr2d_pair *no);

#endif
