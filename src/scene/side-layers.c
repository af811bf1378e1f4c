/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls within roundings of each other can share an edge of the triangulation, in which they
   have no order.  The walls as they were given have one: the sum of their distances from the
   two ends of the edge, with the sign of the side.

   Signs of these distances are exact and digits good to some roundings, so that walls of one
   line differ by less than ALIKE of them.  Such walls are back to back, in whatever order they
   come, for commit refuses others.

   Two neighbours in this order see of each other all that lies face to face, and nothing
   else.  What faces no patch faces the back of a wall, which is black. */
#include "scene/side-layers.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/crossings.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

#define ALIKE 0x1p-40

/* One of the walls that share an edge. */
typedef struct layer {
  double left;        /* how far it is on the left of the edge, at both ends together */
  double digits;      /* the same without signs */
  hr2di_side side[2]; /* what lies along its left and its right side */
  uint32_t edge;
} layer;

typedef struct layers {
  hr2di_side_parts *parts;
  const hr2d_scene *scene;
  const hr2di_triangulation *t;
  hr2di_watch *watch;
  layer *layer;
  size_t count, room;
  size_t contacts; /* room for */
} layers;

static int has(hr2di_parts p) {
  return p.first < p.last;
}

/* 1 for a wall with patches only on its right, −1 for one with patches only on its left. */
static int faces_right(const layer *l) {
  return has(l->side[1].parts) - has(l->side[0].parts);
}

/* From left to right. */
static int by_place(const void *left, const void *right) {
  const layer *l = left, *r = right;
  const double difference = l->left - r->left;
  if (fabs(difference) > ALIKE * (l->digits + r->digits)) return difference > 0 ? -1 : 1;
  if (faces_right(l) != faces_right(r)) return faces_right(l) - faces_right(r);
  return l->edge < r->edge ? -1 : 1;
}

static void measure(const layers *c, layer *l, hr2d_segment edge, uint32_t turned) {
  const hr2d_segment w = c->scene->walls.wall[l->side[0].wall].at;
  const hr2d_point end[] = {edge.a, edge.b};
  for (int k = 0; k < 2; k++) {
    const double distance = hr2di_crossings_distance(end[k], &w);
    const int sign = hr2d_orientation(w.a, w.b, end[k]);
    l->left += (turned ? sign : -sign) * distance;
    l->digits += distance;
  }
}

/* The walls that share an edge, from left to right. */
static hr2d_status make_layers(layers *c, uint32_t first) {
  const hr2di_triangulation *t = c->t;
  const hr2d_segment edge = hr2di_wall_side_at(t, 2 * first);
  uint32_t k = first;
  c->count = 0;
  do {
    if (hr2di_alloc_reserve(&c->parts->alloc, &c->layer, &c->room, c->count + 1,
                            sizeof *c->layer))
      return HR2D_ENOMEM;
    layer *l = &c->layer[c->count++];
    const uint32_t turned = t->edge[k].from != t->edge[first].from;
    *l = (layer){.edge = k};
    for (uint32_t right = 0; right < 2; right++) {
      hr2di_side *side = &c->parts->of_side[2 * k + (right ^ turned)];
      l->side[right] = *side;
      side->parts = (hr2di_parts){0, 0};
      c->parts->wanted[2 * k + (right ^ turned)] = 0;
    }
    measure(c, l, edge, turned);
    k = t->edge[k].same;
  } while (k != first);
  return hr2di_sort(c->layer, c->count, sizeof *c->layer, by_place, c->watch);
}

static void move_parts(layers *c, hr2di_side from, hr2di_wall_side to) {
  for (uint32_t k = from.parts.first; k < from.parts.last; k++) c->parts->part[k].side = to;
  if (to == HR2DI_HIDDEN || !has(from.parts)) return;
  c->parts->of_side[to] = from;
  c->parts->wanted[to] = 1;
}

static hr2d_status add_contact(layers *c, uint32_t i, uint32_t j, double area) {
  hr2di_side_parts *p = c->parts;
  if (hr2di_alloc_reserve(&p->alloc, &p->contact, &c->contacts, p->contacts + 2,
                          sizeof *p->contact))
    return HR2D_ENOMEM;
  p->contact[p->contacts++] = (hr2di_part_contact){i, j, area};
  p->contact[p->contacts++] = (hr2di_part_contact){j, i, area};
  return HR2D_OK;
}

/* Where a part begins and ends along the edge. */
typedef struct span {
  double from, to;
} span;

static span span_of(const layers *c, uint32_t part, hr2d_segment edge) {
  const hr2d_segment s = c->parts->part[part].at;
  const double a = hr2di_point_along(edge, s.a), b = hr2di_point_along(edge, s.b);
  return (span){fmin(a, b), fmax(a, b)};
}

/* Parts on the right of one wall and on the left of the next, which lie in opposite directions.
   Their exchange area is the length that they share. */
static hr2d_status face(layers *c, hr2di_parts right, hr2di_parts left, hr2d_segment edge) {
  const double dx = edge.b.x - edge.a.x, dy = edge.b.y - edge.a.y;
  const double stretch = hypot(dx, dy) / fmax(fabs(dx), fabs(dy));
  hr2d_status status = HR2D_OK;
  while (has(right) && has(left) && !status) {
    const uint32_t i = right.last - 1, j = left.first;
    const span p = span_of(c, i, edge), q = span_of(c, j, edge);
    const double shared = fmin(p.to, q.to) - fmax(p.from, q.from);
    const double min = fmin(HR2DI_PART_ROUNDING, fmin(p.to - p.from, q.to - q.from) / 4);
    if (shared > min && c->parts->part[i].patch != HR2DI_NOBODY &&
        c->parts->part[j].patch != HR2DI_NOBODY)
      status = add_contact(c, i, j, shared * stretch);
    right.last -= p.to <= q.to;
    left.first += q.to <= p.to;
    if (!status) status = hr2di_watch_work(c->watch, 1);
  }
  return status;
}

static hr2d_status settle(layers *c, uint32_t first) {
  const hr2d_segment edge = hr2di_wall_side_at(c->t, 2 * first);
  hr2d_status status = make_layers(c, first);
  if (status) return status;
  move_parts(c, c->layer[0].side[0], 2 * first);
  move_parts(c, c->layer[c->count - 1].side[1], 2 * first + 1);
  for (size_t k = 0; k + 1 < c->count && !status; k++) {
    const hr2di_side right = c->layer[k].side[1], left = c->layer[k + 1].side[0];
    move_parts(c, right, HR2DI_HIDDEN);
    move_parts(c, left, HR2DI_HIDDEN);
    status = face(c, right.parts, left.parts, edge);
  }
  return status;
}

/* Whether triangles know edge k, and other walls share it. */
static int is_shared(const hr2di_triangulation *t, uint32_t k) {
  const int32_t h = t->edge[k].half_edge[0];
  return t->edge[k].same != k && (uint32_t)~t->triangle[h >> 2].across[h & 3] >> 1 == k;
}

static int by_part(const void *left, const void *right) {
  const hr2di_part_contact *l = left, *r = right;
  if (l->part != r->part) return l->part < r->part ? -1 : 1;
  return (l->other > r->other) - (l->other < r->other);
}

hr2d_status hr2di_side_layers_settle(hr2di_side_parts *parts, const hr2d_scene *scene,
                                     const hr2di_triangulation *t, hr2di_watch *watch) {
  layers c = {.parts = parts, .scene = scene, .t = t, .watch = watch};
  hr2d_status status = hr2di_watch_work(watch, t->edges / 16);
  for (uint32_t k = 0; k < t->edges && !status; k++)
    if (is_shared(t, k)) status = settle(&c, k);
  if (!status)
    status =
        hr2di_sort(parts->contact, parts->contacts, sizeof *parts->contact, by_part, watch);
  hr2di_alloc_free(&parts->alloc, c.layer);
  return status;
}
