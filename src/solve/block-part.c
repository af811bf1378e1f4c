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

const double *hr2di_block_part(const hr2di_transport *t, hr2d_pair pair, const double *block,
                               double *room) {
  const size_t stride = t->blocks.order;
  if (!t->check) return block;
  const double part = hr2di_link_part(t, pair);
  for (size_t k = 0; k < stride * stride; k++) room[k] = part * block[k];
  return part == 0 ? NULL : room;
}
