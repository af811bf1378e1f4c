/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams leave the backs of walls, most of which are inside of things and see nothing but each
   other; where they end, somebody sees a back. */
#include "visibility/seen-backs.h"

#include <string.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"

static hr2d_status mark(void *ctx, const hr2di_sight *sight, hr2di_wall_side side) {
  unsigned char *looked_from = ctx;
  (void)sight;
  looked_from[side] = 1;
  return HR2D_OK;
}

static hr2d_status look_from_backs(const hr2d_scene *scene, const hr2d_allocator *alloc,
                                   unsigned char *looked_from, hr2di_watch *watch) {
  const hr2di_side_parts *p = &scene->parts;
  const hr2di_triangulation *t = &scene->plane.triangulation;
  hr2di_walk walk = {.in = t,
                     .wanted = p->wanted,
                     .take = mark,
                     .ctx = looked_from,
                     .alloc = *alloc,
                     .watch = watch};
  hr2d_status status = HR2D_OK;
  for (hr2di_wall_side s = 0; s < 2 * t->edges && !status; s++) {
    const hr2di_parts of = p->of_side[s].parts;
    status = hr2di_watch_work(watch, 1 + (of.last - of.first) / 8);
    if (!status && hr2di_side_kind(p, s) & HR2DI_HAS_BACK)
      status = hr2di_walk_from(&walk, s, NULL);
  }
  hr2di_walk_clear(&walk);
  return status;
}

/* Patches along sides that are looked from, and those that lie, wholly or in part, so close
   behind others that they see nothing else. */
static void pass_on(const hr2di_side_parts *p, const unsigned char *looked_from, size_t patches,
                    unsigned char *sees) {
  for (size_t k = 0; k < patches; k++) sees[k] = p->of_patch[k].first == p->of_patch[k].last;
  for (size_t k = 0; k < p->parts; k++)
    if (p->part[k].patch != HR2DI_NOBODY)
      sees[p->part[k].patch] |= p->part[k].side == HR2DI_HIDDEN || looked_from[p->part[k].side];
}

/* Whether what is in the way of something is in its way here. */
static int shades(const hr2d_scene *scene) {
  return scene->effect[HR2D_EFFECT_OCCLUSION].on ||
         !scene->effect[HR2D_EFFECT_OCCLUSION].called_for;
}

hr2d_status hr2di_seen_backs(const hr2d_scene *scene, const hr2d_allocator *alloc,
                             unsigned char **sees, hr2di_watch *watch) {
  int any;
  *sees = NULL;
  hr2d_status status = hr2di_side_parts_find_backs(scene, &any, watch);
  if (status || !any) return status;
  unsigned char *looked_from =
      hr2di_alloc_zero(alloc, scene->plane.triangulation.edges + 1, 2 * sizeof *looked_from);
  *sees = hr2di_alloc(alloc, scene->patches, sizeof **sees);
  status = looked_from && *sees ? HR2D_OK : HR2D_ENOMEM;
  if (!status && !shades(scene)) {
    memset(*sees, 1, scene->patches); /* backs are seen through walls */
  } else if (!status) {
    status = look_from_backs(scene, alloc, looked_from, watch);
    if (!status) status = hr2di_watch_work(watch, (scene->patches + scene->parts.parts) / 8);
    if (!status) pass_on(&scene->parts, looked_from, scene->patches, *sees);
  }
  hr2di_alloc_free(alloc, looked_from);
  if (!status) return HR2D_OK;
  hr2di_alloc_free(alloc, *sees);
  *sees = NULL;
  return status;
}
