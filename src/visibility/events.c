/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Discontinuity meshing (Lischinski, Tampieri, Greenberg 1992) in the plane: finds every line
   through two vertices on which light passes between them, and on beyond one of them.  A foot,
   where a wall ends on a patch, is an event, too: light of one side does not reach the other
   side. */
#include "visibility/events.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/orient-sign.h"
#include "geometry/predicates.h"
#include "occlusion/wall-tree.h"
#include "scene/scene-impl.h"
#include "visibility/events-impl.h"

/* Events so near to one another or to an end, as fractions of the patch, are one. */
#define ALIKE 1e-12

typedef struct candidate {
  hr2di_event event;
  uint32_t via;
} candidate;

typedef struct finder {
  const hr2d_scene *scene;
  hr2d_allocator alloc;
  size_t max;
  hr2di_watch *watch;
  hr2di_vertices vertices;
  hr2di_origin *origin; /* of one generation */
  size_t origins, origin_capacity;
  candidate *found;
  size_t count, capacity;
} finder;

static int by_place(const void *left, const void *right) {
  const candidate *l = left, *r = right;
  if (l->event.patch != r->event.patch) return l->event.patch < r->event.patch ? -1 : 1;
  if (l->event.at != r->event.at) return l->event.at < r->event.at ? -1 : 1;
  if (l->event.generation != r->event.generation)
    return l->event.generation < r->event.generation ? -1 : 1;
  return (l->via > r->via) - (l->via < r->via);
}

/* Sorts, and keeps one of those alike. */
static hr2d_status settle(finder *f) {
  size_t kept = 0;
  hr2d_status status = hr2di_sort(f->found, f->count, sizeof *f->found, by_place, f->watch);
  if (!status) status = hr2di_watch_work(f->watch, f->count / 16);
  if (status) return status;
  for (size_t k = 0; k < f->count; k++) {
    const candidate c = f->found[k];
    candidate *last = kept > 0 ? &f->found[kept - 1] : NULL;
    if (!last || last->event.patch != c.event.patch || c.event.at - last->event.at >= ALIKE)
      f->found[kept++] = c;
    else if (c.event.generation < last->event.generation)
      *last = c;
  }
  f->count = kept;
  return kept > f->max ? HR2D_EMAX_ELEMENTS : HR2D_OK;
}

static hr2d_status add(finder *f, uint32_t patch, double at, unsigned generation,
                       uint32_t via) {
  if (!(at >= ALIKE && 1 - at >= ALIKE) || !hr2di_scene_lit(f->scene, patch)) return HR2D_OK;
  /* Half of them are more than there may be: some must be alike. */
  if (f->count / 2 > f->max) {
    const hr2d_status status = settle(f);
    if (status) return status;
  }
  if (hr2di_alloc_reserve(&f->alloc, &f->found, &f->capacity, f->count + 1, sizeof *f->found))
    return HR2D_ENOMEM;
  f->found[f->count++] = (candidate){{patch, at, generation}, via};
  return HR2D_OK;
}

static hr2d_status add_origin(finder *f, hr2di_origin origin) {
  if (hr2di_alloc_reserve(&f->alloc, &f->origin, &f->origin_capacity, f->origins + 1,
                          sizeof *f->origin))
    return HR2D_ENOMEM;
  f->origin[f->origins++] = origin;
  return HR2D_OK;
}

/* The sides of a wall on which another one that has p inside is seen. */
static unsigned crossed(const hr2di_vertices *t, hr2d_point p, uint32_t wall) {
  uint32_t stack[HR2DI_BOX_DEPTH] = {0}, count = 1, host;
  while ((host = hr2di_events_next_host(t, p, stack, &count)) != HR2DI_NO_WALL)
    if (host != wall) return HR2DI_EVENTS_LEFT | HR2DI_EVENTS_RIGHT;
  return 0;
}

/* Where a patch ends inside its wall there is something to see from its side only. */
static hr2d_status add_joint(finder *f, hr2d_point p, uint32_t wall, unsigned side) {
  const hr2d_segment w = f->vertices.walls->wall[wall].at;
  if (hr2di_point_same(p, w.a) || hr2di_point_same(p, w.b)) return HR2D_OK;
  const unsigned sides = side | crossed(&f->vertices, p, wall);
  return add_origin(f, (hr2di_origin){p, HR2DI_NO_VERTEX, wall, sides, HR2DI_NO_VERTEX});
}

static hr2d_status add_joints(finder *f, uint32_t wall, unsigned side) {
  const uint32_t number = f->vertices.run[2 * wall + (side == HR2DI_EVENTS_LEFT)];
  hr2d_status status = HR2D_OK;
  if (number == HR2DI_EVENTS_NO_RUN) return status;
  const hr2di_run run = f->vertices.scene->runs.run[number];
  const uint32_t *patch = f->vertices.scene->runs.patch;
  for (uint32_t k = run.first; k < run.last && !status; k++) {
    status = hr2di_watch_work(f->watch, 4);
    if (status) break;
    const hr2d_segment s = f->scene->patch[patch[k]].scaled;
    const int joined =
        k > run.first && hr2di_point_same(f->scene->patch[patch[k - 1]].scaled.b, s.a);
    if (!joined) status = add_joint(f, s.a, wall, side);
    if (!status) status = add_joint(f, s.b, wall, side);
  }
  return status;
}

/* The sides of its host, if it has one, on which walls end at a vertex. */
static unsigned sides_of(const hr2di_vertices *t, uint32_t vertex) {
  const uint32_t host = t->walls->host[vertex];
  unsigned sides = 0;
  if (host == HR2DI_NO_WALL) return HR2DI_EVENTS_LEFT | HR2DI_EVENTS_RIGHT;
  const hr2d_segment h = t->walls->wall[host].at;
  for (uint32_t k = t->first[vertex]; k < t->first[vertex + 1]; k++) {
    const hr2di_wall *w = &t->walls->wall[t->wall[k]];
    const int side = hr2di_orient_sign(h.a, h.b, w->vertex[0] == vertex ? w->at.b : w->at.a);
    sides |= side > 0 ? HR2DI_EVENTS_LEFT : HR2DI_EVENTS_RIGHT;
  }
  return sides | crossed(t, t->point[vertex], host);
}

/* All ends of patches. */
static hr2d_status add_vertices(finder *f) {
  const hr2di_vertices *t = &f->vertices;
  hr2d_status status = HR2D_OK;
  for (uint32_t v = 0; v < t->walls->vertices && !status; v++) {
    status = hr2di_watch_work(f->watch, 4 + (t->first[v + 1] - t->first[v]) / 2);
    if (!status && t->first[v] < t->first[v + 1])
      status = add_origin(f, (hr2di_origin){t->point[v], v, t->walls->host[v], sides_of(t, v),
                                            HR2DI_NO_VERTEX});
  }
  for (uint32_t w = 0; w < t->walls->walls && !status; w++) {
    status = add_joints(f, w, HR2DI_EVENTS_LEFT);
    if (!status) status = add_joints(f, w, HR2DI_EVENTS_RIGHT);
  }
  return status;
}

/* Exactly on a line along an axis. */
static hr2d_point point_on(const hr2d_scene *scene, hr2di_event e) {
  const hr2d_segment s = scene->patch[e.patch].scaled;
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y, t = e.at, u = 1 - t;
  return t < 0.5 ? (hr2d_point){s.a.x + t * dx, s.a.y + t * dy}
                 : (hr2d_point){s.b.x - u * dx, s.b.y - u * dy};
}

static int reflects(const hr2d_scene *scene, size_t patch) {
  for (size_t band = 0; band < scene->bands; band++)
    if (hr2d_scene_reflectance(scene, patch, band) > 0) return 1;
  return 0;
}

/* The events of a generation, where they show: B = E on a patch that does not reflect. */
static hr2d_status add_events(finder *f, unsigned generation) {
  const hr2di_walls *walls = f->vertices.walls;
  hr2d_status status = HR2D_OK;
  f->origins = 0;
  for (size_t k = 0; k < f->count && !status; k++) {
    const candidate c = f->found[k];
    status = hr2di_watch_work(f->watch, 1 + f->scene->bands / 32);
    if (c.event.generation != generation || !reflects(f->scene, c.event.patch)) continue;
    const hr2d_segment s = f->scene->patch[c.event.patch].scaled;
    const uint32_t host = walls->of_segment[c.event.patch];
    const hr2d_segment w = walls->wall[host].at;
    const double along = (s.b.x - s.a.x) * (w.b.x - w.a.x) + (s.b.y - s.a.y) * (w.b.y - w.a.y);
    if (status) break;
    status = add_origin(f, (hr2di_origin){point_on(f->scene, c.event), HR2DI_NO_VERTEX, host,
                                          along > 0 ? HR2DI_EVENTS_LEFT : HR2DI_EVENTS_RIGHT,
                                          c.via});
  }
  return status;
}

/* One after the other for each u, since what blocks one line blocks the next. */
static hr2d_status follow_lines(finder *f, unsigned generation) {
  const hr2di_vertices *t = &f->vertices;
  hr2d_status status = HR2D_OK;
  for (uint32_t u = 0; u < t->walls->vertices && !status; u++) {
    if (t->first[u] == t->first[u + 1] || t->walls->host[u] != HR2DI_NO_WALL) continue;
    for (size_t k = 0; k < f->origins && !status; k++) {
      const hr2di_origin *v = &f->origin[k];
      uint32_t patch;
      status = hr2di_watch_work(f->watch, 2);
      if (status || v->vertex == u || v->via == u ||
          !hr2di_origin_reaches(&f->vertices, v, u, &patch))
        continue;
      const hr2d_segment s = f->scene->patch[patch].scaled;
      status = add(f, patch, hr2di_line_crossing(v->at, t->point[u], s.a, s.b), generation, u);
    }
  }
  return status;
}

/* The fraction of s at which p, on it but for rounding, lies. */
static double fraction_of(hr2d_segment s, hr2d_point p) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  return ((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / (dx * dx + dy * dy);
}

/* A patch that ends inside another one. */
static hr2d_status add_feet_of(finder *f, uint32_t own, hr2d_point foot, hr2d_point other) {
  const hr2di_vertices *t = &f->vertices;
  uint32_t stack[HR2DI_BOX_DEPTH] = {0}, count = 1, wall, patch;
  hr2d_status status = HR2D_OK;
  while (!status && (wall = hr2di_events_next_host(t, foot, stack, &count)) != HR2DI_NO_WALL) {
    const hr2d_segment w = t->walls->wall[wall].at;
    const int side = wall == own ? 0 : hr2di_orient_sign(w.a, w.b, other);
    if (side != 0 &&
        hr2di_events_patch_across(t, wall, side > 0 ? HR2DI_EVENTS_LEFT : HR2DI_EVENTS_RIGHT,
                                  foot, other, &patch))
      status =
          add(f, patch, fraction_of(f->scene->patch[patch].scaled, foot), 1, HR2DI_NO_VERTEX);
  }
  return status;
}

static hr2d_status add_feet(finder *f) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < f->scene->patches && !status; k++) {
    const hr2d_segment s = f->scene->patch[k].scaled;
    const uint32_t wall = f->vertices.walls->of_segment[k];
    status = hr2di_watch_work(f->watch, 8);
    if (!status) status = add_feet_of(f, wall, s.a, s.b);
    if (!status) status = add_feet_of(f, wall, s.b, s.a);
  }
  return status;
}

static hr2d_status find(finder *f, unsigned generations) {
  hr2d_status status = hr2di_vertices_init(&f->vertices, f->scene, &f->alloc, f->watch);
  if (!status) status = add_vertices(f);
  if (!status) status = add_feet(f);
  for (unsigned g = 1; g <= generations && !status; g++) {
    if (g > 1) status = add_events(f, g - 1);
    if (!status && f->origins == 0) break;
    if (!status) status = follow_lines(f, g);
    if (!status) status = settle(f);
  }
  /* Rays that the watch has stopped reach nothing. */
  return status ? status : hr2di_watch_status(f->watch);
}

hr2d_status hr2di_events_init(hr2di_events *events, const hr2d_scene *scene,
                              const hr2d_allocator *alloc, unsigned generations, size_t max,
                              hr2di_watch *watch) {
  *events = (hr2di_events){.alloc = *alloc};
  if (generations == 0 || !(scene->effect[HR2D_EFFECT_OCCLUSION].called_for ||
                            scene->effect[HR2D_EFFECT_FACING].called_for ||
                            scene->effect[HR2D_EFFECT_BACKGROUND].called_for))
    return HR2D_OK;
  finder f = {.scene = scene, .alloc = *alloc, .max = max, .watch = watch};
  hr2d_status status = find(&f, generations);
  if (!status && hr2di_alloc_reserve(alloc, &events->event, &events->capacity, f.count,
                                     sizeof *events->event))
    status = HR2D_ENOMEM;
  for (size_t k = 0; k < f.count && !status; k++)
    events->event[events->count++] = f.found[k].event;
  hr2di_vertices_clear(&f.vertices);
  hr2di_alloc_free(alloc, f.origin);
  hr2di_alloc_free(alloc, f.found);
  return status;
}

void hr2di_events_clear(hr2di_events *events) {
  hr2di_alloc_free(&events->alloc, events->event);
  *events = (hr2di_events){.alloc = events->alloc};
}
