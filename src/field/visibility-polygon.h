/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view all round from a point between the walls: which part of which patch it sees in which
   directions. */
#ifndef HR2D_SRC_FIELD_VISIBILITY_POLYGON_H
#define HR2D_SRC_FIELD_VISIBILITY_POLYGON_H

#include "beams/triangular-expansion.h"
#include "scene/scene-impl.h"

/* What is seen, if it is not a patch's front. */
#define HR2DI_ROUND_BACK HR2DI_NOBODY
#define HR2DI_ROUND_SKY  (HR2DI_NOBODY - 1)

/* What is seen from a direction on the right to one on the left. */
typedef struct hr2di_polygon_arc {
  uint32_t patch; /* or what else it is */
  int32_t what;   /* the side of a wall on which it ends, as in hr2di_triangle::across */
  hr2d_point right, left; /* vectors from the point, of any length */
  double angle;           /* between them, from 0 to π */
  double from, to;        /* the part of the patch, fractions; 0 and 1 if all of it is seen */
} hr2di_polygon_arc;

/* HR2D_OK, or a status that ends the view. */
typedef hr2d_status (*hr2di_polygon_arc_fn)(void *ctx, const hr2di_polygon_arc *s);

/* Work space of one thread; what is not set is 0.  To be ended by
 * hr2di_visibility_polygon_clear(). */
typedef struct hr2di_visibility_polygon {
  const hr2d_scene *scene; /* with a plane */
  hr2d_allocator alloc;
  hr2di_watch *watch;
  hr2di_polygon_arc_fn take;
  void *ctx;
  hr2di_triangular_expansion between; /* two rays to vertices; its steps are those so far */
  /* Inside of the view only. */
  int32_t near;
  hr2d_point x;
} hr2di_visibility_polygon;

/* Forgets where the last point was: what follows does not depend on it. */
static inline void hr2di_visibility_polygon_restart(hr2di_visibility_polygon *v) {
  v->near = 0;
}

/* Looks round from x, in scaled coordinates.  Stretches come in an order that is undefined;
   their angles sum to 2π within roundings.  *touches: x touches a wall, and the view is that
   from a point beside it.  Returns HR2D_OK, HR2D_ENOMEM, the status of the watch or that of
   `take`.

   Signs that decide what is seen are exact: walls are where the plane of the scene has them.
   Angles are accurate to 4·2^-53. */
hr2d_status hr2di_beams_all_round(hr2di_visibility_polygon *v, hr2d_point x, int *touches);

/* Looks from the vertex that half-edge `first` leaves along a wall, through the triangles on
   its left, up to the next wall, along which *last comes to the vertex.  Stretches come from
   the right to the left.  Returns as hr2di_beams_all_round(). */
hr2d_status hr2di_beams_between(hr2di_visibility_polygon *v, int32_t first, int32_t *last);

void hr2di_visibility_polygon_clear(hr2di_visibility_polygon *v);

#endif
