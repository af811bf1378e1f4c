/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What gas leaves, or takes, of the kernel between two clusters, as a series in the distance.
 */
#ifndef HR2D_SRC_CLUSTERS_GAS_SERIES_H
#define HR2D_SRC_CLUSTERS_GAS_SERIES_H

#include "clusters/clusters.h"

enum { HR2DI_GAS_TERMS = 64 };

/* Σ c_n T_n(x), with x from −1 to 1 as r is from `low` to `high`. */
typedef struct hr2di_gas_series {
  double low, high, c[HR2DI_GAS_TERMS];
  size_t terms;
} hr2di_gas_series;

/* Of all distances between points of two clusters: T to `accuracy`, and 1 − T to that part of
   itself. */
void hr2di_gas_series_init(hr2di_gas_series *s, const hr2di_cluster_gas *gas, double accuracy,
                           const hr2d_point *x, size_t xs, const hr2d_point *y, size_t ys);

#endif
