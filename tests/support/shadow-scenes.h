/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random scenes with absorbers and shadows: rooms with black walls, tables and partitions, rows
   of solar panels, streets. */
#ifndef HR2D_TESTS_SUPPORT_SHADOW_SCENES_H
#define HR2D_TESTS_SUPPORT_SHADOW_SCENES_H

#include <hr2d/hr2d.h>

enum { SHADOW_KINDS = 15 };

/* Scene number k of a seed, committed; its kind is k % SHADOW_KINDS. */
hr2d_scene *shadow_scene_draw(unsigned long seed, int k);
const char *shadow_scene_kind(int k);

#endif
