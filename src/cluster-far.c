/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cluster-far.h"

#include <math.h>

#include "cluster-sides.h"

/* The m asked for along the longer direction: a cluster of the same length may stand
   between two that are linked, with some to spare.  And how many times the error of the
   ellipse's bound is taken, for what grows towards r = 0. */
#define APART  2.5
#define GROWTH 1

double hr2di_far_degree(double digits, double m) {
  return log(GROWTH / digits) / log(m + sqrt(m * m - 1));
}

/* What is APART along the longer direction of half h is (APART−1)·h away from the cluster,
   so that along a shorter one m ≥ (APART−1)·h/half. */
hr2di_far hr2di_far_make(const hr2di_cluster *c, double digits) {
  const hr2di_extent *e = &c->nested;
  hr2di_far far = {.u = c->u,
                   .at = {0.5 * (e->u0 + e->u1), 0.5 * (e->v0 + e->v1)},
                   .half = {0.5 * (e->u1 - e->u0), 0.5 * (e->v1 - e->v0)}};
  const double longer = fmax(far.half[0], far.half[1]);
  for (int k = 0; k < 2; k++) {
    far.reach[k] = fmax(APART * far.half[k], (APART - 1) * longer);
    if (far.half[k] == longer) far.reach[k] = APART * longer;
    const double degree =
        far.half[k] > 0 ? hr2di_far_degree(digits, far.reach[k] / far.half[k]) : 0;
    far.count[k] = (unsigned)fmin(fmax(ceil(degree), 1), HR2DI_FAR_POINTS);
  }
  return far;
}

/* How far x = 0 is outside of an interval, and the place in it nearest to 0. */
static double beyond(double low, double high, double half) {
  return fmax(fmax(low - half, -half - high), 0);
}

static double nearest(double low, double high) {
  return low > 0 ? low : high < 0 ? high : 0;
}

/* The sum of the distances to both ends of an interval, least where y is nearest. */
static double around(double half, double along, double aside) {
  return hypot(along - half, aside) + hypot(along + half, aside);
}

static int apart(const hr2di_cluster *c, const hr2di_far *far, const hr2di_cluster *other,
                 double least) {
  const hr2di_extent e = hr2di_cluster_extent_of(c, other, &other->nested);
  const double u0 = e.u0 - far->at[0], u1 = e.u1 - far->at[0];
  const double v0 = e.v0 - far->at[1], v1 = e.v1 - far->at[1];
  const double du = beyond(u0, u1, far->half[0]), dv = beyond(v0, v1, far->half[1]);
  return hypot(du, dv) >= least &&
         around(far->half[0], nearest(u0, u1), dv) >= 2 * far->reach[0] &&
         around(far->half[1], nearest(v0, v1), du) >= 2 * far->reach[1];
}

/* What is HR2DI_CLUSTER_TOUCH behind a patch at the distance r has a cosine of −TOUCH/r. */
int hr2di_far_apart(const hr2di_cluster *i, const hr2di_far *far_i, const hr2di_cluster *j,
                    const hr2di_far *far_j, double digits) {
  const double least = 8 * HR2DI_CLUSTER_TOUCH / digits;
  return apart(i, far_i, j, least) && apart(j, far_j, i, least);
}

size_t hr2di_far_gauss(const hr2di_far *far, double length, size_t order, double digits) {
  const double gap = (APART - 1) * fmax(far->half[0], far->half[1]);
  const double degree = hr2di_far_degree(digits, hypot(2 * gap / length, 1));
  const double most = far->count[0] + far->count[1] - 2;
  return (size_t)ceil(0.5 * ((double)order + fmin(ceil(degree), most)));
}
