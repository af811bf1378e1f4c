/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A patch on the hull cannot stand between two others; for the rest there are beams. */
#include "scene/find-occluder.h"

#include "scene/scene-impl.h"

static int all_on_hull(const hr2d_scene *scene, const hr2di_hull *hull, hr2di_watch *watch) {
  for (uint32_t k = 0; k < scene->walls.walls; k++) {
    if (k % 16 == 0 && hr2di_watch_work(watch, 16)) return 0;
    if (hr2di_hull_sides(hull, scene->walls.wall[k].at) == 3) return 0;
  }
  return 1;
}

hr2d_status hr2di_occluder_find(hr2d_scene *scene, const hr2di_hull *hull,
                                hr2di_occlusion *found, hr2di_watch *watch) {
  *found = (hr2di_occlusion){0};
  if (all_on_hull(scene, hull, watch)) return HR2D_OK;
  hr2d_status status = hr2di_watch_status(watch);
  if (!status) status = hr2di_scene_need_plane(scene, watch);
  if (status) return status;
  if (scene->parts.wanted) return hr2di_in_between(scene, hull, found, watch);
  found->exists = 1; /* commit will refuse the scene */
  return HR2D_OK;
}
