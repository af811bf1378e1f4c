/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which parts of which rows of links are of this share.

   A row has all links of a patch with later ones, in an order that depends on the scene alone.
   Link k of a row with m pieces is of piece k mod m: so pieces have the same number of links,
   but for one. */
#ifndef HR2D_SRC_LINKS_ROW_PIECES_H
#define HR2D_SRC_LINKS_ROW_PIECES_H

#include <stddef.h>
#include <stdint.h>

typedef struct hr2di_row_pieces {
  size_t *first;       /* per row, and one more: the number of its first piece */
  unsigned char *mine; /* per piece: it is of this share */
  unsigned char *rows; /* per row: some piece is; NULL: nobody has dealt */
} hr2di_row_pieces;

/* The number of pieces of a row. */
static inline size_t hr2di_row_pieces_of(const hr2di_row_pieces *p, size_t row) {
  return p->first[row + 1] - p->first[row];
}

#endif
