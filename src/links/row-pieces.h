/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which parts of which rows of links are of this share.

   A row has all links of a patch with later ones.  A long row is cut into slots by the other
   patches of its pairs, so that whoever has some slots tests no pair of the others for
   visibility.  Behind the slots of a cut row stands one more, for the beams from its
   patch, which is made once for all of them.  A slot that still has too many links is cut into
   pieces: with m pieces, link k of a slot is of piece k mod m.  Links come in an order that
   depends on the scene alone, so that pieces have the same number of links, but for one. */
#ifndef HR2D_SRC_LINKS_ROW_PIECES_H
#define HR2D_SRC_LINKS_ROW_PIECES_H

#include <stddef.h>
#include <stdint.h>

typedef struct hr2di_row_pieces {
  uint32_t *slot;      /* per row, and one more: the number of its first slot */
  uint32_t *first;     /* per slot, and one more: the number of its first piece; NULL: slots are
                          whole */
  unsigned char *own;  /* per slot: some of it is of this share */
  unsigned char *mine; /* per piece: it is of this share; NULL: slots are whole */
  unsigned char *rows; /* per row: some slot is; NULL: nobody has dealt */
} hr2di_row_pieces;

/* The number of slots of a row, without the one for its beams. */
static inline uint32_t hr2di_row_slots(const hr2di_row_pieces *p, size_t row) {
  const uint32_t all = p->slot[row + 1] - p->slot[row];
  return all > 1 ? all - 1 : 1;
}

/* The slot of the beams of a row that is cut. */
static inline uint32_t hr2di_row_trace_slot(const hr2di_row_pieces *p, size_t row) {
  return p->slot[row + 1] - 1;
}

/* 2³² times the golden section: fractions of its multiples are as even as can be on any run of
   numbers, so that each slot has patches from everywhere. */
#define HR2DI_GOLDEN 2654435769U

/* The slot of a pair of patches. */
static inline uint32_t hr2di_row_slot(const hr2di_row_pieces *p, size_t row, size_t other) {
  const uint64_t place = (uint32_t)other * HR2DI_GOLDEN;
  return p->slot[row] + (uint32_t)((place * hr2di_row_slots(p, row)) >> 32);
}

/* The number of pieces of a slot. */
static inline uint32_t hr2di_slot_pieces(const hr2di_row_pieces *p, size_t slot) {
  return p->first ? p->first[slot + 1] - p->first[slot] : 1;
}

/* Whether this share counts what all do alike: it has the first piece of the slot. */
static inline int hr2di_slot_counts(const hr2di_row_pieces *p, size_t slot) {
  return p->mine ? p->mine[p->first[slot]] : p->own[slot];
}

#endif
