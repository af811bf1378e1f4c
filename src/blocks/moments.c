/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mean over σ in [-1,1] of φ_l(c + hσ) φ_m(c' − h'σ), without points in σ.

   Let π_k be the monic Legendre polynomials, σπ_k = π_{k+1} + β_k π_{k−1} with
   β_k = k²/(4k²−1), and ν_k the mean of π_k².  Then π_l(c + hσ) = Σ_k h^k r_lk π_k(σ), and the
   recurrence of π_l gives
     r_{l+1,k} = c r_lk + r_{l,k−1} + h² β_{k+1} r_{l,k+1} − β_l r_{l−1,k},
   so that the mean of π_l π_m is Σ_k (−hh')^k ν_k r_lk r'_mk, k ≤ min(l,m).  That takes p³/3
   products, where a Gauss rule of p points takes p³; and it is as stable, being the recurrence
   of bounded polynomials in another basis.  Lines that cover i, c = 0 and h = 1, have r_lk = 1
   for k = l alone, and only the rows of j are needed.

   LANES directions lie side by side, in vectors of two or of four (see moment-batches.h); of
   the last ones HALF, if that is enough. */
#include "blocks/moments.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/ordered-dot.h"
#include "base/wide.h"

enum { LANES = HR2DI_MOMENT_LANES, HALF = LANES / 2 };

static size_t even(size_t order) {
  return order + (order & 1);
}

hr2d_status hr2di_moments_init(hr2di_moments *w, size_t order, const hr2d_allocator *alloc) {
  const size_t rows = even(order);
  w->order = order;
  w->norm[0] = 1;
  w->square[0] = 0;
  for (size_t k = 1; k < order; k++) {
    const double square = (double)(k * k);
    w->square[k] = square / (4 * square - 1);
    w->norm[k] = w->norm[k - 1] * w->square[k];
  }
  for (size_t k = 0; k < order; k++) w->scale[k] = 1 / sqrt(w->norm[k]);
  hr2di_moments_begin(w);
  w->row[0] = hr2di_alloc_zero(alloc, 2 * rows * rows, LANES * sizeof *w->row[0]);
  w->row[1] = w->row[0] ? w->row[0] + rows * rows * LANES : NULL;
  return w->row[0] ? HR2D_OK : HR2D_ENOMEM;
}

void hr2di_moments_clear(hr2di_moments *w, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, w->row[0]);
}

void hr2di_moments_begin(hr2di_moments *w) {
  for (size_t k = 0; k < 3; k++) w->waiting[k].count = 0;
}

#define HR2DI_WIDTH 2
#include "blocks/moment-batches.h"
#ifdef HR2D_AVX2
#define HR2DI_WIDTH 4
#include "blocks/moment-batches.h"
#endif

/* Adds the first `count` directions that wait, a multiple of HALF. */
static void add_waiting(hr2di_moments *w, hr2di_cover cover, size_t count, double *block) {
  hr2di_directions *d = &w->waiting[cover];
#ifdef HR2D_AVX2
  if (hr2di_wide())
    add_batches_4(w, cover, count, block);
  else
#endif
    add_batches_2(w, cover, count, block);
  double *const list[] = {d->weight, d->centre[0], d->half[0], d->centre[1], d->half[1]};
  d->count -= count;
  for (size_t k = 0; k < 5; k++) memmove(list[k], list[k] + count, d->count * sizeof *list[k]);
}

hr2di_directions *hr2di_moments_room(hr2di_moments *w, hr2di_cover cover, double *block) {
  hr2di_directions *d = &w->waiting[cover];
  if (d->count + HR2DI_RULE_POINTS > HR2DI_MOMENT_ROOM)
    add_waiting(w, cover, d->count - d->count % LANES, block);
  return d;
}

void hr2di_moments_end(hr2di_moments *w, double *block) {
  for (int cover = 0; cover < 3; cover++) {
    hr2di_directions *d = &w->waiting[cover];
    if (d->count == 0) continue;
    for (; d->count % HALF > 0; d->count++) {
      d->weight[d->count] = 0;
      d->centre[0][d->count] = d->centre[1][d->count] = 0;
      d->half[0][d->count] = d->half[1][d->count] = 0;
    }
    add_waiting(w, (hr2di_cover)cover, d->count, block);
  }
}
