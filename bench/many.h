/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes of many patches. */
#ifndef HR2D_BENCH_MANY_H
#define HR2D_BENCH_MANY_H

#include <hr2d/scene.h>

#include "support/random.h"

typedef struct many_kind {
  const char *name;
  hr2d_scene *(*make)(size_t patches); /* committed, about as many; NULL if that fails */
} many_kind;

extern const many_kind many_kinds[];
extern const size_t many_kind_count;

/* Regular polygons of 3 to MANY_CORNERS corners, each turned and shifted at random in its own
   cell of the unit square. */
enum { MANY_CORNERS = 64 };

typedef struct many_bed {
  size_t count, corners, next;
  randoms state;
} many_bed;

many_bed many_bed_of(size_t count, size_t corners);
int many_bed_next(many_bed *bed, hr2d_point *at); /* sets all corners; 0: there are no more */

/* Committed scenes, or NULL: squares, or fibres of 16 sides, anywhere in a closed box, a round
   room, and an open row of unit squares, one apart. */
hr2d_scene *many_random_squares(size_t squares);
hr2d_scene *many_fibres(size_t fibres);
hr2d_scene *many_round(size_t patches);
hr2d_scene *many_row(size_t squares);

#endif
