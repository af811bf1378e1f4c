/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quicksort down to parts that qsort() sorts at once.  Pivots are the median of three items at
   random places, so that no order of the items makes it slow on purpose. */
#include "base/sort.h"

#include <stdlib.h>
#include <string.h>

/* Parts of so SMALL_RANGE items are sorted at once; the longer of two parts waits, so that each
   that waits is less than half of the one before. */
enum { SMALL_RANGE = 1024, WAITING = 64 };

typedef struct sorter {
  size_t size;
  int (*compare)(const void *, const void *);
  hr2di_watch *watch;
  uint64_t random;
} sorter;

static void swap(const sorter *s, char *p, char *q) {
  char kept[HR2DI_SORT_BYTES];
  memcpy(kept, p, s->size);
  memmove(p, q, s->size);
  memcpy(q, kept, s->size);
}

static char *pick(sorter *s, char *items, size_t count) {
  s->random = s->random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return items + (size_t)(s->random >> 33) % count * s->size;
}

static char *median(sorter *s, char *items, size_t count) {
  char *p = pick(s, items, count), *q = pick(s, items, count), *r = pick(s, items, count);
  if (s->compare(p, q) > 0) {
    char *const kept = p;
    p = q;
    q = kept;
  }
  if (s->compare(q, r) <= 0) return q;
  return s->compare(p, r) > 0 ? p : r;
}

/* Puts items that are less than the pivot to the front and greater ones to the end; *low and
 *high are where those that are equal begin and end. */
static hr2d_status part(sorter *s, char *items, size_t count, size_t *low, size_t *high) {
  char pivot[HR2DI_SORT_BYTES];
  hr2d_status status = HR2D_OK;
  size_t less = 0, k = 0, greater = count;
  memcpy(pivot, median(s, items, count), s->size);
  for (size_t turn = 0; k < greater && !status; turn++) {
    if (turn % SMALL_RANGE == 0) status = hr2di_watch_work(s->watch, SMALL_RANGE / 4);
    const int order = s->compare(items + k * s->size, pivot);
    if (order < 0)
      swap(s, items + less++ * s->size, items + k++ * s->size);
    else if (order > 0)
      swap(s, items + k * s->size, items + --greater * s->size);
    else
      k++;
  }
  *low = less;
  *high = greater;
  return status;
}

typedef struct range {
  size_t first, count;
} range;

hr2d_status hr2di_sort(void *items, size_t count, size_t size,
                       int (*compare)(const void *, const void *), hr2di_watch *watch) {
  if (count < 2) return hr2di_watch_status(watch);
  sorter s = {.size = size, .compare = compare, .watch = watch};
  range waiting[WAITING];
  size_t ranges = 0;
  hr2d_status status = HR2D_OK;
  waiting[ranges++] = (range){0, count};
  while (ranges > 0 && !status) {
    const range r = waiting[--ranges];
    char *const first = (char *)items + r.first * size;
    if (r.count <= SMALL_RANGE) {
      status = hr2di_watch_work(watch, r.count);
      if (!status && r.count > 1) qsort(first, r.count, size, compare);
      continue;
    }
    size_t before, behind;
    status = part(&s, first, r.count, &before, &behind);
    const range low = {r.first, before}, high = {r.first + behind, r.count - behind};
    waiting[ranges++] = low.count > high.count ? low : high;
    waiting[ranges++] = low.count > high.count ? high : low;
  }
  return status;
}
