/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks for callers. */
#include <hr2d/transport.h>

#include "base/alloc.h"
#include "blocks/block.h"
#include "scene/scene-impl.h"

/* Links between patches and images count in part, and so do their blocks. */
static double weight_of(const hr2d_hierarchy *h, hr2d_pair pair) {
  const double weight = hr2di_symmetry_weight(&h->scene->symmetry, h->element[pair.first].patch,
                                              h->element[pair.second].patch, 0);
  return weight != 0 ? weight : 1;
}

hr2d_status hr2d_blocks(const hr2d_hierarchy *hierarchy, const hr2d_link *link, size_t count,
                        double *block) {
  if (!hierarchy || (count && (!link || !block))) return HR2D_EINVAL;
  const double unit = hr2d_scene_unit(hierarchy->scene);
  const size_t order = hierarchy->order, square = order * order;
  for (size_t k = 0; k < count; k++)
    if (link[k].pair.first >= hierarchy->elements || link[k].pair.second >= hierarchy->elements)
      return HR2D_EINVAL;
  hr2di_watch watch;
  hr2di_integrator work;
  hr2di_scene_watch(hierarchy->scene, &watch, NULL, NULL, "blocks");
  hr2d_status status =
      hr2di_integrator_init(&work, hierarchy, &hierarchy->alloc, order, NULL, &watch);
  for (size_t k = 0; k < count && !status; k++) {
    int distant;
    const double weight = weight_of(hierarchy, link[k].pair);
    status = hr2di_block(&work, link[k].pair, link[k].exchange_area / unit / weight,
                         block + k * square, &distant);
    for (size_t m = 0; m < square; m++) block[k * square + m] *= unit * weight;
  }
  hr2di_integrator_clear(&work);
  return status ? status : hr2di_watch_ask(&watch);
}
