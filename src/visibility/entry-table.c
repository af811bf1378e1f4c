/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "visibility/entry-table.h"

#include "base/alloc.h"
#include "base/sort.h"

enum { FIRST_SLOTS = 1 << 10 };

/* Multiplication by an odd number near 2^64 over the golden ratio spreads keys that follow each
   other. */
static size_t slot_of(const hr2di_entry_table *t, uint64_t key) {
  uint64_t h = key * UINT64_C(0x9E3779B97F4A7C15);
  h ^= h >> 32;
  return (size_t)(h & (t->slots - 1));
}

static size_t search(const hr2di_entry_table *t, uint64_t key) {
  size_t at = slot_of(t, key);
  while (t->slot[at] && t->entry[t->slot[at] - 1].key != key) at = (at + 1) & (t->slots - 1);
  return at;
}

/* Twice the slots, in which all entries get their places again. */
static hr2d_status grow(hr2di_entry_table *t) {
  const size_t slots = t->slots ? 2 * t->slots : FIRST_SLOTS;
  uint32_t *slot = hr2di_alloc_zero(t->alloc, slots, sizeof *slot);
  if (!slot) return HR2D_ENOMEM;
  hr2di_alloc_free(t->alloc, t->slot);
  t->slot = slot;
  t->slots = slots;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < t->count && !status; k++) {
    if (k % 64 == 0) status = hr2di_watch_work(t->watch, 32);
    t->slot[search(t, t->entry[k].key)] = (uint32_t)k + 1;
  }
  return status;
}

static hr2d_status reserve(hr2di_entry_table *t) {
  if (t->count >= UINT32_MAX - 1 ||
      hr2di_alloc_reserve(t->alloc, &t->entry, &t->room[0], t->count + 1, sizeof *t->entry))
    return HR2D_ENOMEM;
  if (t->tails &&
      hr2di_alloc_reserve(t->alloc, &t->tail, &t->room[1], t->count + 1, sizeof *t->tail))
    return HR2D_ENOMEM;
  return 2 * (t->count + 1) > t->slots ? grow(t) : HR2D_OK;
}

hr2d_status hr2di_entry_table_find(hr2di_entry_table *t, uint64_t key, size_t *number) {
  const hr2d_status status = reserve(t);
  if (status) return status;
  const size_t at = search(t, key);
  if (!t->slot[at]) {
    t->entry[t->count] = (hr2di_entry){.key = key};
    if (t->tails) t->tail[t->count] = (hr2di_entry_tail){0};
    t->slot[at] = (uint32_t)++t->count;
  }
  *number = t->slot[at] - 1;
  return HR2D_OK;
}

typedef struct keyed {
  uint64_t key;
  size_t number;
} keyed;

static int by_key(const void *left, const void *right) {
  const keyed *l = left, *r = right;
  return (l->key > r->key) - (l->key < r->key);
}

static hr2d_status put_in_order(hr2di_entry_table *t, const keyed *order) {
  hr2di_entry *entry = hr2di_alloc(t->alloc, t->count, sizeof *entry);
  hr2di_entry_tail *tail = t->tails ? hr2di_alloc(t->alloc, t->count, sizeof *tail) : NULL;
  hr2d_status status = entry && (tail || !t->tails) ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = 0; k < t->count && !status; k++) {
    if (k % 64 == 0) status = hr2di_watch_work(t->watch, 32);
    entry[k] = t->entry[order[k].number];
    if (tail) tail[k] = t->tail[order[k].number];
  }
  hr2di_alloc_free(t->alloc, t->entry);
  hr2di_alloc_free(t->alloc, t->tail);
  t->entry = entry;
  t->tail = tail;
  return status;
}

hr2d_status hr2di_entry_table_sort(hr2di_entry_table *t) {
  hr2di_alloc_free(t->alloc, t->slot);
  t->slot = NULL;
  keyed *order = hr2di_alloc(t->alloc, t->count + 1, sizeof *order);
  if (!order) return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < t->count && !status; k++) {
    if (k % 64 == 0) status = hr2di_watch_work(t->watch, 4);
    order[k] = (keyed){t->entry[k].key, k};
  }
  if (!status) status = hr2di_sort(order, t->count, sizeof *order, by_key, t->watch);
  if (!status && t->count > 0) status = put_in_order(t, order);
  hr2di_alloc_free(t->alloc, order);
  return status;
}

void hr2di_entry_table_clear(hr2di_entry_table *t) {
  hr2di_alloc_free(t->alloc, t->entry);
  hr2di_alloc_free(t->alloc, t->tail);
  hr2di_alloc_free(t->alloc, t->slot);
}
