/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers triangles and edges anew and makes rings of edges that walls share. */
#include "triangulation/freeze.h"

#include "base/alloc.h"
#include "triangulation/pieces.h"

typedef struct compactor {
  hr2di_mesh *m;
  hr2di_triangulation *t;
  uint32_t *first;       /* vertices + 1 */
  uint32_t *triangle_of; /* the new number of each triangle */
  uint32_t *edge_of;     /* the edge of each piece */
} compactor;

static uint32_t min_corner(const hr2di_triangle *t) {
  const uint32_t a = t->corner[0], b = t->corner[1], c = t->corner[2];
  return a < b ? (a < c ? a : c) : (b < c ? b : c);
}

/* Numbers triangles by their least corners: those near in memory are near in the plane. */
static hr2d_status number_triangles(compactor *c) {
  const hr2di_mesh *m = c->m;
  hr2d_status status = HR2D_OK;
  for (size_t t = 0; t < m->triangles && !status; t++) {
    status = hr2di_mesh_poll(m, t);
    c->first[min_corner(&m->triangle[t]) + 1]++;
  }
  for (size_t v = 0; v < m->vertices && !status; v++) {
    status = hr2di_mesh_poll(m, v);
    c->first[v + 1] += c->first[v];
  }
  for (size_t t = 0; t < m->triangles && !status; t++) {
    status = hr2di_mesh_poll(m, t);
    c->triangle_of[t] = c->first[min_corner(&m->triangle[t])]++;
  }
  return status;
}

/* The edges of each wall in order. */
static hr2d_status number_edges(compactor *c) {
  const hr2di_mesh *m = c->m;
  hr2di_triangulation *t = c->t;
  for (uint32_t w = 0; w < m->walls; w++) {
    t->edge_of[w] = (uint32_t)t->edges;
    if (m->piece[w].edge.from == m->piece[w].edge.to) continue;
    for (uint32_t p = w; p != HR2DI_NO_PIECE; p = m->piece[p].next) {
      const hr2d_status status = hr2di_mesh_poll(m, t->edges);
      if (status) return status;
      c->edge_of[p] = (uint32_t)t->edges;
      t->edge[t->edges++] = m->piece[p].edge;
    }
  }
  t->edge_of[m->walls] = (uint32_t)t->edges;
  return HR2D_OK;
}

/* Makes a ring of the list of a piece that triangles know; the others get its half-edges. */
static void close_ring(hr2di_mesh *m, uint32_t first) {
  const hr2di_wall_edge *e = &m->piece[first].edge;
  uint32_t last = first;
  for (uint32_t k = e->same; k != HR2DI_NO_PIECE; k = m->piece[k].edge.same) {
    hr2di_wall_edge *other = &m->piece[k].edge;
    const int back = other->from != e->from;
    other->half_edge[0] = e->half_edge[back];
    other->half_edge[1] = e->half_edge[!back];
    last = k;
  }
  m->piece[last].edge.same = first;
}

static hr2d_status close_rings(hr2di_mesh *m, hr2di_conflict *conflict) {
  for (uint32_t k = 0; k < m->pieces; k++) {
    const hr2d_status status = hr2di_mesh_poll(m, k);
    if (status) return status;
    const hr2di_wall_edge *e = &m->piece[k].edge;
    if (e->from == e->to || hr2di_mesh_across(m, e->half_edge[0]) != ~(int32_t)(2 * k))
      continue;
    if (e->same != HR2DI_NO_PIECE && !conflict->together)
      hr2di_piece_conflict(m, k, e->same, 1, conflict);
    close_ring(m, k);
  }
  return HR2D_OK;
}

/* The piece in the ring of p that gets the least number: pieces were numbered as they were cut,
   edges are numbered along their walls. */
static uint32_t min_in_ring(const compactor *c, uint32_t p) {
  uint32_t min = p;
  for (uint32_t k = c->m->piece[p].edge.same; k != p; k = c->m->piece[k].edge.same)
    if (c->edge_of[k] < c->edge_of[min]) min = k;
  return min;
}

static int32_t renumber(const compactor *c, int32_t across) {
  if (across >= 0) return (int32_t)(4 * c->triangle_of[across >> 2]) + (across & 3);
  if (across == HR2DI_SKY) return HR2DI_SKY;
  const uint32_t p = hr2di_mesh_piece(across), known = min_in_ring(c, p);
  const uint32_t turned = c->m->piece[known].edge.from != c->m->piece[p].edge.from;
  return ~(int32_t)(2 * c->edge_of[known] + ((uint32_t)(~across & 1) ^ turned));
}

static hr2d_status renumber_all(compactor *c) {
  hr2di_triangulation *t = c->t;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < c->m->triangles && !status; k++) {
    hr2di_triangle *made = &t->triangle[c->triangle_of[k]];
    status = hr2di_mesh_poll(c->m, k);
    *made = c->m->triangle[k];
    for (int e = 0; e < 3; e++) made->across[e] = renumber(c, made->across[e]);
  }
  for (size_t k = 0; k < t->edges && !status; k++) {
    hr2di_wall_edge *e = &t->edge[k];
    status = hr2di_mesh_poll(c->m, k);
    e->same = c->edge_of[e->same];
    e->half_edge[0] = renumber(c, e->half_edge[0]);
    e->half_edge[1] = renumber(c, e->half_edge[1]);
  }
  return status;
}

static hr2d_status reserve(compactor *c) {
  const hr2di_mesh *m = c->m;
  hr2di_triangulation *t = c->t;
  t->triangle = hr2di_alloc(m->alloc, m->triangles, sizeof *t->triangle);
  t->edge = hr2di_alloc(m->alloc, m->pieces, sizeof *t->edge);
  t->edge_of = hr2di_alloc(m->alloc, m->walls + 1, sizeof *t->edge_of);
  c->first = hr2di_alloc_zero(m->alloc, m->vertices + 1, sizeof *c->first);
  c->triangle_of = hr2di_alloc(m->alloc, m->triangles, sizeof *c->triangle_of);
  c->edge_of = hr2di_alloc(m->alloc, m->pieces, sizeof *c->edge_of);
  const int room =
      t->triangle && t->edge && t->edge_of && c->first && c->triangle_of && c->edge_of;
  return room ? HR2D_OK : HR2D_ENOMEM;
}

hr2d_status hr2di_freeze(hr2di_mesh *m, hr2di_triangulation *t, hr2di_conflict *conflict) {
  compactor c = {.m = m, .t = t};
  hr2d_status status = reserve(&c);
  if (!status) status = number_triangles(&c);
  if (!status) status = close_rings(m, conflict);
  if (!status) status = number_edges(&c);
  if (!status) status = renumber_all(&c);
  t->at = m->at;
  t->vertices = m->vertices;
  t->triangles = m->triangles;
  t->walls = m->walls;
  m->at = NULL;
  hr2di_alloc_free(m->alloc, c.first);
  hr2di_alloc_free(m->alloc, c.triangle_of);
  hr2di_alloc_free(m->alloc, c.edge_of);
  return status;
}
