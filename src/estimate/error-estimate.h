/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of a graded solve, from a finer operator. */
#ifndef HR2D_SRC_ESTIMATE_ERROR_ESTIMATE_H
#define HR2D_SRC_ESTIMATE_ERROR_ESTIMATE_H

#include "estimate/estimator.h"
#include "estimate/graded-solve.h"

/* An estimate is within a factor of 2 of the error: it has to be below this part of the aim. */
#define HR2DI_ERROR_MARGIN 0.5

typedef struct hr2di_error_pair {
  hr2d_error average; /* of the worst patch, or of the one that importance is asked for */
  hr2d_error sup;     /* infinite unless the target asks for points, */
  hr2d_error irradiance, irradiance_sup; /* and so is the one of H */
  double cut_off[2];    /* what of estimates of averages and at points is of images of a period
                           that are cut off; */
  size_t cut_off_patch; /* the patch whose average has most of that, relative to it, */
  double cut_off_part;  /* and what that is of the largest value of its band */
  double rounding[2];   /* what of the bounds of averages and at points is rounding */
} hr2di_error_pair;

/* The finer operator K⁺ on the trees and links of a graded solve, for solutions on them. */
typedef struct hr2di_finer {
  hr2di_roots roots; /* with clusters of its own, or none */
  hr2di_estimator estimator;
  int is_made; /* the estimator is to be cleared */
} hr2di_finer;

/* As hr2di_estimator_init(), for a graded solve of this resolution.  It must not be moved; to
   be cleared in any case. */
hr2d_status hr2di_finer_init(hr2di_finer *finer, const hr2di_graded *answer,
                             const hr2di_resolution *fineness, const hr2d_target *target);
void hr2di_finer_clear(hr2di_finer *finer);

/* Estimates and bounds the errors of a solution for the light that the scene has now.  HR2D_OK,
   HR2D_ENOMEM, HR2D_ENOT_CONVERGED or the status of the watch. */
hr2d_status hr2di_finer_measure(hr2di_finer *finer, const hr2d_solution *solution,
                                hr2di_error_pair *errors);

/* Estimates the error of a graded solve of this resolution, of one group of bands; once.  Its
   links keep the blocks of the finer operator.  Returns HR2D_OK, or a status with a reason in
   `message`. */
hr2d_status hr2di_error_estimate(hr2di_graded *answer, const hr2di_resolution *fineness,
                                 const hr2d_target *target, hr2di_error_pair *errors,
                                 hr2di_message *message);

#endif
