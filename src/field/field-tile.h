/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One tile of the field on a grid. */
#ifndef HR2D_SRC_FIELD_FIELD_TILE_H
#define HR2D_SRC_FIELD_FIELD_TILE_H

#include <stdatomic.h>

#include "field/border-map.h"
#include "field/field-at.h"

/* What is kept of a node: whether it has a view (1) or is interpolated (−1), these, and then
   mean, flux and error. */
enum hr2di_node_item {
  HR2DI_NODE_KNOWN,
  HR2DI_NODE_PLACE,
  HR2DI_NODE_CLEARANCE,
  HR2DI_NODE_SKY,
  HR2DI_NODE_BACK,
  HR2DI_NODE_CUT_OFF,
  HR2DI_NODE_LIGHT
};

/* Nodes along a side of the largest block, with one before it and one after it. */
enum { HR2DI_TILE_SIDE = HR2DI_TILE + 3 };

typedef struct hr2di_grid_call {
  hr2di_field_call f;
  hr2d_field_grid grid;
  size_t bands, each; /* doubles per node */
  size_t items;       /* of these, up to which any is wanted */
  double *first;      /* M at the first node of each tile */
  double *range;      /* of M per band, times the tolerance */
  double *view;       /* what of that views may take */
  int coarse;         /* whether nodes may be interpolated */
  hr2di_borders borders;
  hr2di_border_map map; /* with the tiles */
  atomic_uint_fast64_t exact, interpolated;
} hr2di_grid_call;

/* The node of a column and a row, as the caller has it. */
hr2d_point hr2di_grid_point(const hr2di_grid_call *call, size_t column, size_t row);

/* Keeps the values of the nodes of tile `task`: by views or, if the call says so, between
   views.  The room of the worker has (1 + HR2DI_TILE_SIDE²) nodes behind that of a look.
   Returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_grid_tile(void *call, hr2di_field_worker *worker, size_t task);

#endif
