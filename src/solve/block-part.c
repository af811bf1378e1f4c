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
  const hr2di_stored_block block = hr2di_link_blocks_at(&t->blocks, k);
  if (!t->check && !block.single && !block.rest) return block.value;
  const double part = hr2di_link_part(t, link->pair);
  if (part == 0) return NULL;
  hr2di_join_block(&block, link->exchange_area, room);
  for (size_t n = 0; n < square; n++) room[n] *= part;
  return room;
}
