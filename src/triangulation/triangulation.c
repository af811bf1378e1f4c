/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points, walls, and the compact form of the result. */
#include "triangulation/triangulation.h"

#include "base/alloc.h"
#include "triangulation/constraints.h"
#include "triangulation/delaunay.h"
#include "triangulation/feet.h"
#include "triangulation/mesh.h"
#include "triangulation/passes.h"
#include "triangulation/points.h"

/* Half-edges are numbered below 2^31: 4 for each of two triangles per end. */
#define MOST_WALLS (INT32_MAX / 32)

/* Numbers triangles by their least corners, so that those near in memory are near in the plane;
   `of` becomes the new number of each.  `first` has room for a number per vertex. */
static void number_triangles(const hr2di_mesh *m, uint32_t *first, uint32_t *of) {
  for (size_t v = 0; v <= m->vertices; v++) first[v] = 0;
  for (size_t t = 0; t < m->triangles; t++) {
    const uint32_t *c = m->triangle[t].corner;
    of[t] = c[0] < c[1] ? c[0] : c[1];
    if (c[2] < of[t]) of[t] = c[2];
    first[of[t] + 1]++;
  }
  for (size_t v = 0; v < m->vertices; v++) first[v + 1] += first[v];
  for (size_t t = 0; t < m->triangles; t++) of[t] = first[of[t]]++;
}

/* The edges of each wall in order; `of` becomes the edge of each piece. */
static void number_edges(hr2di_triangulation *t, const hr2di_mesh *m, uint32_t *of) {
  for (uint32_t w = 0; w < m->walls; w++) {
    t->edge_of[w] = (uint32_t)t->edges;
    if (m->piece[w].edge.from == m->piece[w].edge.to) continue;
    for (uint32_t p = w; p != HR2DI_NO_PIECE; p = m->piece[p].next) {
      of[p] = (uint32_t)t->edges;
      t->edge[t->edges++] = m->piece[p].edge;
    }
  }
  t->edge_of[m->walls] = (uint32_t)t->edges;
}

static int32_t renumber(const uint32_t *triangle_of, const uint32_t *edge_of, int32_t across) {
  if (across >= 0) return (int32_t)(4 * triangle_of[across >> 2]) + (across & 3);
  if (across == HR2DI_SKY) return HR2DI_SKY;
  return ~(int32_t)(2 * edge_of[hr2di_mesh_piece(across)] + (uint32_t)(~across & 1));
}

static void renumber_all(hr2di_triangulation *t, const hr2di_mesh *m,
                         const uint32_t *triangle_of, const uint32_t *edge_of) {
  for (size_t k = 0; k < m->triangles; k++) {
    hr2di_triangle *made = &t->triangle[triangle_of[k]];
    *made = m->triangle[k];
    for (int e = 0; e < 3; e++)
      made->across[e] = renumber(triangle_of, edge_of, made->across[e]);
  }
  for (size_t k = 0; k < t->edges; k++)
    for (int side = 0; side < 2; side++)
      t->edge[k].half_edge[side] = renumber(triangle_of, edge_of, t->edge[k].half_edge[side]);
}

static hr2d_status compact(hr2di_triangulation *t, hr2di_mesh *m) {
  t->triangle = hr2di_alloc(m->alloc, m->triangles, sizeof *t->triangle);
  t->edge = hr2di_alloc(m->alloc, m->pieces, sizeof *t->edge);
  t->edge_of = hr2di_alloc(m->alloc, m->walls + 1, sizeof *t->edge_of);
  uint32_t *first = hr2di_alloc(m->alloc, m->vertices + 1, sizeof *first);
  uint32_t *triangle_of = hr2di_alloc(m->alloc, m->triangles, sizeof *triangle_of);
  uint32_t *edge_of = hr2di_alloc(m->alloc, m->pieces, sizeof *edge_of);
  hr2d_status status = t->triangle && t->edge && t->edge_of && first && triangle_of && edge_of
                           ? HR2D_OK
                           : HR2D_ENOMEM;
  if (!status) status = hr2di_watch_work(m->watch, m->triangles / 4);
  if (!status) {
    number_triangles(m, first, triangle_of);
    number_edges(t, m, edge_of);
    status = hr2di_watch_work(m->watch, m->triangles / 4);
  }
  if (!status) {
    renumber_all(t, m, triangle_of, edge_of);
    t->at = m->at;
    t->vertices = m->vertices;
    t->triangles = m->triangles;
    t->walls = m->walls;
    m->at = NULL;
  }
  hr2di_alloc_free(m->alloc, first);
  hr2di_alloc_free(m->alloc, triangle_of);
  hr2di_alloc_free(m->alloc, edge_of);
  return status;
}

hr2d_status hr2di_triangulation_init(hr2di_triangulation *t, const hr2d_allocator *alloc,
                                     const hr2d_segment *first, size_t count, size_t stride,
                                     hr2di_conflict *conflict, hr2di_watch *watch) {
  *t = (hr2di_triangulation){.alloc = *alloc};
  *conflict = (hr2di_conflict){0};
  if (count > MOST_WALLS) return HR2D_ENOMEM;
  hr2di_mesh m = {
      .alloc = &t->alloc, .watch = watch, .first = first, .stride = stride, .walls = count};
  hr2d_status status = hr2di_points_init(&m);
  if (!status) status = hr2di_delaunay_init(&m);
  if (!status) {
    m.out = hr2di_alloc(m.alloc, m.vertices, sizeof *m.out);
    status = m.out ? hr2di_watch_work(watch, m.triangles / 4) : HR2D_ENOMEM;
  }
  if (!status) {
    hr2di_mesh_find_out(&m);
    status = hr2di_constraints_insert(&m, conflict);
  }
  if (!status) status = hr2di_feet_join(&m);
  if (!status) status = hr2di_passes_check(&m, conflict);
  if (!status) status = compact(t, &m);
  hr2di_alloc_free(m.alloc, m.at);
  hr2di_alloc_free(m.alloc, m.triangle);
  hr2di_alloc_free(m.alloc, m.out);
  hr2di_alloc_free(m.alloc, m.piece);
  return status;
}

void hr2di_triangulation_clear(hr2di_triangulation *t) {
  hr2di_alloc_free(&t->alloc, t->at);
  hr2di_alloc_free(&t->alloc, t->triangle);
  hr2di_alloc_free(&t->alloc, t->edge);
  hr2di_alloc_free(&t->alloc, t->edge_of);
}
