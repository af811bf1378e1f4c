/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/triangulation-fault.h"

#include <math.h>

#include "geometry/orient-sign.h"
#include "geometry/predicates.h"

static uint32_t from_of(const hr2di_triangulation *t, int32_t h) {
  return t->triangle[h >> 2].corner[h & 3];
}

static uint32_t to_of(const hr2di_triangulation *t, int32_t h) {
  return t->triangle[h >> 2].corner[((h & 3) + 1) % 3];
}

static int is_half_edge(const hr2di_triangulation *t, int32_t h) {
  return h >= 0 && (size_t)(h >> 2) < t->triangles && (h & 3) < 3;
}

/* Half-edge h and what is across it. */
static const char *border_fault(const hr2di_triangulation *t, int32_t h) {
  const int32_t across = t->triangle[h >> 2].across[h & 3];
  const uint32_t from = from_of(t, h), to = to_of(t, h);
  const uint32_t box = (uint32_t)t->vertices - 4;
  if (across == HR2DI_SKY)
    return from >= box && to == box + (from - box + 1) % 4 ? NULL : "the sky is not at the box";
  if (across >= 0) {
    if (!is_half_edge(t, across)) return "a twin does not exist";
    if (t->triangle[across >> 2].across[across & 3] != h) return "a twin does not lead back";
    if (from_of(t, across) != to || to_of(t, across) != from) return "a twin has other ends";
    return NULL;
  }
  const uint32_t edge = (uint32_t)~across >> 1, side = (uint32_t)~across & 1;
  if (edge >= t->edges) return "a wall edge does not exist";
  const hr2di_wall_edge *e = &t->edge[edge];
  if (e->half_edge[side] != h) return "a wall edge does not lead back";
  if (side == 0 ? e->from != from || e->to != to : e->from != to || e->to != from)
    return "a wall edge has other ends";
  return NULL;
}

static const char *triangles_fault(const hr2di_triangulation *t) {
  if (t->vertices < 5 || t->triangles != 2 * (t->vertices - 4) + 2)
    return "the number of triangles is wrong";
  size_t sky = 0;
  for (size_t k = 0; k < t->triangles; k++) {
    const uint32_t *c = t->triangle[k].corner;
    if (c[0] >= t->vertices || c[1] >= t->vertices || c[2] >= t->vertices)
      return "a vertex does not exist";
    if (hr2di_orient_sign(t->at[c[0]], t->at[c[1]], t->at[c[2]]) <= 0)
      return "a triangle is not counterclockwise";
    for (int e = 0; e < 3; e++) {
      const char *fault = border_fault(t, (int32_t)(4 * k) + e);
      if (fault) return fault;
      sky += t->triangle[k].across[e] == HR2DI_SKY;
    }
  }
  return sky == 4 ? NULL : "the box has not four sides";
}

/* Whether h is an edge of the hull, seen from outside. */
static int is_border(const hr2di_triangulation *t, int32_t h) {
  const uint32_t box = (uint32_t)t->vertices - 4;
  const uint32_t apex = t->triangle[h >> 2].corner[((h & 3) + 2) % 3];
  return apex >= box && from_of(t, h) < box && to_of(t, h) < box;
}

/* No vertex is before an edge between two of the walls and the box; of many some are tried. */
static const char *hull_fault(const hr2di_triangulation *t) {
  const size_t box = t->vertices - 4, step = 1 + box / 256;
  size_t edges = 0;
  for (int32_t h = 0; h < (int32_t)(4 * t->triangles); h++) {
    if ((h & 3) == 3 || !is_border(t, h)) continue;
    edges++;
    for (size_t v = (size_t)h % step; v < box; v += step)
      if (hr2di_orient_sign(t->at[from_of(t, h)], t->at[to_of(t, h)], t->at[v]) > 0)
        return "the border is not convex";
  }
  return t->edges > 0 && (edges < 2 || t->sky != box) ? "the border is not closed" : NULL;
}

static double between(hr2d_point p, hr2d_point q) {
  return hypot(q.x - p.x, q.y - p.y);
}

/* How far p is from the segment. */
static double away(const hr2d_segment *s, hr2d_point p) {
  const double length = between(s->a, s->b);
  const double dot = (p.x - s->a.x) * (s->b.x - s->a.x) + (p.y - s->a.y) * (s->b.y - s->a.y);
  if (!(length > 0) || dot <= 0) return between(s->a, p);
  if (dot >= length * length) return between(s->b, p);
  return fabs(hr2di_orient(s->a, s->b, p)) / length;
}

/* The triangle on one side of an edge knows the least edge of its ring. */
static const char *side_fault(const hr2di_triangulation *t, uint32_t edge, int side) {
  const hr2di_wall_edge *e = &t->edge[edge];
  const int32_t h = e->half_edge[side];
  if (!is_half_edge(t, h)) return "an edge has no triangle";
  if (from_of(t, h) != (side ? e->to : e->from) || to_of(t, h) != (side ? e->from : e->to))
    return "the triangle of an edge has other corners";
  const int32_t across = t->triangle[h >> 2].across[h & 3];
  if (across >= 0 || across == HR2DI_SKY) return "the triangle of an edge does not know it";
  const uint32_t known = (uint32_t)~across >> 1;
  uint32_t turn = e->same, min = edge;
  for (size_t k = 0; turn != edge && k < t->edges && turn < t->edges; k++) {
    if (turn < min) min = turn;
    turn = t->edge[turn].same;
  }
  if (turn != edge) return "a ring of edges is broken";
  if (known != min) return "the triangle of an edge knows another one";
  return t->edge[known].half_edge[~across & 1] == h ? NULL
                                                    : "an edge is known by its other side";
}

static const char *wall_fault(const hr2di_triangulation *t, size_t wall, const hr2d_segment *s,
                              double off) {
  const uint32_t first = t->edge_of[wall], last = t->edge_of[wall + 1];
  if (first > last || last > t->edges) return "the edges of a wall are not in order";
  if (first == last) return between(s->a, s->b) <= 2 * off ? NULL : "a wall has no edges";
  for (uint32_t k = first; k < last; k++) {
    const hr2di_wall_edge *e = &t->edge[k];
    if (e->wall != wall) return "an edge has another wall";
    if (e->from >= t->vertices - 4 || e->to >= t->vertices - 4)
      return "an edge has no vertices";
    for (int side = 0; side < 2; side++) {
      const char *fault = side_fault(t, k, side);
      if (fault) return fault;
    }
    if (k > first && t->edge[k - 1].to != e->from) return "a wall is broken";
    if (away(s, t->at[e->from]) > off || away(s, t->at[e->to]) > off)
      return "a wall is led far astray";
    const hr2d_point p = t->at[e->from], q = t->at[e->to];
    if ((q.x - p.x) * (s->b.x - s->a.x) + (q.y - p.y) * (s->b.y - s->a.y) <= 0 &&
        between(p, q) > 2 * off)
      return "a wall runs back";
  }
  if (between(t->at[t->edge[first].from], s->a) > off ||
      between(t->at[t->edge[last - 1].to], s->b) > off)
    return "a wall has other ends";
  return NULL;
}

const char *triangulation_fault(const hr2di_triangulation *t, const hr2d_segment *first,
                                size_t stride, double off) {
  const char *fault = triangles_fault(t);
  if (!fault) fault = hull_fault(t);
  if (t->edge_of[0] != 0 || t->edge_of[t->walls] != t->edges) return "edges belong to no wall";
  for (size_t w = 0; w < t->walls && !fault; w++)
    fault = wall_fault(t, w, (const void *)((const char *)first + w * stride), off);
  return fault;
}
