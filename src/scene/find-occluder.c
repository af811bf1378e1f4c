/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Search for an occluder: a patch that reaches into the shaft of two others. */
#include "scene/find-occluder.h"

#include <math.h>

#include "geometry/orient-sign.h"
#include "occlusion/pair-visibility.h"
#include "scene/scene-impl.h"

/* The sides of a line on which ends of patches lie. */
typedef struct sides {
  int left, right;
} sides;

static void add_sides(sides *found, hr2d_segment w, hr2d_segment s) {
  const int at_a = hr2di_orient_sign(w.a, w.b, s.a), at_b = hr2di_orient_sign(w.a, w.b, s.b);
  found->left |= at_a > 0 || at_b > 0;
  found->right |= at_a < 0 || at_b < 0;
}

/* Of x, y, x + y and x − y. */
enum { EXTREMES = 8 };

/* The patches with the greatest and the least of these coordinates. */
static void find_extremes(const hr2d_scene *scene, size_t patch[EXTREMES]) {
  for (int e = 0; e < EXTREMES; e++) {
    const int sign = e % 2 ? -1 : 1, which = e / 2;
    double most = -INFINITY;
    for (size_t k = 0; k < scene->patches; k++) {
      const hr2d_point p = scene->patch[k].scaled.a;
      const double at = which == 0   ? p.x
                        : which == 1 ? p.y
                        : which == 2 ? p.x + p.y
                                     : p.x - p.y;
      if (sign * at <= most) continue;
      most = sign * at;
      patch[e] = k;
    }
  }
}

/* A patch whose line has the whole scene on one side cannot stand between two patches. */
static int on_hull(const hr2d_scene *scene, size_t k, hr2di_watch *watch) {
  sides found = {0, 0};
  for (size_t m = 0; m < scene->patches; m++) {
    if (m % 16 == 0 && hr2di_watch_work(watch, 8)) return 0;
    add_sides(&found, scene->patch[k].scaled, scene->patch[m].scaled);
    if (found.left && found.right) return 0;
  }
  return 1;
}

/* Most scenes have a patch with extremes of the scene on both of its sides. */
static int all_on_hull(const hr2d_scene *scene, hr2di_watch *watch) {
  size_t extreme[EXTREMES];
  find_extremes(scene, extreme);
  for (size_t k = 0; k < scene->patches; k++) {
    sides found = {0, 0};
    if (hr2di_watch_work(watch, EXTREMES)) return 0;
    for (int e = 0; e < EXTREMES; e++)
      add_sides(&found, scene->patch[k].scaled, scene->patch[extreme[e]].scaled);
    if (found.left && found.right) return 0;
  }
  for (size_t k = 0; k < scene->patches; k++)
    if (!on_hull(scene, k, watch)) return 0;
  return 1;
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

hr2d_status hr2di_occluder_find(const hr2d_scene *scene, hr2di_occlusion *found,
                                hr2di_watch *watch) {
  *found = (hr2di_occlusion){0};
  if (all_on_hull(scene, watch)) return HR2D_OK;
  hr2di_visibility visibility;
  hr2di_visibility_init(&visibility, &scene->walls, &scene->alloc, watch);
  hr2d_status status = hr2di_watch_status(watch);
  for (size_t i = 0; i < scene->patches && !found->exists && !status; i++)
    for (size_t j = i + 1; j < scene->patches && !found->exists && !status; j++)
      status = look_between(scene, &visibility, i, j, found);
  hr2di_visibility_clear(&visibility);
  return status;
}
