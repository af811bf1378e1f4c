/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the gases of a scene are, if one has a border.

   A gas fills what is inside of its border, by the even-odd rule, a gas without border all that
   is left, and where borders overlap, the gas counts that was added last.  Nothing is asked of
   borders: they may touch, cross and reach into walls.  They are no obstacles, and visibility
   knows nothing of them.  Along a line the depth of gas is linear between borders; where lines
   sweep over a knot, an end or a crossing of borders, its derivative jumps. */
#ifndef HR2D_SRC_SCENE_REGIONS_H
#define HR2D_SRC_SCENE_REGIONS_H

#include <hr2d/geometry.h>

#include "base/watch.h"
#include "scene/gas.h"

/* A side of a border, in scaled coordinates. */
typedef struct hr2di_border {
  hr2d_segment at;
  size_t gas;
} hr2di_border;

typedef struct hr2di_regions {
  hr2di_border *border; /* one gas after the other */
  size_t borders, border_capacity;
  hr2d_point *knot;
  size_t knots, knot_capacity;
  size_t around; /* the gas without border, or HR2DI_NO_GAS */
} hr2di_regions;

/* Sets scene->regions, for commit.  HR2D_OK, HR2D_ENOMEM, the status of the watch, or
   HR2D_EUNSUPPORTED with a message. */
hr2d_status hr2di_regions_make(hr2d_scene *scene, hr2di_watch *watch);
void hr2di_regions_clear(hr2d_scene *scene);

/* The regions of a scene through whose gases light passes; NULL if one gas is everywhere. */
const hr2di_regions *hr2di_scene_regions(const hr2d_scene *scene);

/* The gas at a point, or HR2DI_NO_GAS. */
size_t hr2di_regions_at(const hr2di_regions *regions, hr2d_point at);

/* Whether a border reaches between two elements; `corner` are the ends of both. */
int hr2di_border_meets_hull(hr2d_segment border, const hr2d_point corner[4]);

/* Whether some border does. */
int hr2di_regions_part(const hr2di_regions *regions, hr2d_segment i, hr2d_segment j);

/* The parts of a line from one point to another that lie in one gas each. */
typedef struct hr2di_crossing {
  double at; /* the part of the way */
  size_t border;
} hr2di_crossing;

typedef struct hr2di_gas_path {
  size_t pieces;            /* at least 1, of which the next begins where a crossing is */
  hr2di_crossing *crossing; /* pieces − 1 of them, in their order */
  size_t *gas;              /* of each piece, or HR2DI_NO_GAS */
} hr2di_gas_path;

/* A path with room for all borders.  HR2D_OK or HR2D_ENOMEM; call the other one in any case. */
hr2d_status hr2di_gas_path_init(hr2di_gas_path *path, const hr2di_regions *regions,
                                const hr2d_allocator *alloc);
void hr2di_gas_path_clear(hr2di_gas_path *path, const hr2d_allocator *alloc);

/* Sets a path.  Cost: the borders times the pieces. */
void hr2di_gas_path_trace(hr2di_gas_path *path, const hr2di_regions *regions, hr2d_point from,
                          hr2d_point to);

/* A walk along a line, gas by gas. */
typedef struct hr2di_gas_walk {
  const hr2di_regions *regions; /* NULL: gas 0 is everywhere */
  hr2d_point from, way;
  double length; /* of the way */
  double at;     /* the part of the way that is done */
  size_t gas;    /* of the piece under way, */
  double piece;  /* and its length */
} hr2di_gas_walk;

/* A walk through a scene with gas, from a point along a vector. */
hr2di_gas_walk hr2di_gas_walk_from(const hr2d_scene *scene, hr2d_point from, hr2d_point way);

/* Walks on to the next piece in some gas.  Returns 0 at the end.  Cost: the borders. */
int hr2di_gas_walk_next(hr2di_gas_walk *walk);

/* Of a segment that is seen from a point the next part behind `after` at which a border crosses
   it, or a knot is before it; `end` if that comes first.  `start` leads from the point to the
   segment. */
double hr2di_regions_cut(const hr2di_regions *regions, hr2d_point x, hr2d_point start,
                         hr2d_point along, double after, double end);

/* Whether a border is so near to the direction of a ray to the segment that depths vary along
   it beyond what rules take. */
int hr2di_regions_is_rough(const hr2di_regions *regions, hr2d_point x, hr2d_point first,
                           hr2d_point last);

#endif
