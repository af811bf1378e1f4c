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

   LANES directions lie side by side.  Each sum has four partial sums, which fit vectors of two
   or of four, so that no bit depends on the width of vectors. */
#include "blocks/moments.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/ordered-dot.h"

enum { LANES = HR2DI_MOMENT_LANES, PAIRS = LANES / 2 };

typedef double pair __attribute__((vector_size(16), aligned(8), may_alias));

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

/* The rows r_lk of one element for all k ≤ l < order, a pair of lanes after the other. */
static void expand(const hr2di_moments *w, const pair *centre, const pair *half, pair *row) {
  const size_t p = w->order, stride = even(p) * PAIRS;
  for (size_t x = 0; x < PAIRS; x++, row++) {
    const pair c = centre[x], square = half[x] * half[x];
    row[0] = c * 0 + 1;
    for (size_t l = 1; l < p; l++) {
      const pair *last = row + (l - 1) * stride, *before = l > 1 ? last - stride : last;
      pair *next = row + l * stride;
      const double down = w->square[l - 1];
      pair left = c * 0, here = last[0];
      for (size_t k = 0; k + 1 < l; k++) {
        const pair right = last[(k + 1) * PAIRS];
        next[k * PAIRS] =
            (c * here - down * before[k * PAIRS]) + (left + w->square[k + 1] * square * right);
        left = here;
        here = right;
      }
      next[(l - 1) * PAIRS] = c * here + left;
      next[l * PAIRS] = row[0];
    }
  }
}

/* r_lk *= weight ν_k (−hh')^k */
static void weigh(const hr2di_moments *w, const pair *weight, const pair *half,
                  const pair *other, pair *row) {
  const size_t p = w->order, stride = even(p) * PAIRS;
  for (size_t x = 0; x < PAIRS; x++, row++) {
    const pair product = -(half[x] * other[x]);
    pair power = weight[x];
    for (size_t k = 0; k < p; k++) {
      const pair factor = w->norm[k] * power;
      for (size_t l = k; l < p; l++) row[l * stride + k * PAIRS] *= factor;
      power *= product;
    }
  }
}

static double total(pair even, pair odd) {
  return hr2di_dot_four(even[0], even[1], odd[0], odd[1]);
}

/* Σ_x a[x] b[x] for two rows a and two rows b. */
static void multiply(const pair *a, const pair *b, size_t stride, size_t count,
                     double sum[2][2]) {
  const pair *a1 = a + stride, *b1 = b + stride, zero = {0, 0};
  pair s00 = zero, t00 = zero, s01 = zero, t01 = zero;
  pair s10 = zero, t10 = zero, s11 = zero, t11 = zero;
  for (size_t x = 0; x < count; x += 2) {
    s00 += a[x] * b[x];
    s01 += a[x] * b1[x];
    s10 += a1[x] * b[x];
    s11 += a1[x] * b1[x];
    t00 += a[x + 1] * b[x + 1];
    t01 += a[x + 1] * b1[x + 1];
    t10 += a1[x + 1] * b[x + 1];
    t11 += a1[x + 1] * b1[x + 1];
  }
  sum[0][0] = total(s00, t00);
  sum[0][1] = total(s01, t01);
  sum[1][0] = total(s10, t10);
  sum[1][1] = total(s11, t11);
}

/* Entries beyond the order, which is rounded up to even, are 0 times something finite. */
static void add_product(const hr2di_moments *w, double *block) {
  const size_t p = w->order, stride = even(p) * PAIRS;
  for (size_t l = 0; l < p; l += 2)
    for (size_t m = 0; m < p; m += 2) {
      double sum[2][2];
      const size_t terms = l < m ? l + 2 : m + 2;
      multiply((const pair *)w->row[0] + l * stride, (const pair *)w->row[1] + m * stride,
               stride, terms * PAIRS, sum);
      for (size_t r = l; r < p && r < l + 2; r++)
        for (size_t c = m; c < p && c < m + 2; c++)
          block[r * p + c] += w->scale[r] * w->scale[c] * sum[r - l][c - m];
    }
}

static void expand_batch(const hr2di_moments *w, const hr2di_directions *d, size_t from,
                         size_t side) {
  expand(w, (const pair *)(d->centre[side] + from), (const pair *)(d->half[side] + from),
         (pair *)w->row[side]);
}

static void add_batch(hr2di_moments *w, const hr2di_directions *d, size_t from, double *block) {
  expand_batch(w, d, from, 0);
  expand_batch(w, d, from, 1);
  weigh(w, (const pair *)(d->weight + from), (const pair *)(d->half[0] + from),
        (const pair *)(d->half[1] + from), (pair *)w->row[0]);
  add_product(w, block);
}

/* The same for lines that cover the other element than `side`. */
static void add_covering(hr2di_moments *w, const hr2di_directions *d, size_t from, size_t side,
                         double *block) {
  const size_t p = w->order, stride = even(p) * PAIRS;
  const pair *weight = (const pair *)(d->weight + from);
  const pair *half = (const pair *)(d->half[side] + from), *row = (const pair *)w->row[side];
  pair factor[PAIRS];
  expand_batch(w, d, from, side);
  for (size_t x = 0; x < PAIRS; x++) factor[x] = weight[x];
  for (size_t k = 0; k < p; k++) {
    for (size_t m = k; m < p; m++) {
      const pair *at = row + m * stride + k * PAIRS;
      const pair low = factor[0] * at[0] + factor[2] * at[2];
      const pair high = factor[1] * at[1] + factor[3] * at[3];
      block[side ? k * p + m : m * p + k] +=
          w->norm[k] * w->scale[k] * w->scale[m] * total(low, high);
    }
    for (size_t x = 0; x < PAIRS; x++) factor[x] *= -half[x];
  }
}

/* Adds the full batches of the directions that wait. */
static void add_waiting(hr2di_moments *w, hr2di_cover cover, double *block) {
  hr2di_directions *d = &w->waiting[cover];
  size_t from = 0;
  for (; from + LANES <= d->count; from += LANES)
    if (cover == HR2DI_COVERS_NEITHER)
      add_batch(w, d, from, block);
    else
      add_covering(w, d, from, cover, block);
  double *const list[] = {d->weight, d->centre[0], d->half[0], d->centre[1], d->half[1]};
  d->count -= from;
  for (size_t k = 0; k < 5; k++) memmove(list[k], list[k] + from, d->count * sizeof *list[k]);
}

hr2di_directions *hr2di_moments_room(hr2di_moments *w, hr2di_cover cover, double *block) {
  hr2di_directions *d = &w->waiting[cover];
  if (d->count + HR2DI_RULE_POINTS > HR2DI_MOMENT_ROOM) add_waiting(w, cover, block);
  return d;
}

void hr2di_moments_end(hr2di_moments *w, double *block) {
  for (int cover = 0; cover < 3; cover++) {
    hr2di_directions *d = &w->waiting[cover];
    if (d->count == 0) continue;
    for (; d->count % LANES > 0; d->count++) {
      d->weight[d->count] = 0;
      d->centre[0][d->count] = d->centre[1][d->count] = 0;
      d->half[0][d->count] = d->half[1][d->count] = 0;
    }
    add_waiting(w, (hr2di_cover)cover, block);
  }
}
