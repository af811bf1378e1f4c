/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Search for an occluder: a patch that reaches into the shaft of two others. */
#include "scene/find-occluder.h"

#include "occlusion/pair-visibility.h"
#include "scene/in-between.h"
#include "scene/scene-impl.h"

/* A patch on the hull cannot stand between two others. */
static int all_on_hull(const hr2d_scene *scene, const hr2di_hull *hull, hr2di_watch *watch) {
  for (uint32_t k = 0; k < scene->walls.walls; k++) {
    if (k % 16 == 0 && hr2di_watch_work(watch, 16)) return 0;
    if (hr2di_hull_sides(hull, scene->walls.wall[k].at) == 3) return 0;
  }
  return 1;
}

/* Whether something may stand between two patches, so that it pays to look for them. */
static hr2d_status is_possible(hr2d_scene *scene, const hr2di_hull *hull, int *possible,
                               hr2di_watch *watch) {
  *possible = 0;
  if (all_on_hull(scene, hull, watch)) return HR2D_OK;
  *possible = 1;
  hr2d_status status = hr2di_watch_status(watch);
  if (!status) status = hr2di_scene_need_plane(scene, watch);
  return status || !scene->parts.wanted ? status
                                        : hr2di_in_between(scene, hull, possible, watch);
}

/* The first patch in the body of `wall` that reaches into the shaft itself. */
static size_t patch_in_way(const hr2d_scene *scene, const hr2di_shaft *shaft, uint32_t wall) {
  const hr2di_walls *walls = &scene->walls;
  for (size_t k = 0; k < scene->patches; k++) {
    hr2di_obstacle obstacle;
    if (walls->body_of[walls->of_segment[k]] == walls->body_of[wall] &&
        hr2di_shaft_test(shaft, scene->patch[k].scaled, &obstacle))
      return k;
  }
  return 0;
}

static hr2d_status look_between(const hr2d_scene *scene, hr2di_visibility *visibility, size_t i,
                                size_t j, hr2di_occlusion *found) {
  const hr2d_segment s = scene->patch[i].scaled, t = scene->patch[j].scaled;
  hr2di_shaft shaft;
  hr2di_visibility_class view;
  if (!hr2di_shaft_init(&shaft, hr2di_facing_of(&s, &t), s, t, s, t))
    return hr2di_watch_work(visibility->watch, 1);
  visibility->list.count = 0;
  const hr2d_status status =
      hr2di_visibility_collect(visibility, &shaft, &visibility->list, &view);
  if (status) return status;
  if (view != HR2DI_CLEAR)
    *found = (hr2di_occlusion){1, i, j, patch_in_way(scene, &shaft, visibility->last)};
  return hr2di_watch_work(visibility->watch, 4);
}

hr2d_status hr2di_occluder_find(hr2d_scene *scene, const hr2di_hull *hull,
                                hr2di_occlusion *found, hr2di_watch *watch) {
  int possible;
  *found = (hr2di_occlusion){0};
  hr2d_status status = is_possible(scene, hull, &possible, watch);
  if (status || !possible) return status;
  hr2di_visibility visibility;
  hr2di_visibility_init(&visibility, &scene->walls, &scene->alloc, watch);
  for (size_t i = 0; i < scene->patches && !found->exists && !status; i++)
    for (size_t j = i + 1; j < scene->patches && !found->exists && !status; j++)
      status = look_between(scene, &visibility, i, j, found);
  hr2di_visibility_clear(&visibility);
  return status;
}
