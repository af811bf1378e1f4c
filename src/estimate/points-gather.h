/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a solution gathers at single points, each on any thread: no bit depends on which. */
#ifndef HR2D_SRC_ESTIMATE_POINTS_GATHER_H
#define HR2D_SRC_ESTIMATE_POINTS_GATHER_H

#include "solution/solution-impl.h"

/* A point of a patch, as a fraction of it. */
typedef struct hr2di_place {
  uint32_t patch;
  double at;
} hr2di_place;

/* Sets value[k·bands + b] to B' at place k, as hr2di_solution_gather() does.  HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_points_gather(const hr2d_solution *solution, const hr2di_place *place,
                                size_t count, unsigned threads, double *value,
                                hr2di_watch *watch);

#endif
