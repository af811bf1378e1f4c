/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes of many patches. */
#ifndef HR2D_BENCH_MANY_H
#define HR2D_BENCH_MANY_H

#include <hr2d/scene.h>

typedef struct many_kind {
  const char *name;
  hr2d_scene *(*make)(size_t patches); /* committed, about as many; NULL if that fails */
} many_kind;

extern const many_kind many_kinds[];
extern const size_t many_kind_count;

/* Committed scenes, or NULL: squares, or fibres of 16 sides, anywhere in a closed box, and a
   round room. */
hr2d_scene *many_random_squares(size_t squares);
hr2d_scene *many_fibres(size_t fibres);
hr2d_scene *many_round(size_t patches);

#endif
