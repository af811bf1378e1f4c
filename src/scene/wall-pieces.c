/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts walls at ends of their patches that lie on the inside of other walls. */
#include "scene/wall-pieces.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* Some units in the last place of scaled coordinates.  No piece is that short: an end so near
   to another wall is joined to it by the triangulation. */
#define NEAR 0x1p-48

typedef struct cut {
  hr2d_point at;
  uint32_t wall;
} cut;

static int by_wall(const void *left, const void *right) {
  const cut *l = left, *r = right;
  if (l->wall != r->wall) return l->wall < r->wall ? -1 : 1;
  if (l->at.x != r->at.x) return l->at.x < r->at.x ? -1 : 1;
  return (l->at.y > r->at.y) - (l->at.y < r->at.y);
}

/* Ends that two patches share are found twice. */
static hr2d_status find_cuts(const hr2d_scene *scene, cut **cuts, size_t *count,
                             hr2di_watch *watch) {
  const hr2di_walls *walls = &scene->walls;
  size_t room = 0;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < scene->patches && !status; k++) {
    const uint32_t wall = walls->of_segment[k];
    const hr2d_segment s = scene->patch[k].scaled, w = walls->wall[wall].at;
    const hr2d_point end[] = {s.a, s.b};
    for (int e = 0; e < 2 && !status; e++) {
      if (hr2di_point_same(end[e], w.a) || hr2di_point_same(end[e], w.b)) continue;
      status = hr2di_watch_work(watch, 8);
      if (hr2di_walls_host(walls, end[e], wall) == HR2DI_NO_WALL) continue;
      if (hr2di_alloc_reserve(&scene->alloc, cuts, &room, *count + 1, sizeof **cuts))
        return HR2D_ENOMEM;
      (*cuts)[(*count)++] = (cut){end[e], wall};
    }
  }
  return status ? status : hr2di_sort(*cuts, *count, sizeof **cuts, by_wall, watch);
}

static int is_near(hr2d_point p, hr2d_point q, double distance) {
  return fabs(p.x - q.x) <= distance && fabs(p.y - q.y) <= distance;
}

/* The lesser end of a wall is its first, so that cuts are in the order of the wall. */
static void make_pieces(hr2di_wall_pieces *p, const hr2di_walls *walls, const cut *cuts,
                        size_t count) {
  size_t next = 0;
  for (uint32_t w = 0; w < walls->walls; w++) {
    const hr2d_segment wall = walls->wall[w].at;
    hr2d_segment rest = wall;
    p->of_wall[w] = (uint32_t)p->pieces;
    for (; next < count && cuts[next].wall == w; next++) {
      const hr2d_point at = cuts[next].at;
      const double min = fmin(NEAR, hypot(wall.b.x - wall.a.x, wall.b.y - wall.a.y) / 8);
      if (is_near(at, rest.a, min) || is_near(at, wall.b, min)) continue;
      p->piece[p->pieces++] = (hr2d_segment){rest.a, at};
      rest.a = at;
    }
    p->piece[p->pieces++] = rest;
  }
  p->of_wall[walls->walls] = (uint32_t)p->pieces;
}

hr2d_status hr2di_wall_pieces_init(hr2di_wall_pieces *p, const hr2d_scene *scene,
                                   hr2di_watch *watch) {
  const hr2di_walls *walls = &scene->walls;
  cut *cuts = NULL;
  size_t count = 0;
  *p = (hr2di_wall_pieces){.alloc = scene->alloc};
  hr2d_status status = find_cuts(scene, &cuts, &count, watch);
  if (!status) {
    p->walls = walls->walls;
    p->room = walls->walls + count;
    p->piece = hr2di_alloc(&p->alloc, p->room, sizeof *p->piece);
    p->of_wall = hr2di_alloc(&p->alloc, walls->walls + 1, sizeof *p->of_wall);
    if (!p->piece || !p->of_wall) status = HR2D_ENOMEM;
  }
  if (!status) status = hr2di_watch_work(watch, (walls->walls + count) / 8);
  if (!status) make_pieces(p, walls, cuts, count);
  hr2di_alloc_free(&p->alloc, cuts);
  return status;
}

hr2d_status hr2di_wall_pieces_cut(hr2di_wall_pieces *p, size_t piece, hr2d_point at) {
  if (hr2di_alloc_reserve(&p->alloc, &p->piece, &p->room, p->pieces + 1, sizeof *p->piece))
    return HR2D_ENOMEM;
  memmove(p->piece + piece + 1, p->piece + piece, (p->pieces - piece) * sizeof *p->piece);
  p->pieces++;
  p->piece[piece].b = p->piece[piece + 1].a = at;
  for (size_t w = 0; w <= p->walls; w++) p->of_wall[w] += p->of_wall[w] > piece;
  return HR2D_OK;
}

void hr2di_wall_pieces_clear(hr2di_wall_pieces *p) {
  hr2di_alloc_free(&p->alloc, p->piece);
  hr2di_alloc_free(&p->alloc, p->of_wall);
}
