/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/block-part.h"

#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

double hr2di_link_part(const hr2di_transport *t, hr2d_pair pair) {
  const hr2d_element *e = t->hierarchy->element;
  if (!t->check) return 1;
  return hr2di_symmetry_check(&t->hierarchy->scene->symmetry, e[pair.first].patch,
                              e[pair.second].patch, t->check - 1);
}

const double *hr2di_block_part(const hr2di_transport *t, const hr2d_link *link, uint64_t k,
                               double *room) {
  const size_t square = t->blocks.order * t->blocks.order;
  const void *block = hr2di_link_blocks_at(&t->blocks, k);
  const int single = t->blocks.single;
  if (!t->check && !single) return block;
  const double part = hr2di_link_part(t, link->pair);
  for (size_t n = 0; n < square; n++)
    room[n] = part * hr2di_number_at(block, n, single, link->exchange_area);
  return part == 0 ? NULL : room;
}
