/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene and its copy must not both clear a plane. */
#include "scene/with-plane.h"

#include "base/alloc.h"

hr2d_status hr2di_with_plane_init(hr2di_with_plane *copy, const hr2d_scene *scene,
                                  const hr2d_allocator *alloc, hr2di_watch *watch) {
  *copy = (hr2di_with_plane){.scene = *scene, .own = !scene->parts.wanted};
  if (!copy->own) return HR2D_OK;
  copy->scene.alloc = *alloc;
  return hr2di_scene_need_plane(&copy->scene, watch);
}

/* Frees what a copy has of its own beside the plane. */
static void clear_repeated(hr2d_scene *copy) {
  hr2di_scene_truncate(copy, 0);
  hr2di_alloc_free(&copy->alloc, copy->patch);
  hr2di_symmetry_clear(&copy->symmetry, &copy->alloc);
  hr2di_walls_clear(&copy->walls);
  hr2di_runs_clear(&copy->runs);
}

void hr2di_with_plane_clear(hr2di_with_plane *copy) {
  if (copy->own) hr2di_scene_clear_plane(&copy->scene);
  if (copy->repeated) clear_repeated(&copy->scene);
  copy->own = copy->repeated = 0;
}
