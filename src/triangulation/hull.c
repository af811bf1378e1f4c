/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles outside have a corner of the box.  A sector outside, around vertex b from neighbour
   a to neighbour c, has only edges from b to corners of the box inside.  If it is narrower than
   a half circle, it is part of a pocket of the border: flips turn these edges into edges from
   a, the last one into the edge from a to c, and the triangle abc is outside no more.  Each of
   these quadrilaterals is convex: its angle at b is part of the sector, and that at a corner of
   the box part of a right angle.

   Pockets are filled from all places at once: a vertex waits while a neighbour has been cut
   off. So what crosses a pocket of n vertices crosses about log n triangles, and not n. */
#include "triangulation/hull.h"

#include "base/alloc.h"
#include "geometry/orient-sign.h"

typedef struct filler {
  hr2di_mesh *m;
  uint32_t *queue; /* vertices whose sectors may have to be filled */
  size_t first, last, room;
  uint32_t *waits; /* per vertex, how often it is in the queue */
} filler;

static int is_box(const hr2di_mesh *m, uint32_t vertex) {
  return vertex >= m->vertices - 4;
}

/* Whether h is an edge of the border, with the outside on its left. */
static int is_border(const hr2di_mesh *m, int32_t h) {
  return is_box(m, hr2di_mesh_apex(m, h)) && !is_box(m, hr2di_mesh_from(m, h)) &&
         !is_box(m, hr2di_mesh_to(m, h));
}

static hr2d_status enqueue(filler *f, uint32_t vertex) {
  if (hr2di_alloc_reserve(f->m->alloc, &f->queue, &f->room, f->last + 1, sizeof *f->queue))
    return HR2D_ENOMEM;
  f->queue[f->last++] = vertex;
  f->waits[vertex]++;
  return HR2D_OK;
}

/* The next half-edge from the same vertex, to the left. */
static int32_t turn(const hr2di_mesh *m, int32_t h) {
  return hr2di_mesh_twin(m, hr2di_mesh_before(h));
}

/* The half-edge that ends the sector which begins at h, a half-edge to no corner of the box; h
   if there is no other one. */
static int32_t end_of_sector(const hr2di_mesh *m, int32_t h) {
  int32_t end = turn(m, h);
  while (is_box(m, hr2di_mesh_to(m, end))) end = turn(m, end);
  return end;
}

/* Fills the sector from half-edge h, whose triangle is outside, to neighbour c.  A flip leaves
   the vertex, a and the next corner to the left in the triangle of the edge that was flipped.
 */
static hr2d_status fill(filler *f, int32_t h, uint32_t c) {
  hr2di_mesh *m = f->m;
  const uint32_t a = hr2di_mesh_to(m, h);
  do {
    const int32_t spoke = turn(m, h);
    hr2di_mesh_flip(m, spoke);
    h = spoke & ~3;
  } while (hr2di_mesh_apex(m, h) != c);
  const hr2d_status status = enqueue(f, a);
  return status ? status : enqueue(f, c);
}

/* Fills the narrow sectors around a vertex. */
static hr2d_status fill_around(filler *f, uint32_t vertex) {
  hr2di_mesh *m = f->m;
  int32_t h = end_of_sector(m, m->out[vertex]);
  const uint32_t start = hr2di_mesh_to(m, h);
  hr2d_status status = HR2D_OK;
  do {
    const int32_t end = end_of_sector(m, h);
    const uint32_t a = hr2di_mesh_to(m, h), c = hr2di_mesh_to(m, end);
    const int outside = is_box(m, hr2di_mesh_apex(m, h));
    if (outside && hr2di_orient_sign(m->at[vertex], m->at[a], m->at[c]) > 0)
      status = fill(f, h, c);
    h = end;
  } while (hr2di_mesh_to(m, h) != start && !status);
  return status;
}

static hr2d_status enqueue_border(filler *f) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < f->m->triangles && !status; k++) {
    status = hr2di_mesh_poll(f->m, k);
    for (int e = 0; e < 3 && !status; e++)
      if (is_border(f->m, (int32_t)(4 * k) + e))
        status = enqueue(f, f->m->triangle[k].corner[e]);
  }
  return status;
}

static hr2d_status fill_all(filler *f) {
  hr2d_status status = HR2D_OK;
  while (f->first < f->last && !status) {
    const uint32_t vertex = f->queue[f->first++];
    status = hr2di_mesh_poll(f->m, f->first);
    if (--f->waits[vertex] == 0 && !status) status = fill_around(f, vertex);
  }
  return status;
}

/* The next edge of the border: around its end, from corner to corner of the box. */
static int32_t next_on_border(const hr2di_mesh *m, int32_t h) {
  h = hr2di_mesh_next(h);
  do h = hr2di_mesh_next(hr2di_mesh_across(m, h));
  while (is_box(m, hr2di_mesh_to(m, h)));
  return h;
}

/* Whether all edges of the border are on the way around it from one of them. */
static hr2d_status check_border(const hr2di_mesh *m, int *closed) {
  size_t edges = 0, on_way = 0;
  int32_t first = -1;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < m->triangles && !status; k++) {
    status = hr2di_mesh_poll(m, k);
    for (int e = 0; e < 3; e++) {
      const int32_t h = (int32_t)(4 * k) + e;
      if (!is_border(m, h)) continue;
      edges++;
      first = h;
    }
  }
  for (int32_t h = first; edges > 0 && (h != first || on_way == 0) && !status;
       h = next_on_border(m, h))
    status = hr2di_mesh_poll(m, ++on_way);
  *closed = edges > 0 && on_way == edges;
  return status;
}

hr2d_status hr2di_hull_fill(hr2di_mesh *m, int *closed) {
  filler f = {.m = m};
  f.waits = hr2di_alloc_zero(m->alloc, m->vertices, sizeof *f.waits);
  hr2d_status status = f.waits ? enqueue_border(&f) : HR2D_ENOMEM;
  if (!status) status = fill_all(&f);
  if (!status) status = check_border(m, closed);
  hr2di_alloc_free(m->alloc, f.queue);
  hr2di_alloc_free(m->alloc, f.waits);
  return status;
}
