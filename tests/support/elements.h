/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs of elements without a hierarchy, and what an oracle says about them. */
#ifndef HR2D_TESTS_SUPPORT_ELEMENTS_H
#define HR2D_TESTS_SUPPORT_ELEMENTS_H

#include <hr2d/oracle.h>

#include "support/pair-classes.h"

typedef struct element_pair {
  hr2d_element element[2];
  const double *brightness; /* of both, or NULL */
} element_pair;

/* The element of a segment, in a scene whose unit is 1. */
hr2d_element element_of(hr2d_segment s);

/* A batch of the one pair. */
hr2d_batch element_batch(const element_pair *p);

/* What an oracle says about a batch of one pair. */
double element_estimate(const hr2d_oracle *oracle, const hr2d_batch *batch);
int element_accepted(const hr2d_oracle *oracle, const hr2d_batch *batch, double epsilon);

/* Draws the ends of a pair, ax ay bx by of i and of j, scaled to a largest coordinate of 1
 * to 2. */
void element_draw(const pair_class *class, randoms *r, double x[8]);

/* Whether all numbers are below 2, and those other than 0 within a factor 2^bits of each other.
 */
int element_in_range(const double *x, int count, int bits);

#endif
