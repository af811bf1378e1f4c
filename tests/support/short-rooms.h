/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Convex rooms with patches down to 2^-20 of the others, beside corners and along walls. */
#ifndef HR2D_TESTS_SUPPORT_SHORT_ROOMS_H
#define HR2D_TESTS_SUPPORT_SHORT_ROOMS_H

#include <hr2d/hr2d.h>

enum { SHORT_ROOM_PATCHES = 16 };

typedef struct short_room {
  size_t patches;
  double patch[SHORT_ROOM_PATCHES][6]; /* ax ay bx by E ρ, counter-clockwise */
} short_room;

/* Room number k of a seed: rectangles with strips, polygons with their corners cut, twice over
   too. */
short_room short_room_draw(unsigned long seed, int k);

#endif
