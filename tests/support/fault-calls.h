/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls on a stage that fail on demand.  If they succeed, their result is mixed into *sum, so
   that another play of the same call can be compared bit by bit. */
#ifndef HR2D_TESTS_SUPPORT_FAULT_CALLS_H
#define HR2D_TESTS_SUPPORT_FAULT_CALLS_H

#include "support/fault-stage.h"

/* The result of a call is the stage itself: mixes it in unless the status is a failure. */
hr2d_status fault_mix_stage(const fault_stage *s, uint64_t *sum, hr2d_status status);

hr2d_status fault_count(fault_stage *s, uint64_t *sum, const hr2d_refine_options *options);

/* At most eight values of ε. */
hr2d_status fault_study(fault_stage *s, uint64_t *sum, const hr2d_refine_options *options,
                        const double *epsilon, size_t count);

/* Sets s->result. */
hr2d_status fault_solve(fault_stage *s, uint64_t *sum, const hr2d_solve_options *options);

hr2d_status fault_matrix(fault_stage *s, uint64_t *sum, const hr2d_matrix_options *options);

#endif
