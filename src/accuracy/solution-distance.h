/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a solution is from one that is known to be much better. */
#ifndef HR2D_SRC_ACCURACY_SOLUTION_DISTANCE_H
#define HR2D_SRC_ACCURACY_SOLUTION_DISTANCE_H

#include <hr2d/accuracy.h>

#include "base/watch.h"

/* How B, or H, of a solution is read. */
typedef struct hr2di_reading {
  double (*average)(const hr2d_solution *, size_t patch, size_t band);
  double (*at)(const hr2d_solution *, size_t patch, double t, size_t band);
  hr2d_status (*gather)(const hr2d_solution *, size_t patch, const double *t, size_t count,
                        double *value, hr2di_watch *watch);
} hr2di_reading;

extern const hr2di_reading hr2di_reading_b, hr2di_reading_h;

/* Of the patches that count, relative to averages but to no less than the floor, as the errors
   of hr2d_solve_to(). */
double hr2di_distance_of_averages(const hr2di_reading *reading, const hr2d_solution *solution,
                                  const hr2d_solution *reference, const hr2d_target *target);

/* Relative to the largest value of the band.  HR2D_OK, HR2D_ENOMEM or the status of the
   watch. */
hr2d_status hr2di_distance_at_points(const hr2di_reading *reading,
                                     const hr2d_solution *solution,
                                     const hr2d_solution *reference, hr2di_watch *watch,
                                     hr2d_error *distance);

#endif
