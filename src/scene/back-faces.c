/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of patch backs that no other patch covers. */
#include "scene/back-faces.h"

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "scene/scene-impl.h"

/* Whether t shares a stretch with s, on one line and in the same direction. */
static int lies_along(hr2d_segment s, hr2d_segment t) {
  return hr2di_orient_sign(s.a, s.b, t.a) == 0 && hr2di_orient_sign(s.a, s.b, t.b) == 0 &&
         hr2di_point_along(s, t.a) < hr2di_point_along(s, t.b) &&
         hr2di_point_along(s, t.a) < hr2di_point_along(s, s.b) &&
         hr2di_point_along(s, t.b) > hr2di_point_along(s, s.a);
}

static hr2d_status add(const hr2d_scene *scene, hr2di_backs *backs, uint32_t patch,
                       hr2d_segment at) {
  if (hr2di_alloc_reserve(&scene->alloc, &backs->back, &backs->capacity, backs->count + 1,
                          sizeof *backs->back))
    return HR2D_ENOMEM;
  backs->back[backs->count++] = (hr2di_back){at, patch};
  return HR2D_OK;
}

/* Removes t from the parts of one back, which are the items from `first` on. */
static hr2d_status cover(const hr2d_scene *scene, hr2di_backs *backs, size_t first,
                         hr2d_segment t) {
  hr2d_status status = HR2D_OK;
  for (size_t k = backs->count; k-- > first && !status;) {
    const hr2di_back b = backs->back[k];
    if (!lies_along(b.at, t)) continue;
    backs->back[k] = backs->back[--backs->count];
    if (hr2di_point_along(b.at, b.at.a) < hr2di_point_along(b.at, t.a))
      status = add(scene, backs, b.patch, (hr2d_segment){b.at.a, t.a});
    if (!status && hr2di_point_along(b.at, t.b) < hr2di_point_along(b.at, b.at.b))
      status = add(scene, backs, b.patch, (hr2d_segment){t.b, b.at.b});
  }
  return status;
}

hr2d_status hr2di_backs_init(const hr2d_scene *scene, hr2di_backs *backs, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (uint32_t k = 0; k < scene->patches && !status; k++) {
    const hr2d_segment s = scene->patch[k].scaled;
    const size_t first = backs->count;
    status = add(scene, backs, k, (hr2d_segment){s.b, s.a});
    for (size_t m = 0; m < scene->patches && !status && backs->count > first; m++) {
      status = hr2di_watch_work(watch, 1 + (backs->count - first) / 2);
      if (!status) status = cover(scene, backs, first, scene->patch[m].scaled);
    }
  }
  return status;
}
