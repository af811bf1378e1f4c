/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What shares of a solve exchange, and how they agree that one has failed.

   A share that fails leaves its call, and says so at the first agreement on its way out.  The
   others learn it where they combine next, and leave, too: on their way they do not say it
   again.  `share` may be NULL everywhere: nothing is shared then. */
#ifndef HR2D_SRC_BASE_SHARE_H
#define HR2D_SRC_BASE_SHARE_H

#include <hr2d/memory.h>
#include <hr2d/share.h>

/* HR2D_EINVAL if a share that a caller gives is none: its size, number or count is wrong, or
   `combine` is missing. */
hr2d_status hr2di_share_check(const hr2d_share *share);

/* Whether a row of pairs, of so many, is of this share.  Rows are dealt out in runs. */
int hr2di_share_has_row(const hr2d_share *share, size_t row, size_t rows);

/* Where the part of a share begins, of so many things that are dealt out in runs. */
static inline size_t hr2di_share_part(size_t things, unsigned number, unsigned count) {
  return things / count * number + things % count * number / count;
}

/* Combines values unless `status`, that of this share, is a failure.  Returns HR2D_OK, or the
   status of a share that has failed. */
hr2d_status hr2di_share_combine(hr2d_share *share, hr2d_status status, hr2d_combine how,
                                double *value, size_t count);

/* Gives all shares the same status; to be called on all of them at the end of a call, or where
   a failure does not end it. */
hr2d_status hr2di_share_agree(hr2d_share *share, hr2d_status status);

/* Begins a call, or goes on after a failure that is agreed upon. */
static inline void hr2di_share_begin(hr2d_share *share) {
  if (share) share->failed = HR2D_OK;
}

/* Puts the records of all shares, of `width` numbers each, one behind the other in the order of
   shares.  *record is reallocated.  HR2D_OK, HR2D_ENOMEM or the status of another share. */
hr2d_status hr2di_share_collect(hr2d_share *share, hr2d_status status,
                                const hr2d_allocator *alloc, double **record, size_t *count,
                                size_t width);

#endif
