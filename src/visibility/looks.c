/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams from a patch find the same sights in the same order each time, and so a look that is
   kept gives the same bits as one that walks.  Each pair of patches is asked for from the one
   with the lower number: from the other one only that they see each other is kept. */
#include "visibility/looks.h"

#include <string.h>

#include "base/alloc.h"

/* Of `sights` sights and their points, and of `vertices` vertices, which lie behind it; beams
   entered `steps` triangles. */
struct hr2di_look {
  size_t sights, vertices;
  uint64_t steps;
  const hr2d_point *point;
  const hr2di_look_sight *sight;
  const uint32_t *vertex;
};

/* Sights between two declarations of work. */
enum { BATCH = 512 };

static void find_highest(hr2di_looks *looks, const hr2di_side_parts *p) {
  for (size_t k = 0; k < p->parts; k++) {
    const hr2di_side_part *part = &p->part[k];
    if (part->patch == HR2DI_NOBODY || part->side == HR2DI_HIDDEN) continue;
    uint32_t *highest = &looks->highest[part->side];
    if (part->patch > *highest) *highest = part->patch;
  }
}

hr2d_status hr2di_looks_init(hr2di_looks *looks, const hr2d_scene *scene, uint64_t bytes) {
  const hr2d_allocator *alloc = &scene->alloc;
  *looks = (hr2di_looks){.alloc = *alloc,
                         .patches = scene->patches,
                         .most_bytes = (size_t)(bytes / (scene->patches + 1))};
  looks->of = hr2di_alloc_zero(alloc, scene->patches, sizeof *looks->of);
  looks->highest =
      hr2di_alloc_zero(alloc, scene->plane.triangulation.edges, 2 * sizeof *looks->highest);
  if (!looks->of || !looks->highest) return HR2D_ENOMEM;
  find_highest(looks, &scene->parts);
  return HR2D_OK;
}

void hr2di_looks_clear(hr2di_looks *looks) {
  for (size_t k = 0; looks->of && k < looks->patches; k++)
    hr2di_alloc_free(&looks->alloc, atomic_load(&looks->of[k].look));
  hr2di_alloc_free(&looks->alloc, looks->of);
  hr2di_alloc_free(&looks->alloc, looks->highest);
  *looks = (hr2di_looks){0};
}

static size_t bytes_of(const hr2di_looker *l) {
  return sizeof(hr2di_look) + l->points * sizeof *l->point + l->sights * sizeof *l->sight +
         l->vertices * sizeof *l->vertex;
}

/* Notes a sight for the look that is to be kept. */
static hr2d_status note(hr2di_looker *l, const hr2di_sight *s, hr2di_wall_side to) {
  const hr2d_allocator *alloc = &l->walk.alloc;
  const int bare = l->looks->highest[to] < l->patch;
  const size_t lefts = bare ? 0 : s->lefts, rights = bare ? 0 : s->rights;
  if (hr2di_alloc_reserve(alloc, &l->sight, &l->sight_room, l->sights + 1, sizeof *l->sight) ||
      hr2di_alloc_reserve(alloc, &l->point, &l->point_room, l->points + lefts + rights,
                          sizeof *l->point))
    return HR2D_ENOMEM;
  l->sight[l->sights++] =
      (hr2di_look_sight){l->from, to, (uint32_t)lefts, (uint32_t)rights, s->ends};
  if (!bare) {
    memcpy(l->point + l->points, s->left, lefts * sizeof *s->left);
    memcpy(l->point + l->points + lefts, s->right, rights * sizeof *s->right);
    l->points += lefts + rights;
  }
  l->keeps = bytes_of(l) <= l->looks->most_bytes;
  return HR2D_OK;
}

static hr2d_status take(void *ctx, const hr2di_sight *s, hr2di_wall_side to) {
  hr2di_looker *l = ctx;
  const hr2d_status status = l->keeps ? note(l, s, to) : HR2D_OK;
  return status ? status : l->take(l->ctx, s, l->from, to);
}

/* A vertex for which there is no memory costs the look, and not the call. */
static void see(void *ctx, uint32_t vertex) {
  hr2di_looker *l = ctx;
  if (l->see) l->see(l->ctx, vertex);
  if (!l->keeps) return;
  l->keeps = !hr2di_alloc_reserve(&l->walk.alloc, &l->vertex, &l->vertex_room, l->vertices + 1,
                                  sizeof *l->vertex);
  if (l->keeps) l->vertex[l->vertices++] = vertex;
}

hr2di_looker hr2di_looker_make(const hr2d_scene *scene, hr2di_looks *looks,
                               const hr2d_allocator *alloc, hr2di_watch *watch) {
  return (hr2di_looker){.scene = scene,
                        .looks = looks,
                        .walk = {.in = &scene->plane.triangulation,
                                 .wanted = scene->parts.wanted,
                                 .take = take,
                                 .alloc = *alloc,
                                 .watch = watch}};
}

void hr2di_looker_clear(hr2di_looker *l) {
  const hr2d_allocator *alloc = &l->walk.alloc;
  hr2di_walk_clear(&l->walk);
  hr2di_alloc_free(alloc, l->sight);
  hr2di_alloc_free(alloc, l->point);
  hr2di_alloc_free(alloc, l->vertex);
}

/* Keeps what was noted, unless another thread has kept its own. */
static hr2d_status keep(hr2di_looker *l, uint64_t steps) {
  hr2di_looks *looks = l->looks;
  hr2di_look *look = hr2di_alloc(&looks->alloc, bytes_of(l), 1), *none = NULL;
  if (!look) return HR2D_ENOMEM;
  hr2d_point *point = (hr2d_point *)(look + 1);
  hr2di_look_sight *sight = (hr2di_look_sight *)(point + l->points);
  uint32_t *vertex = (uint32_t *)(sight + l->sights);
  if (l->points > 0) memcpy(point, l->point, l->points * sizeof *point);
  if (l->sights > 0) memcpy(sight, l->sight, l->sights * sizeof *sight);
  if (l->vertices > 0) memcpy(vertex, l->vertex, l->vertices * sizeof *vertex);
  *look = (hr2di_look){l->sights, l->vertices, steps, point, sight, vertex};
  if (!atomic_compare_exchange_strong(&looks->of[l->patch].look, &none, look))
    hr2di_alloc_free(&looks->alloc, look);
  return HR2D_OK;
}

static hr2d_status walk(hr2di_looker *l) {
  const hr2di_side_parts *p = &l->scene->parts;
  const hr2di_parts of = p->of_patch[l->patch];
  hr2d_status status = HR2D_OK;
  const uint64_t before = l->walk.steps;
  l->sights = l->points = l->vertices = 0;
  l->keeps = l->looks && !atomic_load(&l->looks->of[l->patch].look);
  l->walk.ctx = l;
  l->walk.see = l->see || l->keeps ? see : NULL;
  for (uint32_t k = of.first; k < of.last && !status; k++) {
    l->from = p->part[k].side;
    if (l->from != HR2DI_HIDDEN) status = hr2di_walk_from(&l->walk, l->from, &p->part[k].at);
  }
  l->steps += l->walk.steps - before;
  return status || !l->keeps || bytes_of(l) > l->looks->most_bytes
             ? status
             : keep(l, l->walk.steps - before);
}

static hr2d_status replay(hr2di_looker *l, const hr2di_look *look) {
  const hr2d_point *point = look->point;
  hr2d_status status = hr2di_watch_work(l->walk.watch, 1 + look->vertices / 64);
  l->steps += look->steps;
  for (size_t k = 0; k < look->vertices && l->see; k++) l->see(l->ctx, look->vertex[k]);
  for (size_t k = 0; k < look->sights && !status; k++) {
    const hr2di_look_sight *kept = &look->sight[k];
    const size_t points = (size_t)kept->lefts + kept->rights;
    const hr2di_sight s = {point, point + kept->lefts, kept->lefts, kept->rights, kept->ends};
    point += points;
    if (k % BATCH == 0) status = hr2di_watch_work(l->walk.watch, BATCH / 4);
    if (!status) status = l->take(l->ctx, points > 0 ? &s : NULL, kept->from, kept->to);
  }
  return status;
}

hr2d_status hr2di_looker_look(hr2di_looker *l, uint32_t patch, int later) {
  const hr2di_look *look = l->looks && later ? atomic_load(&l->looks->of[patch].look) : NULL;
  l->patch = patch;
  return look ? replay(l, look) : walk(l);
}
