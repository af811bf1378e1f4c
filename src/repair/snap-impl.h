/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the repair of drawings. */
#ifndef HR2D_SRC_REPAIR_SNAP_IMPL_H
#define HR2D_SRC_REPAIR_SNAP_IMPL_H

#include <math.h>

#include "geometry/vector.h"
#include "scene/scene-impl.h"

typedef struct hr2di_snap_vertex {
  hr2d_point start, at;
  uint32_t next; /* in its cell, or NONE */
  uint32_t wall; /* the patch that it stands on, or NONE */
  double distance;
} hr2di_snap_vertex;

typedef struct hr2di_snap_bend {
  uint32_t wall, vertex;
  double along; /* a fraction of the wall */
} hr2di_snap_bend;

typedef struct hr2di_snapper {
  hr2d_scene *scene; /* a copy of the caller's */
  const hr2d_allocator *alloc;
  hr2di_watch *watch;
  double tolerance; /* scaled */
  hr2di_snap_vertex *v;
  uint32_t vertices;
  uint32_t *of_end; /* per end 2·patch + e: its vertex */
  uint32_t *cell;   /* a hash table of the squares that vertices lie in */
  size_t cells;     /* a power of two */
  hr2d_segment *box;
  hr2di_snap_bend *bend;
  size_t bends, bend_capacity;
  hr2d_snap_report report;
} hr2di_snapper;

static inline double hr2di_snap_distance(hr2d_point p, hr2d_point q) {
  return hypot(p.x - q.x, p.y - q.y);
}

/* The foot of p on the line of a wall, and the fraction where it is. */
static inline hr2d_point hr2di_snap_project(hr2d_point p, hr2d_point a, hr2d_point b,
                                            double *t) {
  const double ux = b.x - a.x, uy = b.y - a.y, u = hypot(ux, uy);
  *t = ((p.x - a.x) * (ux / u) + (p.y - a.y) * (uy / u)) / u;
  return hr2di_point_at((hr2d_segment){a, b}, *t);
}

static inline hr2d_point hr2di_snap_unscaled(const hr2d_scene *scene, hr2d_point p) {
  return (hr2d_point){ldexp(p.x, scene->exponent), ldexp(p.y, scene->exponent)};
}

/* Finds where walls share a stretch with others: a visitor of pairs of walls. */
hr2d_status hr2di_snap_look_at_stretches(void *snapper, size_t i, size_t j);

/* Cuts the walls there.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_snap_cut(hr2di_snapper *snapper);

/* Each scene has the patches of the other. */
void hr2di_snap_exchange(hr2d_scene *scene, hr2d_scene *other);

#endif
