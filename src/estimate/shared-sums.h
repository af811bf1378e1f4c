/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums of terms that are not negative, one for each of many places, over the links of all
   shares. They are looked at twice: first for the largest term of each place and their number,
   then to add them up in bins, so that no bit depends on the order. */
#ifndef HR2D_SRC_ESTIMATE_SHARED_SUMS_H
#define HR2D_SRC_ESTIMATE_SHARED_SUMS_H

#include "base/bin.h"
#include "base/share.h"

typedef struct hr2di_shared_sums {
  hr2d_share *share; /* NULL: there is but one, and terms are added up plainly, in one look */
  hr2d_allocator alloc;
  double *sum;    /* the caller's */
  double *space;  /* holds the arrays below */
  double *max;    /* the largest term, then σ */
  double *number; /* of terms */
  hr2di_bin *bin;
  size_t count;
  int adding; /* the second look */
} hr2di_shared_sums;

/* `sum` is for `count` places, all 0.  HR2D_OK or HR2D_ENOMEM; to be cleared in any case. */
hr2d_status hr2di_shared_sums_init(hr2di_shared_sums *s, hr2d_share *share,
                                   const hr2d_allocator *alloc, double *sum, size_t count);
void hr2di_shared_sums_clear(hr2di_shared_sums *s);

static inline void hr2di_shared_sums_add(hr2di_shared_sums *s, size_t place, double term) {
  if (!s->share) {
    s->sum[place] += term;
  } else if (s->adding) {
    hr2di_bin_add(&s->bin[place], s->max[place], term);
  } else {
    s->max[place] = fmax(s->max[place], term);
    s->number[place]++;
  }
}

/* Ends a look.  Sets *again if there is another one; at the end `sum` has the sums.  `status`
   is that of this share.  Returns HR2D_OK or the status of a share. */
hr2d_status hr2di_shared_sums_end(hr2di_shared_sums *s, hr2d_status status, int *again);

#endif
