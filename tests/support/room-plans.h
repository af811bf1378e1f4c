/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed rooms with obstacles of many kinds; in all of them each row of exchange areas sums
   to the length of its patch. */
#ifndef HR2D_TESTS_SUPPORT_ROOM_PLANS_H
#define HR2D_TESTS_SUPPORT_ROOM_PLANS_H

#include <hr2d/scene.h>
#include <stddef.h>

#include "support/visibility-cases.h"

/* Segments to make a scene of: a closed room and what stands in it. */
typedef struct plan {
  hr2d_segment *wall;
  hr2d_sides *sides;
  size_t walls, capacity;
  int crossing; /* walls cross each other and are still to be cut */
} plan;

typedef struct plan_class {
  const char *name;
  void (*draw)(randoms *r, int size, plan *p);
} plan_class;

extern const plan_class plan_classes[];
extern const int plan_class_count;

void plan_add(plan *p, hr2d_point a, hr2d_point b, hr2d_sides sides);
void plan_free(plan *p);

/* A rectangular room with a corner at the origin. */
void plan_room(plan *p, double width, double height);

/* A unit square with walls in it that meet in one point, each next to the last. */
void plan_fan(plan *p, int spokes);

/* Moves all walls; where rounding made a wall's end pass through another wall, it is
   pulled back again. */
void plan_transform(plan *p, similarity s);

#endif
