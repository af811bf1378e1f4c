/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plane of a scene is made once, by the first part of commit that needs it. */
#include "scene/scene-impl.h"

void hr2di_scene_clear_plane(hr2d_scene *scene) {
  hr2di_side_parts_clear(&scene->parts);
  hr2di_plane_clear(&scene->plane);
  scene->parts = (hr2di_side_parts){.alloc = scene->alloc};
  scene->plane = (hr2di_plane){.triangulation = {.alloc = scene->alloc},
                               .pieces = {.alloc = scene->alloc}};
  scene->unclear.is = 0;
}

hr2d_status hr2di_scene_need_plane(hr2d_scene *scene, hr2di_watch *watch) {
  uint32_t wall[2];
  if (scene->parts.wanted || scene->unclear.is) return HR2D_OK;
  hr2d_status status = hr2di_plane_init(&scene->plane, scene, wall, watch);
  if (status == HR2D_ESCENE && !hr2di_watch_status(watch)) {
    hr2di_scene_clear_plane(scene);
    scene->unclear.is = 1;
    for (int k = 0; k < 2; k++) scene->unclear.wall[k] = wall[k];
    return HR2D_OK;
  }
  if (!status) status = hr2di_side_parts_init(&scene->parts, scene, watch);
  return status;
}
