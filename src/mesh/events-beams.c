/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expansions of angles.  Signs are exact, so an origin that is a vertex sees what is there and
   nothing else.  Others are roundings away from their wall: the first triangle is the one in
   front of it, and the line of the wall is their horizon.

   A border that meets a vertex exactly passes it, and is then the line of that vertex, too. The
   triangulation bends walls at feet by roundings, so the line of a wall itself is not found by
   angles, but from its two ends. */
#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "mesh/events-impl.h"

static int32_t next(int32_t h) {
  return (h & 3) == 2 ? h - 2 : h + 1;
}

static int32_t before(int32_t h) {
  return (h & 3) == 0 ? h + 2 : h - 1;
}

static uint32_t start_of(const hr2di_event_beams *b, int32_t h) {
  return b->in->triangle[h >> 2].corner[h & 3];
}

static int32_t across(const hr2di_event_beams *b, int32_t h) {
  return b->in->triangle[h >> 2].across[h & 3];
}

static int32_t half_edge_of(const hr2di_event_beams *b, hr2di_wall_side side) {
  return b->in->edge[side >> 1].half_edge[side & 1];
}

static int is_end_of(const hr2di_event_beams *b, hr2di_wall_side side, uint32_t vertex) {
  const hr2di_wall_edge *e = &b->in->edge[side >> 1];
  return e->from == vertex || e->to == vertex;
}

/* The line from a point through another one. */
typedef struct ray {
  hr2d_point from, to;
} ray;

static int is_on_left(const void *of, hr2d_point end) {
  const ray *r = of;
  return hr2di_orient_sign(r->from, r->to, end) > 0;
}

/* The patch along a side that a ray meets strictly inside, or HR2DI_NOBODY.  The side starts on
   the right. */
static uint32_t patch_at(const hr2di_event_beams *b, hr2di_wall_side side, hr2d_point from,
                         hr2d_point to) {
  const hr2di_side_parts *parts = &b->scene->parts;
  const ray r = {from, to};
  const uint32_t found =
      hr2di_side_parts_find(parts, parts->of_side[side].parts, is_on_left, &r);
  const uint32_t patch = parts->part[found].patch;
  if (patch == HR2DI_NOBODY) return HR2DI_NOBODY;
  const hr2d_segment s = b->scene->patch[patch].scaled;
  const int inside =
      hr2di_orient_sign(from, to, s.a) < 0 && hr2di_orient_sign(from, to, s.b) > 0;
  return inside ? patch : HR2DI_NOBODY;
}

/* An angle ends at a side: if one of its borders passes the end of a wall on the way there, the
   border is the line of an event. */
static hr2d_status see(hr2di_event_beams *b, const hr2di_border *border, hr2di_wall_side side) {
  if (border->tip == HR2DI_NO_VERTEX) return HR2D_OK;
  const uint32_t u = border->behind == HR2DI_NO_VERTEX || is_end_of(b, side, border->behind)
                         ? border->tip
                         : border->behind;
  if (u == b->via || !b->free[u] || b->own_end[u] == b->number || is_end_of(b, side, u))
    return HR2D_OK;
  const hr2d_point to = b->in->at[u];
  const uint32_t patch = patch_at(b, side, b->at, to);
  if (patch == HR2DI_NOBODY) return HR2D_OK;
  const hr2d_segment s = b->scene->patch[patch].scaled;
  return b->take(b->ctx, patch, hr2di_line_crossing(b->at, to, s.a, s.b), u);
}

/* What is behind the left border is behind it for what is on its right alone. */
static hr2d_status end_at(void *ctx, int32_t what, const void *right, void *on_left) {
  hr2di_event_beams *b = ctx;
  hr2di_border *left = on_left;
  const hr2di_wall_side side = (hr2di_wall_side)~what;
  hr2d_status status = HR2D_OK;
  if (what != HR2DI_SKY && b->scene->parts.wanted[side] &&
      b->own_wall[b->wall_of[side >> 1]] != b->number) {
    status = see(b, right, side);
    if (!status) status = see(b, left, side);
  }
  left->behind = HR2DI_NO_VERTEX;
  return status;
}

static hr2di_border through(const hr2di_event_beams *b, uint32_t vertex) {
  return (hr2di_border){b->at, b->in->at[vertex], vertex, HR2DI_NO_VERTEX};
}

static int side_of(void *ctx, void *on_right, void *on_left, uint32_t vertex, void *split) {
  const hr2di_event_beams *b = ctx;
  hr2di_border *right = on_right, *left = on_left;
  const hr2d_point at = b->in->at[vertex];
  const int from_right = hr2di_orient_sign(right->from, right->to, at);
  const int from_left = hr2di_orient_sign(left->from, left->to, at);
  if (from_right > 0 && from_left < 0) {
    *(hr2di_border *)split = through(b, vertex);
    return 0;
  }
  if (from_right == 0 && b->free[vertex]) right->behind = vertex;
  if (from_left == 0 && b->free[vertex]) left->behind = vertex;
  return from_right > 0 ? 1 : -1;
}

/* Begins with the next origin. */
static void start(hr2di_event_beams *b, hr2d_point at, uint32_t via) {
  b->at = at;
  b->via = via;
  b->number++;
}

/* A line through two points of one wall is left to that wall. */
static void own(hr2di_event_beams *b, uint32_t edge) {
  const uint32_t *of_wall = b->scene->plane.pieces.of_wall;
  uint32_t k = edge;
  do {
    const uint32_t wall = b->wall_of[k];
    b->own_wall[wall] = b->number;
    b->own_end[b->in->edge[b->in->edge_of[of_wall[wall]]].from] = b->number;
    b->own_end[b->in->edge[b->in->edge_of[of_wall[wall + 1]] - 1].to] = b->number;
    k = b->in->edge[k].same;
  } while (k != edge);
}

/* Whether what is seen changes between the last of one side and the first of another; of two
   walls without patches the end shows. */
static int changes(const hr2di_event_beams *b, hr2di_wall_side last, hr2di_wall_side first) {
  const hr2di_side_part *part = b->scene->parts.part;
  const hr2di_side *l = &b->scene->parts.of_side[last], *f = &b->scene->parts.of_side[first];
  const uint32_t p =
      l->parts.first < l->parts.last ? part[l->parts.last - 1].patch : HR2DI_NOBODY;
  const uint32_t q = f->parts.first < f->parts.last ? part[f->parts.first].patch : HR2DI_NOBODY;
  return p != q || (p == HR2DI_NOBODY && (l->wall != f->wall || last >> 1 == first >> 1));
}

hr2d_status hr2di_event_beams_from_vertex(hr2di_event_beams *b, hr2di_wall_side side) {
  const int32_t first = half_edge_of(b, side);
  const uint32_t v = start_of(b, first);
  int32_t h = first;
  hr2d_status status = HR2D_OK;
  if (!b->lit[first >> 2]) return status;
  for (; across(b, before(h)) >= 0 && !status; h = across(b, before(h)))
    status = hr2di_watch_work(b->watch, 1);
  const hr2di_wall_side last = (hr2di_wall_side)~across(b, before(h));
  if (status || !changes(b, last, side)) return status;
  start(b, b->in->at[v], HR2DI_NO_VERTEX);
  own(b, side >> 1);
  own(b, last >> 1);
  for (h = first; h >= 0 && !status; h = across(b, before(h))) {
    const int32_t opposite = across(b, next(h));
    b->turns++;
    status = hr2di_watch_work(b->watch, 1);
    if (status || opposite < 0) continue;
    const hr2di_border right = through(b, start_of(b, next(h))),
                       left = through(b, start_of(b, before(h)));
    status = hr2di_triangular_expansion_walk(&b->between, opposite, &right, &left);
  }
  return status;
}

hr2d_status hr2di_event_beams_from_part(hr2di_event_beams *b, hr2d_point at,
                                        const hr2di_side_part *part, uint32_t via) {
  const int32_t h = half_edge_of(b, part->side);
  const hr2d_segment w = b->scene->walls.wall[b->scene->parts.of_side[part->side].wall].at;
  const int turned = hr2di_point_along(w, part->at.a) > hr2di_point_along(w, part->at.b);
  const hr2di_border left = {turned ? w.a : w.b, turned ? w.b : w.a, HR2DI_NO_VERTEX,
                             HR2DI_NO_VERTEX};
  if (!b->lit[h >> 2]) return HR2D_OK;
  start(b, at, via);
  own(b, part->side >> 1);
  const hr2di_border right = {left.to, left.from, HR2DI_NO_VERTEX, HR2DI_NO_VERTEX};
  return hr2di_triangular_expansion_walk(&b->between, h, &right, &left);
}

/* The half-edge that leaves the end of a wall with the triangle on its left which the ray from
   `from` through the end enters; the turn begins behind the wall, on its left or on its right.
   Returns −1 if another wall, or one along the ray, comes before. */
static int32_t find_ahead(const hr2di_event_beams *b, hr2d_point from, hr2di_wall_side arriving,
                          int right) {
  int32_t h = right ? half_edge_of(b, arriving ^ 1) : next(half_edge_of(b, arriving));
  const hr2d_point end = b->in->at[start_of(b, h)];
  for (;;) {
    const int32_t edge = right ? before(h) : h;
    const hr2d_point corner = b->in->at[start_of(b, right ? edge : next(h))];
    const int side = hr2di_orient_sign(from, end, corner) * (right ? -1 : 1);
    const int32_t beyond = across(b, edge);
    if (side < 0 || (side == 0 && beyond >= 0)) return h;
    if (beyond < 0 || hr2di_watch_work(b->watch, 1)) return -1;
    h = right ? beyond : next(beyond);
  }
}

hr2d_status hr2di_event_beams_along_wall(hr2di_event_beams *b, uint32_t wall, int last) {
  const uint32_t *of_wall = b->scene->plane.pieces.of_wall;
  const uint32_t begin = b->in->edge_of[of_wall[wall]], end = b->in->edge_of[of_wall[wall + 1]];
  if (begin == end) return HR2D_OK;
  const hr2di_wall_edge *near = &b->in->edge[last ? end - 1 : begin],
                        *far = &b->in->edge[last ? begin : end - 1];
  const uint32_t tip = last ? near->to : near->from, other = last ? far->from : far->to;
  if (!b->free[tip]) return HR2D_OK;
  start(b, b->in->at[other], HR2DI_NO_VERTEX);
  const hr2di_wall_side arriving = 2 * (uint32_t)(near - b->in->edge) + !last;
  int32_t h = find_ahead(b, b->at, arriving, 0);
  if (h < 0) h = find_ahead(b, b->at, arriving, 1);
  if (h < 0 || !b->lit[h >> 2]) return hr2di_watch_status(b->watch);
  const hr2di_border right = through(b, tip);
  hr2di_border left = right;
  left.tip = HR2DI_NO_VERTEX;
  return hr2di_triangular_expansion_walk(&b->between, across(b, next(h)), &right, &left);
}

int32_t hr2di_event_beams_turn(const hr2di_event_beams *b, hr2di_wall_side side) {
  int32_t h = next(half_edge_of(b, side));
  while (across(b, h) >= 0 && !hr2di_watch_work(b->watch, 1)) h = next(across(b, h));
  return h;
}

/* Which walls edges belong to, and which vertices are ends of walls and inside none. */
static hr2d_status index_walls(hr2di_event_beams *b) {
  const uint32_t *of_wall = b->scene->plane.pieces.of_wall;
  const hr2di_wall_edge *edge = b->in->edge;
  hr2d_status status = HR2D_OK;
  for (uint32_t w = 0; w < b->scene->walls.walls && !status; w++) {
    const uint32_t begin = b->in->edge_of[of_wall[w]], end = b->in->edge_of[of_wall[w + 1]];
    status = hr2di_watch_work(b->watch, 1 + (end - begin) / 8);
    if (begin < end) b->free[edge[begin].from] = b->free[edge[end - 1].to] = 1;
    for (uint32_t k = begin; k < end; k++) b->wall_of[k] = w;
  }
  for (uint32_t k = 0; k + 1 < b->in->edges && !status; k++) {
    if (k % 64 == 0) status = hr2di_watch_work(b->watch, 8);
    if (b->wall_of[k] == b->wall_of[k + 1]) b->free[edge[k].to] = b->free[edge[k + 1].from] = 0;
  }
  return status;
}

/* Marks the part of the plane around a triangle. */
static hr2d_status flood(hr2di_event_beams *b, uint32_t *stack, uint32_t triangle) {
  hr2d_status status = HR2D_OK;
  size_t count = 0;
  if (b->lit[triangle]) return status;
  b->lit[triangle] = 1;
  stack[count++] = triangle;
  while (count > 0 && !status) {
    const hr2di_triangle *t = &b->in->triangle[stack[--count]];
    status = hr2di_watch_work(b->watch, 1);
    for (int k = 0; k < 3; k++) {
      if (t->across[k] < 0 || b->lit[t->across[k] >> 2]) continue;
      b->lit[t->across[k] >> 2] = 1;
      stack[count++] = (uint32_t)t->across[k] >> 2;
    }
  }
  return status;
}

static hr2d_status flood_all(hr2di_event_beams *b) {
  const hr2di_side_parts *parts = &b->scene->parts;
  uint32_t *stack = hr2di_alloc(&b->alloc, b->in->triangles, sizeof *stack);
  hr2d_status status = stack ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = 0; k < parts->parts && !status; k++) {
    const hr2di_side_part *p = &parts->part[k];
    if (k % 16 == 0) status = hr2di_watch_work(b->watch, 2);
    if (p->side != HR2DI_HIDDEN && p->patch != HR2DI_NOBODY &&
        hr2di_scene_lit(b->scene, p->patch) && !status)
      status = flood(b, stack, (uint32_t)half_edge_of(b, p->side) >> 2);
  }
  hr2di_alloc_free(&b->alloc, stack);
  return status;
}

hr2d_status hr2di_event_beams_init(hr2di_event_beams *b, const hr2d_scene *scene,
                                   const hr2d_allocator *alloc, hr2di_watch *watch) {
  const hr2di_triangulation *in = &scene->plane.triangulation;
  *b = (hr2di_event_beams){.alloc = *alloc, .scene = scene, .in = in, .watch = watch};
  b->between = (hr2di_triangular_expansion){.in = in,
                                            .watch = watch,
                                            .alloc = *alloc,
                                            .border = sizeof(hr2di_border),
                                            .side = side_of,
                                            .end = end_at,
                                            .ctx = b};
  b->wall_of = hr2di_alloc(alloc, in->edges, sizeof *b->wall_of);
  b->free = hr2di_alloc_zero(alloc, in->vertices, sizeof *b->free);
  b->lit = hr2di_alloc_zero(alloc, in->triangles, sizeof *b->lit);
  b->own_wall = hr2di_alloc_zero(alloc, scene->walls.walls, sizeof *b->own_wall);
  b->own_end = hr2di_alloc_zero(alloc, in->vertices, sizeof *b->own_end);
  if (!b->wall_of || !b->free || !b->lit || !b->own_wall || !b->own_end) return HR2D_ENOMEM;
  const hr2d_status status = index_walls(b);
  return status ? status : flood_all(b);
}

void hr2di_event_beams_clear(hr2di_event_beams *b) {
  hr2di_alloc_free(&b->alloc, b->wall_of);
  hr2di_alloc_free(&b->alloc, b->free);
  hr2di_alloc_free(&b->alloc, b->lit);
  hr2di_alloc_free(&b->alloc, b->own_wall);
  hr2di_alloc_free(&b->alloc, b->own_end);
  hr2di_triangular_expansion_clear(&b->between);
}
