/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each side of the line is a polygon of its own: the line and a chain.  Each vertex of the
   chain had an edge across the line, so that the vertices see the line in the order of the
   chain, and ears may be cut off as in Graham's scan, in linear time with exact signs.  Flips
   make the triangles Delaunay again. */
#include "triangulation/cavity.h"

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "triangulation/in-circle.h"

void hr2di_cavity_clear(const hr2di_mesh *m, hr2di_cavity *c) {
  hr2di_alloc_free(m->alloc, c->edges[0]);
  hr2di_alloc_free(m->alloc, c->edges[1]);
  hr2di_alloc_free(m->alloc, c->triangle);
  hr2di_alloc_free(m->alloc, c->half_edge);
}

static hr2d_status add_rim(const hr2di_mesh *m, hr2di_cavity *c, int side, uint32_t vertex,
                           int32_t within) {
  if (hr2di_alloc_reserve(m->alloc, &c->edges[side], &c->room[side], c->count[side] + 1,
                          sizeof *c->edges[side]))
    return HR2D_ENOMEM;
  c->edges[side][c->count[side]++] = (hr2di_cavity_edge){.vertex = vertex, .within = within};
  return HR2D_OK;
}

hr2d_status hr2di_cavity_touch(const hr2di_mesh *m, hr2di_cavity *c, int32_t t) {
  if (hr2di_alloc_reserve(m->alloc, &c->triangle, &c->triangle_room, c->triangles + 1,
                          sizeof *c->triangle))
    return HR2D_ENOMEM;
  c->triangle[c->triangles++] = t;
  return hr2di_watch_work(m->watch, 1);
}

hr2d_status hr2di_cavity_look(const hr2di_mesh *m, hr2di_cavity *c, int32_t h) {
  if (hr2di_alloc_reserve(m->alloc, &c->half_edge, &c->half_edge_room, c->half_edges + 1,
                          sizeof *c->half_edge))
    return HR2D_ENOMEM;
  c->half_edge[c->half_edges++] = h;
  return HR2D_OK;
}

hr2d_status hr2di_cavity_begin(const hr2di_mesh *m, hr2di_cavity *c, int32_t h) {
  const uint32_t start = hr2di_mesh_apex(m, h);
  c->count[0] = c->count[1] = c->triangles = 0;
  hr2d_status status = hr2di_cavity_touch(m, c, h >> 2);
  for (int side = 0; side < 2 && !status; side++) {
    status = add_rim(m, c, side, start, -1);
    const int32_t within = side ? hr2di_mesh_before(h) : hr2di_mesh_next(h);
    const uint32_t v = side ? hr2di_mesh_from(m, h) : hr2di_mesh_to(m, h);
    if (!status) status = add_rim(m, c, side, v, within);
  }
  return status;
}

hr2d_status hr2di_cavity_go_on(const hr2di_mesh *m, hr2di_cavity *c, int32_t *h, int side) {
  const int32_t back = hr2di_mesh_across(m, *h);
  const int32_t right = hr2di_mesh_next(back), left = hr2di_mesh_before(back);
  const hr2d_status status = hr2di_cavity_touch(m, c, back >> 2);
  *h = side ? left : right;
  return status ? status : add_rim(m, c, side, hr2di_mesh_apex(m, back), side ? right : left);
}

/* Finds what is outside of each rim.  An edge with both sides in the cavity is found by numbers
   that are left in the triangles that go. */
static void view_outside(hr2di_mesh *m, hr2di_cavity_edge *edges, size_t count) {
  for (size_t k = 1; k < count; k++) {
    edges[k].outside = hr2di_mesh_across(m, edges[k].within);
    edges[k].pair = 0;
  }
  for (size_t k = 1; k < count; k++)
    m->triangle[edges[k].within >> 2].across[edges[k].within & 3] = ~(int32_t)k;
  for (size_t k = 1; k < count; k++) {
    if (edges[k].outside < 0) continue;
    const int32_t mark = hr2di_mesh_across(m, edges[k].outside);
    if (mark < 0) edges[k].pair = 1 + (uint32_t)((size_t)~mark < k ? (size_t)~mark : k);
  }
}

/* Hooks a new half-edge to what was outside; of a pair, the second to the first. */
static void hook_rim(hr2di_mesh *m, int32_t *first_of, const hr2di_cavity_edge *r, int32_t h) {
  if (r->pair == 0) {
    hr2di_mesh_hook(m, h, r->outside);
    return;
  }
  int32_t *first = &first_of[r->pair - 1];
  if (*first >= 0) hr2di_mesh_hook(m, h, *first);
  *first = h;
}

/* Cuts ears off a chain; triangles are taken from the end of the list of the cavity.  Returns
   the half-edge along the line. */
static int32_t fill(hr2di_mesh *m, hr2di_cavity *c, int side, int32_t *first_of) {
  hr2di_cavity_edge *edges = c->edges[side];
  size_t top = 0;
  int32_t base = -1;
  for (size_t k = 0; k < c->count[side]; k++) {
    edges[top++] = edges[k];
    while (top > 2) {
      const hr2di_cavity_edge u = edges[top - 3], v = edges[top - 2], w = edges[top - 1];
      const int sign = hr2di_orient_sign(m->at[u.vertex], m->at[v.vertex], m->at[w.vertex]);
      if (side ? sign <= 0 : sign >= 0) break;
      const int32_t t = c->triangle[--c->triangles];
      if (side)
        hr2di_mesh_set(m, t, u.vertex, v.vertex, w.vertex);
      else
        hr2di_mesh_set(m, t, w.vertex, v.vertex, u.vertex);
      hook_rim(m, first_of, &v, side ? 4 * t : 4 * t + 1);
      hook_rim(m, first_of, &w, side ? 4 * t + 1 : 4 * t);
      base = 4 * t + 2;
      edges[--top - 1] = (hr2di_cavity_edge){.vertex = w.vertex, .outside = base};
    }
  }
  return base;
}

hr2d_status hr2di_cavity_close(hr2di_mesh *m, hr2di_cavity *c, int32_t h, int32_t *made) {
  const int32_t back = hr2di_mesh_across(m, h);
  const uint32_t end = hr2di_mesh_apex(m, back);
  hr2d_status status = hr2di_cavity_touch(m, c, back >> 2);
  if (!status) status = add_rim(m, c, 0, end, hr2di_mesh_before(back));
  if (!status) status = add_rim(m, c, 1, end, hr2di_mesh_next(back));
  const size_t rims = c->count[0] > c->count[1] ? c->count[0] : c->count[1];
  int32_t *first_of = status ? NULL : hr2di_alloc(m->alloc, rims, sizeof *first_of);
  if (!status && !first_of) status = HR2D_ENOMEM;
  for (size_t k = 0; k < c->triangles && !status; k++)
    for (int e = 0; e < 3 && !status; e++)
      status = hr2di_cavity_look(m, c, 4 * c->triangle[k] + e);
  int32_t base[2] = {-1, -1};
  for (int side = 0; side < 2 && !status; side++)
    view_outside(m, c->edges[side], c->count[side]);
  for (int side = 0; side < 2 && !status; side++) {
    for (size_t k = 0; k < rims; k++) first_of[k] = -1;
    base[side] = fill(m, c, side, first_of);
    status = hr2di_watch_work(m->watch, 1 + c->count[side] / 2);
  }
  hr2di_alloc_free(m->alloc, first_of);
  if (status) return status;
  hr2di_mesh_hook(m, base[0], base[1]);
  *made = base[0];
  return HR2D_OK;
}

hr2d_status hr2di_cavity_settle(hr2di_mesh *m, hr2di_cavity *c) {
  hr2d_status status = HR2D_OK;
  while (c->half_edges > 0 && !status) {
    const int32_t h = c->half_edge[--c->half_edges], back = hr2di_mesh_across(m, h);
    status = hr2di_watch_work(m->watch, 1);
    if (back < 0 ||
        !hr2di_in_circle(m->at[hr2di_mesh_from(m, h)], m->at[hr2di_mesh_to(m, h)],
                         m->at[hr2di_mesh_apex(m, h)], m->at[hr2di_mesh_apex(m, back)]))
      continue;
    hr2di_mesh_flip(m, h);
    if (!status) status = hr2di_cavity_touch(m, c, h >> 2);
    if (!status) status = hr2di_cavity_touch(m, c, back >> 2);
    const int32_t t = 4 * (h >> 2), s = 4 * (back >> 2);
    const int32_t around[] = {t, t + 2, s, s + 1};
    for (int k = 0; k < 4 && !status; k++) status = hr2di_cavity_look(m, c, around[k]);
  }
  return status;
}
