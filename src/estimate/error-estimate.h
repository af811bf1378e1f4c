/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of a graded solve, from a finer operator. */
#ifndef HR2D_SRC_ESTIMATE_ERROR_ESTIMATE_H
#define HR2D_SRC_ESTIMATE_ERROR_ESTIMATE_H

#include "estimate/graded-solve.h"

/* An estimate is within a factor of 2 of the error: it has to be below this part of the aim. */
#define HR2DI_ERROR_MARGIN 0.5

typedef struct hr2di_error_pair {
  hr2d_error average; /* of the worst patch, or of the one that importance is asked for */
  hr2d_error sup;     /* infinite unless the target asks for points, */
  hr2d_error irradiance, irradiance_sup; /* and so is the one of H */
  double cut_off[2];  /* what of estimates of averages and at points is of images of a period
                         that are cut off */
  double rounding[2]; /* what of the bounds of averages and at points is rounding */
} hr2di_error_pair;

/* Estimates the error of a graded solve of this resolution.  Leaves blocks of its own order
   alone. Returns HR2D_OK, or a status with a reason in `message`. */
hr2d_status hr2di_error_estimate(hr2di_graded *answer, const hr2di_resolution *fineness,
                                 const hr2d_target *target, hr2di_error_pair *errors,
                                 hr2di_message *message);

#endif
