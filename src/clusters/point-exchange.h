/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the points of two clusters exchange: T between them. */
#ifndef HR2D_SRC_CLUSTERS_POINT_EXCHANGE_H
#define HR2D_SRC_CLUSTERS_POINT_EXCHANGE_H

#include <hr2d/scene.h>

#include "base/watch.h"
#include "clusters/gas-series.h"

/* Of a cluster.  Values are per plane and point: x components of all bands, then y. */
typedef struct hr2di_points {
  const hr2d_point *point;
  size_t count;
  const double *sent;
  double *received;
} hr2di_points;

/* Adds what each of two clusters receives from the other; ends early if the watch stops.  gas:
   NULL if there is none. */
void hr2di_points_exchange(const hr2di_points *i, const hr2di_points *j, size_t bands,
                           const hr2di_gas_series *gas, hr2di_watch *watch);

/* What the first one receives alone, with sums in another order. */
void hr2di_points_receive(const hr2di_points *i, const hr2di_points *j, size_t bands,
                          const hr2di_gas_series *gas, hr2di_watch *watch);

#endif
