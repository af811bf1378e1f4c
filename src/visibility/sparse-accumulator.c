/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sum of two terms is the same in either order.  Where a pair has more than two shares, the
   shares of its row are sorted: rows then are the same whichever end of a line class found it.
 */
#include "visibility/sparse-accumulator.h"

#include "base/alloc.h"
#include "base/sort.h"

enum { WORD = 64, TWO_SHARES = 2, SHARE_COUNT = 3, PARTIAL = 4 };

hr2d_status hr2di_sparse_accumulator_init(hr2di_sparse_accumulator *s, size_t n,
                                          const hr2d_allocator *alloc, hr2di_watch *watch) {
  *s = (hr2di_sparse_accumulator){.alloc = *alloc, .watch = watch};
  s->sum = hr2di_alloc(alloc, n, sizeof *s->sum);
  s->state = hr2di_alloc_zero(alloc, n, sizeof *s->state);
  if (!s->sum || !s->state) return HR2D_ENOMEM;
  do {
    n = (n + WORD - 1) / WORD;
    s->level[s->levels] = hr2di_alloc_zero(alloc, n, sizeof **s->level);
    if (!s->level[s->levels++]) return HR2D_ENOMEM;
  } while (n > 1);
  return HR2D_OK;
}

void hr2di_sparse_accumulator_clear(hr2di_sparse_accumulator *s) {
  hr2di_alloc_free(&s->alloc, s->sum);
  hr2di_alloc_free(&s->alloc, s->state);
  for (int k = 0; k < s->levels; k++) hr2di_alloc_free(&s->alloc, s->level[k]);
  hr2di_alloc_free(&s->alloc, s->column);
  hr2di_alloc_free(&s->alloc, s->area);
}

static void mark(hr2di_sparse_accumulator *s, size_t column) {
  for (int k = 0; k < s->levels; k++) {
    uint64_t *word = &s->level[k][column / WORD];
    const int was_empty = *word == 0;
    *word |= (uint64_t)1 << column % WORD;
    if (!was_empty) return;
    column /= WORD;
  }
}

/* The place of the lowest bit that is 1. */
static unsigned lowest(uint64_t word) {
#ifdef __GNUC__
  return (unsigned)__builtin_ctzll(word);
#else
  unsigned k = 0;
  while (!(word >> k & 1)) k++;
  return k;
#endif
}

/* Takes the columns of a word out of the set, in order. */
static void take_word(hr2di_sparse_accumulator *s, size_t index) {
  uint64_t word = s->level[0][index];
  s->level[0][index] = 0;
  for (; word; word &= word - 1) {
    const size_t column = index * WORD + lowest(word);
    s->column[s->count] = (uint32_t)column | (s->state[column] & PARTIAL ? HR2DI_PARTIAL : 0);
    s->area[s->count++] = s->sum[column];
    s->state[column] = 0;
  }
}

static void take_all(hr2di_sparse_accumulator *s) {
  size_t index[HR2DI_ROW_LEVELS] = {0};
  int k = s->levels - 1;
  s->count = 0;
  if (k == 0) take_word(s, 0);
  while (k > 0 && k < s->levels) {
    uint64_t *word = &s->level[k][index[k]];
    if (!*word) {
      k++;
      continue;
    }
    const size_t below = index[k] * WORD + lowest(*word);
    *word &= *word - 1;
    index[k - 1] = below;
    if (k == 1)
      take_word(s, below);
    else
      k--;
  }
}

static int by_column(const void *left, const void *right) {
  const hr2di_contribution *l = left, *r = right;
  if (l->patch != r->patch) return l->patch < r->patch ? -1 : 1;
  if (l->later != r->later) return l->later - r->later;
  if (l->area != r->area) return l->area < r->area ? -1 : 1;
  return l->partial - r->partial;
}

/* Sums again, in an order that the shares alone determine. */
static hr2d_status sum_sorted(hr2di_sparse_accumulator *s, hr2di_contribution *share,
                              size_t count) {
  const hr2d_status status = hr2di_sort(share, count, sizeof *share, by_column, s->watch);
  if (status) return status;
  for (size_t first = 0, last; first < count; first = last) {
    double part[2] = {0, 0};
    for (last = first; last < count && share[last].patch == share[first].patch; last++)
      part[share[last].later] += share[last].area;
    s->sum[share[first].patch] = part[0] + part[1];
  }
  return HR2D_OK;
}

hr2d_status hr2di_sparse_accumulator_make(hr2di_sparse_accumulator *s,
                                          hr2di_contribution *share, size_t count) {
  int many = 0;
  hr2d_status status = hr2di_watch_work(s->watch, 1 + count / 8);
  if (status) return status;
  if (hr2di_alloc_reserve(&s->alloc, &s->column, &s->room[0], count, sizeof *s->column) ||
      hr2di_alloc_reserve(&s->alloc, &s->area, &s->room[1], count, sizeof *s->area))
    return HR2D_ENOMEM;
  for (size_t k = 0; k < count; k++) {
    const size_t column = share[k].patch;
    unsigned char *state = &s->state[column];
    const int contributions = *state & SHARE_COUNT;
    if (contributions == 0) {
      mark(s, column);
      s->sum[column] = share[k].area;
    } else {
      s->sum[column] += share[k].area;
      many |= contributions >= TWO_SHARES;
    }
    *state = (unsigned char)((*state & PARTIAL) | (share[k].partial ? PARTIAL : 0) |
                             (contributions < SHARE_COUNT ? contributions + 1 : SHARE_COUNT));
  }
  if (many) status = sum_sorted(s, share, count);
  take_all(s);
  return status;
}
