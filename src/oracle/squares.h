/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decides by squares whether elements are small beside their distance. */
#ifndef HR2D_SRC_ORACLE_SQUARES_H
#define HR2D_SRC_ORACLE_SQUARES_H

#include <float.h>
#include <hr2d/oracle.h>
#include <math.h>

/* A² ≤ ε²r² decides without root or division.  Each side, and the estimate's own
   square, is off by at most 5 roundings, so that the two can only disagree where
   the difference is within 16 units in the last place of A².  There the estimate
   itself decides. */
static inline double hr2di_squares_margin(double excess, double a2) {
  return fabs(excess) - 16 * DBL_EPSILON * a2;
}

/* A² − ε²r² of the longer element and the distance of the centres; *a2 receives A². */
static inline double hr2di_squares_excess(const hr2d_element *i, const hr2d_element *j,
                                          double epsilon2, double *a2) {
  const double dx = j->centre.x - i->centre.x, dy = j->centre.y - i->centre.y;
  const double a = i->length > j->length ? i->length : j->length;
  *a2 = a * a;
  return *a2 - epsilon2 * (dx * dx + dy * dy);
}

/* Sets accepted[k] to A² ≤ ε²r² for all pairs of a batch.  Returns the least margin, at most 1,
   which means nothing if ε² is infinite or not a number. */
double hr2di_squares_accept(const hr2d_batch *batch, double epsilon2, unsigned char *accepted);

#endif
