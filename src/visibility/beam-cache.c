/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beams from a patch find the same line classes in the same order each time, and so a trace
   that is kept gives the same bits as one that walks.  Each pair of patches is asked for from
   the one with the lower number: from the other one only that they see each other is kept. */
#include "visibility/beam-cache.h"

#include <string.h>

#include "base/alloc.h"

/* Of `classes` line classes and their points, and of `vertices` vertices, which lie behind
   it; beams entered `steps` triangles. */
struct hr2di_cached_beams {
  size_t classes, vertices;
  uint64_t steps;
  const hr2d_point *point;
  const hr2di_cached_line_class *line_class;
  const uint32_t *vertex;
};

/* Line classes between two declarations of work. */
enum { BATCH = 512 };

static void find_highest(hr2di_beam_cache *beam_cache, const hr2di_side_parts *p) {
  for (size_t k = 0; k < p->parts; k++) {
    const hr2di_side_part *part = &p->part[k];
    if (part->patch == HR2DI_NOBODY || part->side == HR2DI_HIDDEN) continue;
    uint32_t *highest = &beam_cache->highest[part->side];
    if (part->patch > *highest) *highest = part->patch;
  }
}

hr2d_status hr2di_beam_cache_init(hr2di_beam_cache *beam_cache, const hr2d_scene *scene,
                                  uint64_t bytes) {
  const hr2d_allocator *alloc = &scene->alloc;
  *beam_cache = (hr2di_beam_cache){.alloc = *alloc,
                                   .patches = scene->patches,
                                   .max_bytes = (size_t)(bytes / (scene->patches + 1))};
  beam_cache->of = hr2di_alloc_zero(alloc, scene->patches, sizeof *beam_cache->of);
  beam_cache->highest = hr2di_alloc_zero(alloc, scene->plane.triangulation.edges,
                                         2 * sizeof *beam_cache->highest);
  if (!beam_cache->of || !beam_cache->highest) return HR2D_ENOMEM;
  find_highest(beam_cache, &scene->parts);
  return HR2D_OK;
}

void hr2di_beam_cache_clear(hr2di_beam_cache *beam_cache) {
  for (size_t k = 0; beam_cache->of && k < beam_cache->patches; k++)
    hr2di_alloc_free(&beam_cache->alloc, atomic_load(&beam_cache->of[k].beams));
  hr2di_alloc_free(&beam_cache->alloc, beam_cache->of);
  hr2di_alloc_free(&beam_cache->alloc, beam_cache->highest);
  *beam_cache = (hr2di_beam_cache){0};
}

static size_t bytes_of(const hr2di_beam_tracer *l) {
  return sizeof(hr2di_cached_beams) + l->points * sizeof *l->point +
         l->classes * sizeof *l->line_class + l->vertices * sizeof *l->vertex;
}

/* Notes a line class for the trace that is to be kept. */
static hr2d_status note(hr2di_beam_tracer *l, const hr2di_line_class *s, hr2di_wall_side to) {
  const hr2d_allocator *alloc = &l->walk.alloc;
  const int bare = l->beam_cache->highest[to] < l->patch;
  const size_t lefts = bare ? 0 : s->lefts, rights = bare ? 0 : s->rights;
  if (hr2di_alloc_reserve(alloc, &l->line_class, &l->class_room, l->classes + 1,
                          sizeof *l->line_class) ||
      hr2di_alloc_reserve(alloc, &l->point, &l->point_room, l->points + lefts + rights,
                          sizeof *l->point))
    return HR2D_ENOMEM;
  l->line_class[l->classes++] =
      (hr2di_cached_line_class){l->from, to, (uint32_t)lefts, (uint32_t)rights, s->ends};
  if (!bare) {
    memcpy(l->point + l->points, s->left, lefts * sizeof *s->left);
    memcpy(l->point + l->points + lefts, s->right, rights * sizeof *s->right);
    l->points += lefts + rights;
  }
  l->keeps = bytes_of(l) <= l->beam_cache->max_bytes;
  return HR2D_OK;
}

static hr2d_status take(void *ctx, const hr2di_line_class *s, hr2di_wall_side to) {
  hr2di_beam_tracer *l = ctx;
  const hr2d_status status = l->keeps ? note(l, s, to) : HR2D_OK;
  return status ? status : l->take(l->ctx, s, l->from, to);
}

/* A vertex for which there is no memory costs the trace, and not the call. */
static void see(void *ctx, uint32_t vertex) {
  hr2di_beam_tracer *l = ctx;
  if (l->see) l->see(l->ctx, vertex);
  if (!l->keeps) return;
  l->keeps = !hr2di_alloc_reserve(&l->walk.alloc, &l->vertex, &l->vertex_room, l->vertices + 1,
                                  sizeof *l->vertex);
  if (l->keeps) l->vertex[l->vertices++] = vertex;
}

hr2di_beam_tracer hr2di_beam_tracer_make(const hr2d_scene *scene, hr2di_beam_cache *beam_cache,
                                         const hr2d_allocator *alloc, hr2di_watch *watch) {
  return (hr2di_beam_tracer){.scene = scene,
                             .beam_cache = beam_cache,
                             .walk = {.in = &scene->plane.triangulation,
                                      .wanted = scene->parts.wanted,
                                      .take = take,
                                      .alloc = *alloc,
                                      .watch = watch}};
}

void hr2di_beam_tracer_clear(hr2di_beam_tracer *l) {
  const hr2d_allocator *alloc = &l->walk.alloc;
  hr2di_walk_clear(&l->walk);
  hr2di_alloc_free(alloc, l->line_class);
  hr2di_alloc_free(alloc, l->point);
  hr2di_alloc_free(alloc, l->vertex);
}

/* Keeps what was noted, unless another thread has kept its own. */
static hr2d_status keep(hr2di_beam_tracer *l, uint64_t steps) {
  hr2di_beam_cache *beam_cache = l->beam_cache;
  hr2di_cached_beams *beams = hr2di_alloc(&beam_cache->alloc, bytes_of(l), 1), *none = NULL;
  if (!beams) return HR2D_ENOMEM;
  hr2d_point *point = (hr2d_point *)(beams + 1);
  hr2di_cached_line_class *line_class = (hr2di_cached_line_class *)(point + l->points);
  uint32_t *vertex = (uint32_t *)(line_class + l->classes);
  if (l->points > 0) memcpy(point, l->point, l->points * sizeof *point);
  if (l->classes > 0) memcpy(line_class, l->line_class, l->classes * sizeof *line_class);
  if (l->vertices > 0) memcpy(vertex, l->vertex, l->vertices * sizeof *vertex);
  *beams = (hr2di_cached_beams){l->classes, l->vertices, steps, point, line_class, vertex};
  if (!atomic_compare_exchange_strong(&beam_cache->of[l->patch].beams, &none, beams))
    hr2di_alloc_free(&beam_cache->alloc, beams);
  return HR2D_OK;
}

static hr2d_status walk(hr2di_beam_tracer *l) {
  const hr2di_side_parts *p = &l->scene->parts;
  const hr2di_parts of = p->of_patch[l->patch];
  hr2d_status status = HR2D_OK;
  const uint64_t before = l->walk.steps;
  l->classes = l->points = l->vertices = 0;
  l->keeps = l->beam_cache && !atomic_load(&l->beam_cache->of[l->patch].beams);
  l->walk.ctx = l;
  l->walk.see = l->see || l->keeps ? see : NULL;
  for (uint32_t k = of.first; k < of.last && !status; k++) {
    l->from = p->part[k].side;
    if (l->from != HR2DI_HIDDEN) status = hr2di_walk_from(&l->walk, l->from, &p->part[k].at);
  }
  l->steps += l->walk.steps - before;
  return status || !l->keeps || bytes_of(l) > l->beam_cache->max_bytes
             ? status
             : keep(l, l->walk.steps - before);
}

static hr2d_status replay(hr2di_beam_tracer *l, const hr2di_cached_beams *beams) {
  const hr2d_point *point = beams->point;
  hr2d_status status = hr2di_watch_work(l->walk.watch, 1 + beams->vertices / 64);
  l->steps += beams->steps;
  for (size_t k = 0; k < beams->vertices && l->see; k++) l->see(l->ctx, beams->vertex[k]);
  for (size_t k = 0; k < beams->classes && !status; k++) {
    const hr2di_cached_line_class *kept = &beams->line_class[k];
    const size_t points = (size_t)kept->lefts + kept->rights;
    const hr2di_line_class s = {point, point + kept->lefts, kept->lefts, kept->rights,
                                kept->ends};
    point += points;
    if (k % BATCH == 0) status = hr2di_watch_work(l->walk.watch, BATCH / 4);
    if (!status) status = l->take(l->ctx, points > 0 ? &s : NULL, kept->from, kept->to);
  }
  return status;
}

hr2d_status hr2di_beam_tracer_trace(hr2di_beam_tracer *l, uint32_t patch, int later) {
  const hr2di_cached_beams *beams =
      l->beam_cache && later ? atomic_load(&l->beam_cache->of[patch].beams) : NULL;
  l->patch = patch;
  return beams ? replay(l, beams) : walk(l);
}
