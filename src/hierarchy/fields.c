/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trees and fields of callers: division of an element, push and pull. */
#include "base/alloc.h"
#include "geometry/vector.h"
#include "hierarchy/hierarchy-impl.h"
#include "hierarchy/push-pull.h"
#include "scene/scene-impl.h"

hr2d_status hr2d_hierarchy_divide(hr2d_hierarchy *hierarchy, uint32_t element, double t,
                                  uint32_t *child) {
  if (!hierarchy) return HR2D_EINVAL;
  if (hr2di_hierarchy_busy(hierarchy)) return HR2D_ESTATE;
  if (element >= hierarchy->elements || hierarchy->element[element].child ||
      !(t > 0 && t < 1) || hierarchy->level[element] == UINT16_MAX)
    return HR2D_EINVAL;
  const hr2d_element *e = &hierarchy->element[element];
  const hr2d_point at = t == 0.5 ? e->centre : hr2di_point_at((hr2d_segment){e->a, e->b}, t);
  if (hr2di_point_same(at, e->a) || hr2di_point_same(at, e->b) || !(t * e->length > 0) ||
      !((1 - t) * e->length > 0))
    return HR2D_EINVAL;
  const hr2d_status status = hr2di_hierarchy_reserve(hierarchy);
  if (status) return status;
  const uint32_t left = hr2di_element_divide(hierarchy, element, t, at);
  if (child) *child = left;
  return HR2D_OK;
}

static hr2d_status carry(const hr2d_hierarchy *hierarchy, size_t bands, double *field,
                         void (*transfer)(const hr2di_push_pull *, const double *, double *)) {
  hr2di_push_pull trees;
  hr2di_watch watch;
  if (bands == 0) return HR2D_EINVAL;
  hr2di_scene_watch(hierarchy->scene, &watch, NULL, NULL, "fields");
  hr2d_status status = hr2di_push_pull_init(&trees, hierarchy, &hierarchy->alloc,
                                            hierarchy->order, bands, &watch);
  if (!status) transfer(&trees, NULL, field);
  hr2di_push_pull_clear(&trees);
  return status ? status : hr2di_watch_status(&watch);
}

hr2d_status hr2d_hierarchy_pull(const hr2d_hierarchy *hierarchy, size_t bands, double *field) {
  if (!hierarchy || !field) return HR2D_EINVAL;
  return carry(hierarchy, bands, field, hr2di_push_pull_up);
}

hr2d_status hr2d_hierarchy_push(const hr2d_hierarchy *hierarchy, size_t bands, double *field) {
  if (!hierarchy || !field) return HR2D_EINVAL;
  return carry(hierarchy, bands, field, hr2di_push_pull_down);
}
