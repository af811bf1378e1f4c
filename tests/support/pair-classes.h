/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Classes of segment pairs that are hard on an exchange area. */
#ifndef HR2D_TESTS_SUPPORT_PAIR_CLASSES_H
#define HR2D_TESTS_SUPPORT_PAIR_CLASSES_H

#include <hr2d/geometry.h>

#include "support/random.h"

typedef struct pair {
  hr2d_segment i, j;
} pair;

typedef struct pair_class {
  const char *name;
  pair (*draw)(randoms *r);
  int share; /* pairs relative to the other classes */
} pair_class;

extern const pair_class pair_classes[];
extern const int pair_class_count;

/* One of the two halves of s, then one of the halves of that, down to a level. */
hr2d_segment random_descendant(randoms *r, hr2d_segment s, int levels);

/* A pair of a class; most often turned so that the segments see each other. */
pair draw_pair(const pair_class *class, randoms *r);

#endif
