/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a cluster is seen from afar: by the values of a function at few points.

   With d = y − x, r = |d| and normals n the kernel is a sum over components,
   G = ½ (n_x·d)(−n_y·d)/r³ = Σ_ce n_x^c n_y^e T_ce(x,y), T_ce = −½ d_c d_e/r³.
   T is interpolated in x and in y, along the directions of either cluster, at Chebyshev
   points.  Along one of them T is analytic but for the places at which r = 0, which for an
   interval ab are y and its mirror image: they lie on the ellipse around a and b with
   m = (|ya|+|yb|)/|ab|, and the error falls like (m + √(m²−1))^−points (Bernstein). */
#ifndef HR2D_SRC_CLUSTERS_EXPANSION_H
#define HR2D_SRC_CLUSTERS_EXPANSION_H

#include "clusters/tree.h"

enum { HR2DI_EXPANSION_POINTS = 32 }; /* at most, along one direction */

typedef struct hr2di_expansion {
  hr2d_point u;      /* as the cluster's */
  double at[2];      /* the middle along u and v */
  double half[2];    /* half of the extents */
  double reach[2];   /* m ≥ reach/half is asked of what it is linked to */
  unsigned count[2]; /* of points */
} hr2di_expansion;

static inline size_t hr2di_expansion_points(const hr2di_expansion *far) {
  return (size_t)far->count[0] * far->count[1];
}

/* The degree that interpolates to a relative accuracy what is analytic within m. */
double hr2di_expansion_degree(double accuracy, double m);

hr2di_expansion hr2di_expansion_of(const hr2di_cluster *cluster, double accuracy);

/* Whether two clusters are far enough from each other. */
int hr2di_expansion_apart(const hr2di_cluster *i, const hr2di_expansion *far_i,
                          const hr2di_cluster *j, const hr2di_expansion *far_j,
                          double accuracy);

/* The Gauss points a patch of a cluster needs for what is of this degree along it. */
size_t hr2di_expansion_gauss(const hr2di_expansion *far, double length, size_t order,
                             double accuracy);

#endif
