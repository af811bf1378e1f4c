/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "links/patch-defect.h"

#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

hr2d_status hr2di_defect_sum(const hr2d_linkset *links, hr2di_sum *defect, hr2di_watch *watch) {
  const hr2d_element *element = links->hierarchy->element;
  const hr2di_store *store = &links->store;
  for (size_t k = 0; k < links->hierarchy->scene->patches; k++)
    defect[k] = (hr2di_sum){element[k].length, 0};
  hr2d_status status = hr2di_watch_work(watch, links->hierarchy->scene->patches / 32);
  for (size_t block = 0; block < hr2di_store_chunks(store) && !status; block++) {
    status = hr2di_watch_work(watch, HR2DI_CHUNK_LINKS / 8);
    const uint64_t first = (uint64_t)block * HR2DI_CHUNK_LINKS;
    for (size_t k = 0; k < hr2di_store_chunk_size(store, block); k++) {
      const hr2d_link link = hr2di_store_link(store, first + k);
      hr2di_sum_add(&defect[element[link.pair.first].patch], -link.exchange_area);
      if (!links->directed)
        hr2di_sum_add(&defect[element[link.pair.second].patch], -link.exchange_area);
    }
  }
  return status;
}

void hr2di_defect_closed(const hr2d_linkset *links, const hr2di_sum *defect,
                         unsigned char *closed) {
  const hr2d_element *element = links->hierarchy->element;
  for (size_t k = 0; k < links->hierarchy->scene->patches; k++)
    closed[k] = fabs(hr2di_sum_total(&defect[k])) <= HR2DI_DEFECT_CLOSED * element[k].length;
}
