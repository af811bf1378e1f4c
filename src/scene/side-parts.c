/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts the patches of a run at the vertices of the run's wall. */
#include "scene/side-parts.h"

#include <math.h>

#include "base/alloc.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"
#include "scene/side-layers.h"

/* A vertex so near to the end of a patch is that end: the triangulation moves ends of walls by
   at most 4 units in the last place of scaled coordinates, and by less where a wall is short.
 */
static double nearness(double wall, double patch) {
  return fmin(fmin(HR2DI_PART_ROUNDING, 0x1p-20 * wall), patch / 4);
}

typedef struct cutter {
  hr2di_side_parts *made;
  const hr2d_scene *scene;
  hr2d_segment along; /* the wall, in the direction of the run */
  double length;      /* of the wall */
  uint32_t place;     /* the first patch that is not done */
  uint32_t last;
  size_t room; /* for parts */
} cutter;

/* Where a point lies in the direction of the run. */
static double at(const cutter *c, hr2d_point p) {
  return hr2di_point_along(c->along, p);
}

static void add(cutter *c, hr2di_wall_side side, hr2d_point a, hr2d_point b, uint32_t patch) {
  hr2di_parts *of = patch == HR2DI_NOBODY ? NULL : &c->made->of_patch[patch];
  if (of && of->first == of->last) of->first = (uint32_t)c->made->parts;
  if (of) of->last = (uint32_t)c->made->parts + 1;
  c->made->part[c->made->parts++] = (hr2di_side_part){{a, b}, patch, c->place, side};
}

/* The patches along one side, and what is between them. */
static void cut_side(cutter *c, hr2di_wall_side side, hr2d_segment s) {
  const double start = at(c, s.a), end = at(c, s.b);
  const uint32_t first = (uint32_t)c->made->parts;
  int somebody = 0;
  hr2d_point done = s.a;
  while (c->place < c->last) {
    const uint32_t number = c->scene->runs.patch[c->place];
    const hr2d_segment patch = c->scene->patch[number].scaled;
    const double from = at(c, patch.a), to = at(c, patch.b);
    const double near = nearness(c->length, to - from);
    if (from >= end - near) break;
    if (to > start + near) {
      if (from > at(c, done) + near) add(c, side, done, patch.a, HR2DI_NOBODY);
      const int ends = to <= end + near;
      done = ends ? patch.b : s.b;
      add(c, side, from >= start - near ? patch.a : s.a, done, number);
      somebody = 1;
      if (!ends) break;
    }
    c->place++;
  }
  if (somebody && at(c, done) < end - nearness(c->length, end - start))
    add(c, side, done, s.b, HR2DI_NOBODY);
  if (!somebody) return;
  c->made->of_side[side].parts = (hr2di_parts){first, (uint32_t)c->made->parts};
  c->made->wanted[side] = 1;
}

/* A patch is cut at vertices of its wall, and each patch and each edge has at most one stretch
   without patches before or behind it. */
static hr2d_status cut_run(cutter *c, size_t run) {
  const hr2di_wall_pieces *pieces = &c->scene->plane.pieces;
  const hr2di_triangulation *t = &c->scene->plane.triangulation;
  const hr2di_run r = c->scene->runs.run[run];
  const uint32_t patch = c->scene->runs.patch[r.first],
                 wall = c->scene->walls.of_segment[patch];
  const hr2d_segment s = c->scene->patch[patch].scaled, w = c->scene->walls.wall[wall].at;
  const uint32_t back = hr2di_point_along(w, s.a) > hr2di_point_along(w, s.b);
  c->along = back ? (hr2d_segment){w.b, w.a} : w;
  c->length = hypot(w.b.x - w.a.x, w.b.y - w.a.y);
  c->place = r.first;
  c->last = r.last;
  const uint32_t first = t->edge_of[pieces->of_wall[wall]];
  const uint32_t edges = t->edge_of[pieces->of_wall[wall + 1]] - first;
  const uint32_t start = (uint32_t)c->made->parts;
  const size_t needed = c->made->parts + 2 * ((size_t)(r.last - r.first) + edges);
  if (needed > UINT32_MAX / 2 || hr2di_alloc_reserve(&c->made->alloc, &c->made->part, &c->room,
                                                     needed, sizeof *c->made->part))
    return HR2D_ENOMEM;
  for (uint32_t k = 0; k < edges; k++) {
    const hr2di_wall_side side = 2 * (first + (back ? edges - 1 - k : k)) + back;
    c->made->of_side[side].wall = c->made->of_side[side ^ 1].wall = wall;
    cut_side(c, side, hr2di_wall_side_at(t, side));
  }
  c->made->of_run[run] = (hr2di_parts){start, (uint32_t)c->made->parts};
  return HR2D_OK;
}

hr2d_status hr2di_side_parts_init(hr2di_side_parts *parts, const hr2d_scene *scene,
                                  hr2di_watch *watch) {
  const size_t sides = 2 * scene->plane.triangulation.edges;
  *parts = (hr2di_side_parts){.alloc = scene->alloc};
  parts->of_side = hr2di_alloc_zero(&scene->alloc, sides, sizeof *parts->of_side);
  parts->of_run = hr2di_alloc(&scene->alloc, scene->runs.runs, sizeof *parts->of_run);
  parts->of_patch = hr2di_alloc_zero(&scene->alloc, scene->patches, sizeof *parts->of_patch);
  parts->wanted = hr2di_alloc_zero(&scene->alloc, sides, sizeof *parts->wanted);
  if (!parts->of_side || !parts->of_run || !parts->of_patch || !parts->wanted)
    return HR2D_ENOMEM;
  cutter c = {.made = parts, .scene = scene};
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < scene->runs.runs && !status; k++) {
    status =
        hr2di_watch_work(watch, 1 + (scene->runs.run[k].last - scene->runs.run[k].first) / 4);
    if (!status) status = cut_run(&c, k);
  }
  return status ? status
                : hr2di_side_layers_settle(parts, scene, &scene->plane.triangulation, watch);
}

void hr2di_side_parts_clear(hr2di_side_parts *parts) {
  hr2di_alloc_free(&parts->alloc, parts->part);
  hr2di_alloc_free(&parts->alloc, parts->of_side);
  hr2di_alloc_free(&parts->alloc, parts->of_run);
  hr2di_alloc_free(&parts->alloc, parts->of_patch);
  hr2di_alloc_free(&parts->alloc, parts->wanted);
  hr2di_alloc_free(&parts->alloc, parts->contact);
}

uint32_t hr2di_side_parts_find(const hr2di_side_parts *parts, hr2di_parts among,
                               hr2di_side_parts_left_fn is_on_left, const void *border) {
  uint32_t low = among.first, high = among.last - 1;
  while (low < high) {
    const uint32_t middle = low + (high - low) / 2;
    if (is_on_left(border, parts->part[middle].at.b))
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

unsigned hr2di_side_kind(const hr2di_side_parts *p, hr2di_wall_side side) {
  const hr2di_parts parts = p->of_side[side].parts;
  if (!p->wanted[side]) return HR2DI_HAS_BACK;
  for (uint32_t k = parts.first; k < parts.last; k++)
    if (p->part[k].patch == HR2DI_NOBODY) return HR2DI_HAS_FRONT | HR2DI_HAS_BACK;
  return HR2DI_HAS_FRONT;
}

/* Of walls that share an edge, triangles know one. */
static int is_seen(const hr2di_triangulation *t, hr2di_wall_side side) {
  const int32_t h = t->edge[side >> 1].half_edge[side & 1];
  return (hr2di_wall_side)~t->triangle[h >> 2].across[h & 3] == side;
}

hr2d_status hr2di_side_parts_find_backs(const hr2d_scene *scene, int *found,
                                        hr2di_watch *watch) {
  const hr2di_side_parts *p = &scene->parts;
  const hr2di_triangulation *t = &scene->plane.triangulation;
  hr2d_status status = hr2di_watch_work(watch, (scene->patches + p->parts) / 8);
  *found = 0;
  for (size_t k = 0; k < scene->patches && !*found; k++)
    *found = p->of_patch[k].first == p->of_patch[k].last;
  for (size_t k = 0; k < p->parts && !*found; k++) *found = p->part[k].side == HR2DI_HIDDEN;
  for (hr2di_wall_side s = 0; s < 2 * t->edges && !*found && !status; s++) {
    const hr2di_parts of = p->of_side[s].parts;
    status = hr2di_watch_work(watch, 1 + (of.last - of.first) / 8);
    *found = is_seen(t, s) && hr2di_side_kind(p, s) & HR2DI_HAS_BACK;
  }
  return status;
}

size_t hr2di_side_parts_contact(const hr2di_side_parts *p, uint32_t part) {
  size_t low = 0, high = p->contacts;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (p->contact[middle].part < part)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}
