/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "estimate/shared-sums.h"

#include "base/alloc.h"

hr2d_status hr2di_shared_sums_init(hr2di_shared_sums *s, hr2d_share *share,
                                   const hr2d_allocator *alloc, double *sum, size_t count) {
  *s = (hr2di_shared_sums){.share = share, .alloc = *alloc, .sum = sum, .count = count};
  if (!share) return HR2D_OK;
  s->space = hr2di_alloc_zero(alloc, count, 4 * sizeof *s->space);
  if (!s->space) return HR2D_ENOMEM;
  s->max = s->space;
  s->number = s->space + count;
  s->bin = (hr2di_bin *)(s->space + 2 * count);
  return HR2D_OK;
}

void hr2di_shared_sums_clear(hr2di_shared_sums *s) {
  hr2di_alloc_free(&s->alloc, s->space);
}

static hr2d_status set_scales(hr2di_shared_sums *s, hr2d_status status) {
  status = hr2di_share_combine(s->share, status, HR2D_COMBINE_MOST, s->max, s->count);
  if (!status)
    status = hr2di_share_combine(s->share, HR2D_OK, HR2D_COMBINE_SUM, s->number, s->count);
  for (size_t k = 0; k < s->count && !status; k++)
    s->max[k] = hr2di_bin_scale(s->max[k] * s->number[k]);
  return status;
}

hr2d_status hr2di_shared_sums_end(hr2di_shared_sums *s, hr2d_status status, int *again) {
  *again = 0;
  if (!s->share) return status;
  if (!s->adding) {
    status = set_scales(s, status);
    *again = s->adding = !status;
    return status;
  }
  status = hr2di_share_combine(s->share, status, HR2D_COMBINE_SUM, &s->bin->head, 2 * s->count);
  for (size_t k = 0; k < s->count && !status; k++) s->sum[k] = hr2di_bin_total(&s->bin[k]);
  return status;
}
