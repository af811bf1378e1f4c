/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of a solution on graded trees, from a finer operator. */
#ifndef HR2D_SRC_ACCURACY_ERROR_ESTIMATE_H
#define HR2D_SRC_ACCURACY_ERROR_ESTIMATE_H

#include "accuracy/graded-solve.h"

typedef struct hr2di_errors {
  hr2d_error average; /* of the worst patch, or of the one asked for */
  hr2d_error sup;
  uint64_t kernels; /* values of G it took */
  uint64_t bytes;   /* of the finer trees, links and blocks */
} hr2di_errors;

/* Estimates the error of an answer of this fineness; HR2D_OK, or a status with a reason in
   `message`. */
hr2d_status hr2di_estimate(const hr2di_answer *answer, const hr2di_fineness *fineness,
                           const hr2d_target *target, hr2di_errors *errors,
                           hr2di_message *message);

/* The fineness of the operator that an answer is held against. */
hr2di_fineness hr2di_finer(const hr2di_fineness *fineness);

#endif
