/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams leave the backs of walls, most of which are inside of things and see nothing but each
   other; where they end, somebody sees a back. */
#include "visibility/back-visibility.h"

#include <string.h>

#include "base/alloc.h"
#include "base/team.h"
#include "scene/scene-impl.h"

/* A thread: what it finds is united with what others find, so that no order matters. */
typedef struct observer {
  hr2di_walk walk;
  unsigned char *looked_from; /* per side of a wall */
  hr2di_watch own;            /* but the calling thread has another */
  hr2d_status status;
} observer;

typedef struct search {
  const hr2d_scene *scene;
  const hr2d_allocator *alloc;
  size_t sides, observers;
  observer *observer;
  hr2di_watch *watch; /* of the calling thread */
} search;

/* Sides of a task, and threads at most. */
enum { TASK = 256, MOST_LOOKERS = 16 };

static hr2d_status mark(void *ctx, const hr2di_line_class *line_class, hr2di_wall_side side) {
  unsigned char *looked_from = ctx;
  (void)line_class;
  looked_from[side] = 1;
  return HR2D_OK;
}

static void view_from_some(void *ctx, size_t worker, size_t task) {
  const search *all = ctx;
  const hr2di_side_parts *p = &all->scene->parts;
  observer *by = &all->observer[worker];
  const size_t from = task * TASK, to = all->sides - from > TASK ? from + TASK : all->sides;
  for (size_t side = from; side < to && !by->status; side++) {
    const hr2di_wall_side s = (hr2di_wall_side)side;
    const hr2di_parts of = p->of_side[s].parts;
    by->status = hr2di_watch_work(by->walk.watch, 1 + (of.last - of.first) / 8);
    if (!by->status && hr2di_side_kind(p, s) & HR2DI_HAS_BACK)
      by->status = hr2di_walk_from(&by->walk, s, NULL);
  }
}

static hr2d_status hire(search *all, size_t threads) {
  const size_t max = all->sides / TASK + 1;
  size_t count = threads < MOST_LOOKERS ? threads : MOST_LOOKERS;
  if (count > max) count = max;
  all->observer = hr2di_alloc_zero(all->alloc, count, sizeof *all->observer);
  for (; all->observer && all->observers < count; all->observers++) {
    observer *by = &all->observer[all->observers];
    by->looked_from = hr2di_alloc_zero(all->alloc, all->sides + 1, sizeof *by->looked_from);
    if (!by->looked_from) return HR2D_ENOMEM;
    hr2di_watch_follow(&by->own, all->watch);
    by->walk = (hr2di_walk){.in = &all->scene->plane.triangulation,
                            .wanted = all->scene->parts.wanted,
                            .take = mark,
                            .ctx = by->looked_from,
                            .alloc = *all->alloc,
                            .watch = all->observers > 0 ? &by->own : all->watch};
  }
  return all->observer ? HR2D_OK : HR2D_ENOMEM;
}

static void dismiss(search *all) {
  for (size_t k = 0; k < all->observers; k++) {
    hr2di_walk_clear(&all->observer[k].walk);
    hr2di_alloc_free(all->alloc, all->observer[k].looked_from);
  }
  hr2di_alloc_free(all->alloc, all->observer);
}

/* Leaves what all have found with the first one. */
static hr2d_status view_from_backs(search *all) {
  hr2d_status status = HR2D_OK;
  hr2di_team_run(all->observers, (all->sides + TASK - 1) / TASK, view_from_some, all,
                 all->watch);
  for (size_t k = 0; k < all->observers && !status; k++) status = all->observer[k].status;
  for (size_t k = 1; k < all->observers && !status; k++) {
    for (size_t s = 0; s < all->sides; s++)
      all->observer[0].looked_from[s] |= all->observer[k].looked_from[s];
    status = hr2di_watch_work(all->watch, all->sides / 64);
  }
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

static hr2d_status find(search *all, size_t threads, unsigned char *sees) {
  const hr2d_scene *scene = all->scene;
  if (!shades(scene)) {
    memset(sees, 1, scene->patches); /* backs are seen through walls */
    return HR2D_OK;
  }
  hr2d_status status = hire(all, threads);
  if (!status) status = view_from_backs(all);
  if (!status) status = hr2di_watch_work(all->watch, (scene->patches + scene->parts.parts) / 8);
  if (!status) pass_on(&scene->parts, all->observer[0].looked_from, scene->patches, sees);
  dismiss(all);
  return status;
}

hr2d_status hr2di_back_visibility(const hr2d_scene *scene, const hr2d_allocator *alloc,
                                  unsigned threads, unsigned char **sees, hr2di_watch *watch) {
  int any;
  *sees = NULL;
  hr2d_status status = hr2di_side_parts_find_backs(scene, &any, watch);
  if (status || !any) return status;
  search all = {.scene = scene,
                .alloc = alloc,
                .sides = 2 * scene->plane.triangulation.edges,
                .watch = watch};
  *sees = hr2di_alloc(alloc, scene->patches, sizeof **sees);
  status = *sees ? find(&all, hr2di_team_threads(threads), *sees) : HR2D_ENOMEM;
  if (!status) return HR2D_OK;
  hr2di_alloc_free(alloc, *sees);
  *sees = NULL;
  return status;
}
