/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas count for the share that keeps their link, but those past walls, which are
   integrated before it is known whose they are. */
#include "refine/part-rows.h"

static uint64_t all_tests(const hr2di_projector *p) {
  return p->visibility ? hr2di_pair_visibility_tests(p->visibility) : 0;
}

uint64_t hr2di_part_rows_tests(const hr2di_projector *p) {
  return all_tests(p) - p->part.others;
}

void hr2di_part_rows_begin(hr2di_projector *p, uint32_t slot) {
  const hr2di_row_pieces *pieces = p->how.pieces;
  p->part.count = hr2di_slot_pieces(pieces, slot);
  p->part.mine = pieces->mine + pieces->first[slot];
  p->part.next = 0;
  p->part.areas = 0;
  p->part.before = p->counts;
  p->part.tests = all_tests(p);
}

void hr2di_part_rows_end(hr2di_projector *p) {
  if (!p->part.mine[0]) {
    const uint64_t links = p->counts.links;
    p->counts = p->part.before;
    p->counts.links = links;
    p->counts.exchange_areas += p->part.areas;
    p->part.others += all_tests(p) - p->part.tests;
  }
  p->part.count = 1;
}

size_t hr2di_part_rows_keep(hr2di_projector *p, const double **area, size_t count) {
  size_t kept = 0;
  if (p->part.count <= 1) return count;
  for (size_t k = 0; k < count; k++) {
    const size_t piece = p->part.next;
    p->part.next = piece + 1 < p->part.count ? piece + 1 : 0;
    if (!p->part.mine[piece]) continue;
    p->accepted[kept] = p->accepted[k];
    if (*area) p->error[kept] = (*area)[k];
    kept++;
  }
  if (*area)
    *area = p->error;
  else
    p->part.areas += kept;
  return kept;
}
