/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Another unfolding of a committed scene, with more images of its period. */
#include "base/alloc.h"
#include "scene/with-plane.h"

/* Sets what commit makes to nothing, without freeing: it belongs to the original. */
static void forget(hr2d_scene *copy, const hr2d_allocator *alloc) {
  hr2di_symmetry *s = &copy->symmetry;
  copy->alloc = *alloc;
  copy->committed = 0;
  copy->patch = NULL;
  copy->patches = copy->capacity = 0;
  s->motion = NULL;
  s->motions = s->cell = s->ends = 0;
  copy->walls = (hr2di_walls){.alloc = *alloc};
  copy->runs = (hr2di_runs){.alloc = *alloc};
  copy->parts = (hr2di_side_parts){.alloc = *alloc};
  copy->plane = (hr2di_plane){.triangulation = {.alloc = *alloc}, .pieces = {.alloc = *alloc}};
  copy->unclear.is = 0;
  copy->sunlight = (hr2di_sunlight){0};
  copy->dark = NULL;
  copy->other_side = NULL;
}

/* Uses of a light are counted, which several threads must not do: the patches have none of the
   original's. */
static hr2d_status add_cell(hr2d_scene *copy, const hr2d_scene *scene, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < hr2di_scene_cell(scene) && !status; k++) {
    hr2d_patch made = HR2D_PATCH_INIT;
    made.a = scene->patch[k].given.a;
    made.b = scene->patch[k].given.b;
    made.name = scene->patch[k].name;
    status = hr2di_scene_add(copy, &made, NULL, NULL);
    if (!status) status = hr2di_watch_work(watch, 4);
  }
  return status;
}

static hr2d_status unfold(hr2d_scene *copy, unsigned copies, hr2di_watch *watch) {
  hr2d_status status = hr2di_scene_unfold(copy, copies, watch);
  if (!status) status = hr2di_scene_scale(copy, watch);
  if (!status) status = hr2di_scene_make_walls(copy, watch);
  return status ? status : hr2di_scene_need_plane(copy, watch);
}

hr2d_status hr2di_with_images_init(hr2di_with_plane *copy, const hr2d_scene *scene,
                                   const hr2d_allocator *alloc, hr2di_watch *watch) {
  const hr2di_symmetry *s = &scene->symmetry;
  if (!s->motion || !s->by.periodic || hr2di_symmetry_cuts(s))
    return hr2di_with_plane_init(copy, scene, alloc, watch);
  unsigned min = 0, max = 0;
  *copy = (hr2di_with_plane){.scene = *scene, .own = 1, .repeated = 1};
  forget(&copy->scene, alloc);
  hr2d_status status = add_cell(&copy->scene, scene, watch);
  if (!status) hr2di_symmetry_copies(&copy->scene, &min, &max);
  return status ? status : unfold(&copy->scene, max, watch);
}
