/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps, in their order. */
#include "triangulation/triangulation.h"

#include "base/alloc.h"
#include "triangulation/check-crossings.h"
#include "triangulation/constraints.h"
#include "triangulation/delaunay.h"
#include "triangulation/freeze.h"
#include "triangulation/hull.h"
#include "triangulation/mesh.h"
#include "triangulation/points.h"
#include "triangulation/snap-feet.h"

/* Half-edges are numbered below 2^31: 4 for each of two triangles per end. */
#define MOST_WALLS (INT32_MAX / 32)

hr2d_status hr2di_triangulation_init(hr2di_triangulation *t, const hr2d_allocator *alloc,
                                     const hr2d_segment *first, size_t count, size_t stride,
                                     unsigned units, hr2di_conflict *conflict,
                                     hr2di_watch *watch) {
  *t = (hr2di_triangulation){.alloc = *alloc};
  *conflict = (hr2di_conflict){0};
  if (count > MOST_WALLS) return HR2D_ENOMEM;
  hr2di_mesh m = {.alloc = &t->alloc,
                  .watch = watch,
                  .first = first,
                  .stride = stride,
                  .walls = count,
                  .units = units};
  int closed = 0;
  hr2d_status status = hr2di_points_init(&m);
  if (!status) status = hr2di_delaunay_init(&m);
  if (!status) status = hr2di_mesh_find_out(&m);
  if (!status) status = hr2di_constraints_insert(&m, conflict);
  if (!status) status = hr2di_feet_snap(&m);
  if (!status) status = hr2di_passes_check(&m, conflict);
  if (!status) status = hr2di_hull_fill(&m, &closed);
  if (!status) status = hr2di_freeze(&m, t, conflict);
  t->sky = closed ? (uint32_t)m.vertices - 4 : UINT32_MAX;
  hr2di_alloc_free(m.alloc, m.at);
  hr2di_alloc_free(m.alloc, m.triangle);
  hr2di_alloc_free(m.alloc, m.out);
  hr2di_alloc_free(m.alloc, m.piece);
  if (!status && conflict->together) status = HR2D_ESCENE;
  return status;
}

void hr2di_triangulation_clear(hr2di_triangulation *t) {
  hr2di_alloc_free(&t->alloc, t->at);
  hr2di_alloc_free(&t->alloc, t->triangle);
  hr2di_alloc_free(&t->alloc, t->edge);
  hr2di_alloc_free(&t->alloc, t->edge_of);
}
