/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums for the entries of a sparse symmetric matrix that are there, in a hash table: terms of
   an entry are added in the order in which they come. */
#ifndef HR2D_SRC_VISIBILITY_ENTRY_TABLE_H
#define HR2D_SRC_VISIBILITY_ENTRY_TABLE_H

#include "base/watch.h"
#include "scene/scene-impl.h"

typedef struct hr2di_entry {
  uint64_t key; /* row · n + column, with row ≤ column */
  double area;
  int partial;
} hr2di_entry;

/* What is extrapolated behind the ends of a period, and what checks leave of it. */
typedef struct hr2di_entry_tail {
  double sum, check[HR2DI_TAIL_CHECKS];
} hr2di_entry_tail;

typedef struct hr2di_entry_table {
  const hr2d_allocator *alloc;
  hr2di_watch *watch;
  int tails; /* are wanted */
  hr2di_entry *entry;
  hr2di_entry_tail *tail; /* per entry, or NULL */
  size_t count, room[2];
  uint32_t *slot; /* an entry's number and 1; 0: free */
  size_t slots;   /* a power of two, at least twice the entries */
} hr2di_entry_table;

/* The number of the entry with a key, which is made if there is none.  HR2D_OK, HR2D_ENOMEM or
   the status of the watch. */
hr2d_status hr2di_entry_table_find(hr2di_entry_table *t, uint64_t key, size_t *number);

/* Brings the entries, and their tails, into the order of their keys; no entry can be found from
   then on. */
hr2d_status hr2di_entry_table_sort(hr2di_entry_table *t);

void hr2di_entry_table_clear(hr2di_entry_table *t);

#endif
