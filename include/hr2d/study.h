/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file study.h
 * @brief L against N over a sequence of ε (paper, section 4).
 */
#ifndef HR2D_STUDY_H
#define HR2D_STUDY_H

#include <hr2d/linkset.h>
#include <hr2d/refine.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** One measurement: a dot of the paper's Figures 7 and 8. */
typedef struct hr2d_study_row {
  double epsilon;            /**< ε */
  hr2d_refine_counts counts; /**< N, L and the rest */
  double seconds;            /**< wall time of the count */
} hr2d_study_row;

/** A least-squares fit L ≈ a + bN + cN², and the slope of log L on log N. */
typedef struct hr2d_study_fit {
  double a;     /**< the constant */
  double b;     /**< of N */
  double c;     /**< of N² */
  double r2;    /**< 1 − (sum of squared residuals)/(sum of squares about the mean) */
  double slope; /**< of the least-squares line through (log N, log L) */
} hr2d_study_fit;

/**
 * Counts N and L for each ε, each time on a fresh hierarchy of the same scene.
 *
 * @param links    an empty set; it gives the scene, the oracle and the policy, and
 *                 keeps the message.  Its own hierarchy does not grow.
 * @param options  limits and budgets; its `epsilon` and `brightness` are not used; NULL for
 *                 the defaults
 * @param epsilon  `count` values
 * @param rows     receives `count` rows; on failure the rows before the failing one
 * @param done     receives the number of rows that are complete; may be NULL
 * @return as hr2d_refine_count()
 */
HR2D_API hr2d_status hr2d_study_run(hr2d_linkset *links, const hr2d_refine_options *options,
                                    const double *epsilon, size_t count, hr2d_study_row *rows,
                                    size_t *done);

/**
 * Fits L against N.  Least squares by GSL's QR decomposition, unweighted, as in
 * the paper's figures.
 *
 * @param rows  at least 3 rows with different N
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_EINVAL for N or L of 0, too few different N, or none that
 *         lies 2^-24 of their range away from its ends
 *
 * The fit is made in x = (N − M)/h, with M and 2h the middle and the range of the N, taken from
 * the integers: N of 10^18 that differ by 1 are told apart.  It is the exact one of L − L_0 off
 * by some roundings of S = max |L − L_0|, so that where the N fill their range
 *     |δc| ≤ 1e-14 S/h²,  |δb| ≤ 1e-14 S (1 + 2M/h)/h,  |δa| ≤ 1e-14 (S (1 + M/h)² + L_0),
 * and the slope is off by 1e-14 of max |log L/L_0| / max |log N/N_0|; with all inner N within a
 * fraction w of an end of the range, by 1/w² as much (tests/bounds/check-bounds-study.c).
 * Thread-safe.  Cost O(count).
 */
HR2D_API hr2d_status hr2d_study_fit_rows(const hr2d_study_row *rows, size_t count,
                                         hr2d_study_fit *fit);

#ifdef __cplusplus
}
#endif
#endif
