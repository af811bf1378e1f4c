/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs with occluders between them that are hard on visibility. */
#ifndef HR2D_TESTS_SUPPORT_VISIBILITY_CASES_H
#define HR2D_TESTS_SUPPORT_VISIBILITY_CASES_H

#include <hr2d/geometry.h>
#include <stddef.h>

#include "support/pair-classes.h"

enum { MOST_OCCLUDERS = 16 };

typedef struct occluded_pair {
  hr2d_segment i, j;
  hr2d_segment occluder[MOST_OCCLUDERS];
  size_t count;
} occluded_pair;

typedef struct occluded_class {
  const char *name;
  void (*draw)(randoms *r, double step, occluded_pair *p);
} occluded_class;

extern const occluded_class occluded_classes[];
extern const int occluded_class_count;

/* A pair of a class, in a box of about 1.  A third of the pairs lie on a coarse grid, where
   many points are collinear, and a third on a finer grid.  There the feet on other segments
   are exact, even after a turn by (p + qi)/4, which changes every angle and rounds nothing. */
void draw_occluded(const occluded_class *class, randoms *r, occluded_pair *p);

/* The exchange area of a pair around its occluders, by the library. */
double exchange_among(hr2d_segment i, hr2d_segment j, const hr2d_segment *occluder,
                      size_t count);

/* A pair as numbers that compile. */
void print_occluded(const occluded_pair *p);

/* All points through z → (u + iv) z + (x + iy). */
typedef struct similarity {
  double u, v, x, y;
} similarity;

hr2d_point similar_point(similarity s, hr2d_point z);
hr2d_segment similar_segment(similarity s, hr2d_segment w);
occluded_pair similar_pair(similarity s, const occluded_pair *p);

#endif
