/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves to targets, and compares errors with the estimates and bounds of the account. */
#ifndef HR2D_TESTS_SUPPORT_ACCURACY_TALLY_H
#define HR2D_TESTS_SUPPORT_ACCURACY_TALLY_H

#include <float.h>
#include <hr2d/hr2d.h>

#include "support/radiosity-scenes.h"

/* Relative errors below this much of κ = ‖(I − ρK)⁻¹‖∞ are rounding. */
#define ACCURACY_ROUNDING (50 * DBL_EPSILON)

/* A solution to a target error, whether or not it was reached. */
hr2d_solution *accuracy_solve(const hr2d_scene *scene, double error, hr2d_norm norm,
                              hr2d_account *account);

/* Asserts that an account describes its solution. */
void accuracy_check_account(const hr2d_account *a, const hr2d_solution *solution);

/* Whether an error is within its bound.  `known` is how well the truth is known. */
int accuracy_is_bounded(hr2d_error e, double error, double known, double rounding);

/* What an estimate has at least: that part of the target where views change, or 0; it is less
   where residuals are that small. */
double accuracy_min_estimate(const hr2d_scene *scene, double target);

/* How many errors are above rounding, and for how many of them the estimate is at least half of
   the error, and at most twice that or twice `min`. */
typedef struct accuracy_tally {
  int compared, close;
} accuracy_tally;

void accuracy_compare(accuracy_tally *t, hr2d_error e, double error, double known,
                      double rounding, double min);

/* Whether 95 % of the estimates are close. */
int accuracy_is_fair(const accuracy_tally *t);

/* The scenes of radiosity_fine.csv. */
radiosity_scenes accuracy_reference(void);

#endif
