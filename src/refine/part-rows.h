/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of which a share has a part.  All shares with a piece of a slot refine the slot; the one
   with its first piece counts the work for all. */
#ifndef HR2D_SRC_REFINE_PART_ROWS_H
#define HR2D_SRC_REFINE_PART_ROWS_H

#include "refine/projector.h"

/* Stands for all slots of a row that are whole and of this share. */
#define HR2DI_WHOLE_SLOTS UINT32_MAX

/* Whether a pair of patches is to be proposed with a slot, or with all whole ones. */
static inline int hr2di_part_rows_want(const hr2di_projector *p, size_t row, size_t other,
                                       uint32_t slot) {
  const hr2di_row_pieces *pieces = p->how.pieces;
  if (!pieces) return 1;
  const uint32_t of = hr2di_row_slot(pieces, row, other);
  if (slot != HR2DI_WHOLE_SLOTS) return of == slot;
  return pieces->own[of] && hr2di_slot_pieces(pieces, of) == 1;
}

/* Begins a slot with several pieces, and ends it when it has no pairs left. */
void hr2di_part_rows_begin(hr2di_projector *p, uint32_t slot);
void hr2di_part_rows_end(hr2di_projector *p);

/* Drops accepted pairs of other shares, with their areas unless these are NULL; `area` may be
   p->kept_area afterwards.  Returns how many are left. */
size_t hr2di_part_rows_keep(hr2di_projector *p, const double **area, size_t count);

/* The tests of visibility that this projector counts. */
uint64_t hr2di_part_rows_tests(const hr2di_projector *p);

#endif
