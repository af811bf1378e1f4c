/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Of several shares, areas are added up in bins: those of a patch, with the weights of images,
   are hr2di_symmetry_max() times its length at most. */
#include "links/patch-defect.h"

#include "base/alloc.h"
#include "base/bin.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

static void add_area(const hr2d_linkset *links, hr2di_bin *bin, uint32_t element, double area,
                     double max) {
  const hr2d_element *e = links->hierarchy->element;
  const size_t patch = hr2di_scene_original(links->hierarchy->scene, e[element].patch);
  hr2di_bin_add(&bin[patch], hr2di_bin_scale(2 * max * e[patch].length), area);
}

static hr2d_status sum_shares(const hr2d_linkset *links, hr2di_bin *bin, hr2di_sum *defect,
                              hr2di_watch *watch) {
  const size_t patches = links->hierarchy->scene->patches;
  const double max = hr2di_symmetry_max(&links->hierarchy->scene->symmetry);
  hr2d_status status = bin ? HR2D_OK : HR2D_ENOMEM;
  for (uint64_t k = 0; k < links->store.count && !status; k++) {
    const hr2d_link link = hr2di_store_link(&links->store, k);
    if (k % 64 == 0) status = hr2di_watch_work(watch, 16);
    add_area(links, bin, link.pair.first, link.exchange_area, max);
    if (!links->directed) add_area(links, bin, link.pair.second, link.exchange_area, max);
  }
  status = hr2di_share_combine(links->share, status, HR2D_COMBINE_SUM, bin ? &bin->head : NULL,
                               2 * patches);
  for (size_t k = 0; k < patches && !status; k++) {
    hr2di_sum_add(&defect[k], -bin[k].head);
    hr2di_sum_add(&defect[k], -bin[k].tail);
  }
  return status;
}

static hr2d_status sum_links(const hr2d_linkset *links, hr2di_sum *defect, hr2di_watch *watch) {
  const hr2d_element *element = links->hierarchy->element;
  const hr2di_store *store = &links->store;
  const hr2d_scene *scene = links->hierarchy->scene;
  hr2d_status status = hr2di_watch_work(watch, scene->patches / 32);
  for (size_t block = 0; block < hr2di_store_chunks(store) && !status; block++) {
    status = hr2di_watch_work(watch, HR2DI_CHUNK_LINKS / 8);
    const uint64_t first = (uint64_t)block * HR2DI_CHUNK_LINKS;
    for (size_t k = 0; k < hr2di_store_chunk_size(store, block); k++) {
      const hr2d_link link = hr2di_store_link(store, first + k);
      const size_t i = hr2di_scene_original(scene, element[link.pair.first].patch),
                   j = hr2di_scene_original(scene, element[link.pair.second].patch);
      hr2di_sum_add(&defect[i], -link.exchange_area);
      if (!links->directed) hr2di_sum_add(&defect[j], -link.exchange_area);
    }
  }
  return status;
}

hr2d_status hr2di_defect_sum(const hr2d_linkset *links, hr2di_sum *defect, hr2di_watch *watch) {
  const hr2d_scene *scene = links->hierarchy->scene;
  hr2di_bin *bin = NULL;
  for (size_t k = 0; k < scene->patches; k++)
    defect[k] = (hr2di_sum){links->hierarchy->element[k].length, 0};
  if (links->share) bin = hr2di_alloc_zero(&links->alloc, scene->patches, sizeof *bin);
  const hr2d_status status =
      links->share ? sum_shares(links, bin, defect, watch) : sum_links(links, defect, watch);
  hr2di_alloc_free(&links->alloc, bin);
  for (size_t k = hr2di_scene_cell(scene); k < scene->patches; k++)
    defect[k] = defect[hr2di_scene_original(scene, k)];
  return status;
}

void hr2di_defect_closed(const hr2d_linkset *links, const hr2di_sum *defect,
                         unsigned char *closed) {
  const hr2d_element *element = links->hierarchy->element;
  for (size_t k = 0; k < links->hierarchy->scene->patches; k++)
    closed[k] = fabs(hr2di_sum_total(&defect[k])) <= HR2DI_DEFECT_CLOSED * element[k].length;
}
