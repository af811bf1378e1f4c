/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums the shares of a row by their columns, and puts the columns in order. */
#ifndef HR2D_SRC_VISIBILITY_SPARSE_ACCUMULATOR_H
#define HR2D_SRC_VISIBILITY_SPARSE_ACCUMULATOR_H

#include "visibility/scatter.h"

/* Marks the column of a pair with a partial share. */
#define HR2DI_PARTIAL 0x80000000u

/* A set of columns in words of 64, with words that tell which words are not 0, and so on. */
enum { HR2DI_ROW_LEVELS = 6 };

typedef struct hr2di_sparse_accumulator {
  hr2d_allocator alloc;
  hr2di_watch *watch;
  double *sum;          /* per column of the scene */
  unsigned char *state; /* how many shares, up to 3, and whether one is partial */
  uint64_t *level[HR2DI_ROW_LEVELS];
  int levels;
  /* The row that was made last. */
  uint32_t *column;
  double *area;
  size_t count, room[2];
} hr2di_sparse_accumulator;

/* For scenes of n patches; HR2D_OK or HR2D_ENOMEM.  To be ended by
 * hr2di_sparse_accumulator_clear(). */
hr2d_status hr2di_sparse_accumulator_init(hr2di_sparse_accumulator *s, size_t n,
                                          const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_sparse_accumulator_clear(hr2di_sparse_accumulator *s);

/* Makes a row of the given shares, which it may reorder.  The sums do not depend on the order
   of the shares.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_sparse_accumulator_make(hr2di_sparse_accumulator *s,
                                          hr2di_contribution *share, size_t count);

#endif
