/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/share.h"

#include <string.h>

#include "base/alloc.h"

/* Early rows have more pairs than late ones: runs are dealt out to and fro. */
enum { RUNS_PER_SHARE = 64 };

hr2d_status hr2di_share_check(const hr2d_share *share) {
  if (!share) return HR2D_OK;
  const size_t known = offsetof(hr2d_share, failed) + sizeof share->failed;
  if (share->struct_size < known || !share->combine) return HR2D_EINVAL;
  return share->number < share->count ? HR2D_OK : HR2D_EINVAL;
}

int hr2di_share_has_row(const hr2d_share *share, size_t row, size_t rows) {
  if (!share) return 1;
  const size_t max = (size_t)RUNS_PER_SHARE * share->count, runs = rows < max ? rows : max;
  const size_t run = (size_t)((double)row * ((double)runs / (double)rows));
  const size_t at = run % share->count;
  return (run / share->count % 2 ? share->count - 1 - at : at) == share->number;
}

hr2d_status hr2di_share_combine(hr2d_share *share, hr2d_status status, hr2d_combine how,
                                double *value, size_t count) {
  if (!share || share->failed) return share ? share->failed : status;
  share->failed = share->combine(share->ctx, status, how, value, count);
  return share->failed;
}

hr2d_status hr2di_share_agree(hr2d_share *share, hr2d_status status) {
  return hr2di_share_combine(share, status, HR2D_COMBINE_SUM, NULL, 0);
}

/* Adding −0 changes no number, and no zero either. */
static double *place(const hr2d_allocator *alloc, const double *own, size_t count,
                     size_t before, size_t all, size_t width) {
  double *record = hr2di_alloc(alloc, all, width * sizeof *record);
  for (size_t k = 0; k < all * width && record; k++) record[k] = -0.0;
  if (record && count > 0) memcpy(record + before * width, own, count * width * sizeof *record);
  return record;
}

/* What the callback gave: numbers of records, of which this share knows its own. */
static int are_counts(const double *counts, const hr2d_share *share, size_t own) {
  const double max = 9007199254740992; /* 2⁵³: a double holds every integer below it */
  for (unsigned k = 0; k < share->count; k++)
    if (!(counts[k] >= 0 && counts[k] < max)) return 0;
  return counts[share->number] == (double)own;
}

hr2d_status hr2di_share_collect(hr2d_share *share, hr2d_status status,
                                const hr2d_allocator *alloc, double **record, size_t *count,
                                size_t width) {
  if (!share) return status;
  double *counts = hr2di_alloc_zero(alloc, share->count, sizeof *counts), *all = NULL;
  size_t before = 0, sum = 0;
  if (!status && !counts) status = HR2D_ENOMEM;
  if (counts) counts[share->number] = (double)*count;
  status = hr2di_share_combine(share, status, HR2D_COMBINE_SUM, counts, share->count);
  if (!status && !are_counts(counts, share, *count)) status = share->failed = HR2D_ECALLBACK;
  for (unsigned k = 0; k < share->count && !status; k++) {
    if (k < share->number) before += (size_t)counts[k];
    sum += (size_t)counts[k];
  }
  hr2di_alloc_free(alloc, counts);
  if (status) return status;
  all = place(alloc, *record, *count, before, sum, width);
  status = hr2di_share_combine(share, all ? HR2D_OK : HR2D_ENOMEM, HR2D_COMBINE_SUM, all,
                               sum * width);
  if (!all) return status;
  hr2di_alloc_free(alloc, *record);
  *record = all;
  *count = sum;
  return status;
}
