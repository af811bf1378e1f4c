/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which borders of light cross which part of a grid. */
#ifndef HR2D_SRC_FIELD_BORDER_MAP_H
#define HR2D_SRC_FIELD_BORDER_MAP_H

#include "field/borders.h"

/* Cells along a side of a tile. */
enum { HR2DI_TILE = 16 };

/* Node (column, row) is at low + (column step.x, row step.y), scaled.  Tile (i, j) is the
   rectangle of nodes [1 + 16 i, 17 + 16 i] × [1 + 16 j, 17 + 16 j]. */
typedef struct hr2di_border_map {
  hr2d_allocator alloc;
  const hr2di_borders *borders;
  hr2d_point low, step;
  size_t tiles[2];
  double margin[2];       /* what counts as touched, in nodes */
  unsigned char *crowded; /* whether a tile has so many that they are not kept */
  size_t *first; /* the borders that cross tile k are list[first[k]] to list[first[k + 1]] */
  uint32_t *list;
} hr2di_border_map;

/* With low, step and tiles set.  A tile may have too many borders: then none of its nodes is to
   be interpolated.  HR2D_OK, HR2D_ENOMEM or the status of the watch; to be ended
   by hr2di_border_map_clear() in any case. */
hr2d_status hr2di_border_map_init(hr2di_border_map *m, const hr2di_borders *borders,
                                  const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_border_map_clear(hr2di_border_map *m);

/* A rectangle of nodes, and the longest sides of cells in it over which M is linear. */
typedef struct hr2di_map_block {
  double low[2], high[2], cell[2];
} hr2di_map_block;

/* A bound of the error that such an interpolation has at the borders in a block of a tile, as a
   part of what is allowed; HUGE_VAL if there is a wall.  *lit: one of the borders is one of
   what has light. */
double hr2di_border_map_error(const hr2di_border_map *m, size_t tile, const hr2di_map_block *b,
                              int *lit);

#endif
