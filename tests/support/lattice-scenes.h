/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes of patches with integer coordinates, on which every sign is exact. */
#ifndef HR2D_TESTS_SUPPORT_LATTICE_SCENES_H
#define HR2D_TESTS_SUPPORT_LATTICE_SCENES_H

#include <hr2d/scene.h>

/* A patch from a to b. */
typedef struct lattice {
  long long ax, ay, bx, by;
} lattice;

/* On which side of the line through a and b a point is: 1 left, −1 right, 0 on it.  Exact for
   coordinates below 2^30. */
int lattice_side(long long ax, long long ay, long long bx, long long by, long long x,
                 long long y);

/* An integer from 0 to below − 1. */
long long lattice_random(unsigned long *state, long long below);

/* Patches that begin within a square of `size` and reach at most `reach` along each axis. */
void lattice_draw(unsigned long *state, lattice *p, size_t count, long long size,
                  long long reach);

/* A scene of the patches times 2^exponent, not committed. */
hr2d_scene *lattice_scene(const lattice *p, size_t count, int exponent);

/* The first two patches that a message names. */
void lattice_named_pair(const char *message, size_t *i, size_t *j);

#endif
