/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/refine-marked.h"

#include "scene/scene-impl.h"

static hr2d_status halve(hr2d_hierarchy *h, uint32_t element, unsigned depth, uint64_t max) {
  if (depth == 0 || !hr2di_element_divisible(h, element)) return HR2D_OK;
  if (max && h->elements + 2 > max) return HR2D_EMAX_ELEMENTS;
  hr2d_status status = hr2di_hierarchy_reserve(h);
  if (status) return status;
  const uint32_t child = hr2di_element_halve(h, element);
  status = halve(h, child, depth - 1, max);
  return status ? status : halve(h, child + 1, depth - 1, max);
}

hr2d_status hr2di_refine_marked(const hr2d_hierarchy *from, const unsigned char *depth,
                                uint64_t max_elements, hr2di_watch *watch,
                                hr2d_hierarchy **divided) {
  hr2d_hierarchy *h;
  hr2d_status status = hr2di_hierarchy_clone(from, &h);
  if (status) return status;
  for (uint32_t k = 0; k < from->elements && !status; k++) {
    status = hr2di_watch_work(watch, 1);
    if (!status && h->element[k].patch < hr2di_scene_cell(h->scene))
      status = halve(h, k, depth[k], max_elements);
  }
  *divided = h;
  if (!status) return HR2D_OK;
  hr2d_hierarchy_destroy(h);
  *divided = NULL;
  return status;
}
