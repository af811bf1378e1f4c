/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls in pieces that do not cross, for a triangulation.

   A wall is a run of patches on one line.  Two walls may cross where patches of one of them
   meet: each of these patches ends on the other wall, and none crosses it. */
#ifndef HR2D_SRC_SCENE_WALL_PIECES_H
#define HR2D_SRC_SCENE_WALL_PIECES_H

#include <hr2d/scene.h>
#include <stddef.h>
#include <stdint.h>

#include "base/watch.h"

typedef struct hr2di_wall_pieces {
  hr2d_allocator alloc;
  hr2d_segment *piece; /* wall by wall, and along each wall */
  size_t pieces, room;
  size_t walls;
  uint32_t *of_wall; /* the pieces of wall w are [of_wall[w], of_wall[w + 1]) */
} hr2di_wall_pieces;

/* Of a scene with walls.  HR2D_OK, HR2D_ENOMEM or the status of the watch; to be ended by
   hr2di_wall_pieces_clear() in any case. */
hr2d_status hr2di_wall_pieces_init(hr2di_wall_pieces *p, const hr2d_scene *scene,
                                   hr2di_watch *watch);

/* Cuts a piece in two, of which the second has the next number.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_wall_pieces_cut(hr2di_wall_pieces *p, size_t piece, hr2d_point at);

void hr2di_wall_pieces_clear(hr2di_wall_pieces *p);

#endif
