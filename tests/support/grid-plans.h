/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls with ends on a coarse grid, and what else is done with plans of walls. */
#ifndef HR2D_TESTS_SUPPORT_GRID_PLANS_H
#define HR2D_TESTS_SUPPORT_GRID_PLANS_H

#include "support/room-plans.h"

/* A room with walls that meet in T-junctions, share ends, lie on one line and touch; each cut
   into some patches.  In an open scene there is no room around them, and some have one side. */
plan grid_plan(randoms *r, int closed);

void plan_add_pieces(plan *p, hr2d_segment s, int pieces, hr2d_sides sides);

/* Moves all walls, and then every end by itself by an ulp at most. */
void plan_jitter(randoms *r, plan *p, similarity s);

/* Commits; NULL if that fails.  `hooks` may be NULL. */
hr2d_scene *plan_try_scene(const plan *p, const hr2d_allocator *hooks);

void plan_print(const plan *p);

#endif
