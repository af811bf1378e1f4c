/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The patches of a scene in equal pieces, as a scene of their own. */
#ifndef HR2D_TOOLS_COST_PIECES_H
#define HR2D_TOOLS_COST_PIECES_H

#include <hr2d/hr2d.h>

typedef struct pieces {
  hr2d_scene *scene;
  size_t *first; /* piece of each patch; patches + 1 */
  size_t count;  /* of all, with the box around them */
} pieces;

/* Divides each patch so that no piece is longer than `length` longest patches.  Where light
   comes in from the surroundings, a box of up to four black pieces follows, around all others:
   what a piece sees of the background is what it sees of the box.  Call pieces_clear() in any
   case. */
hr2d_status pieces_make(pieces *p, const hr2d_scene *whole, double length);

void pieces_clear(pieces *p);

/* The number of pieces that one patch may have. */
enum { PIECES_MOST = 1 << 14 };

#endif
