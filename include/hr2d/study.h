/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file study.h
 * @brief L against N over a sequence of ε (paper, section 4).
 *
 * @defgroup study Study of L against N
 * L against N over a sequence of ε (paper, section 4).
 * @{
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
  double b;     /**< the coefficient of N */
  double c;     /**< the coefficient of N² */
  double r2;    /**< 1 − (sum of squared residuals)/(sum of squares about the mean) */
  double slope; /**< slope of the least-squares line through (log N, log L) */
} hr2d_study_fit;

/**
 * Counts N and L for each ε, each time on a fresh hierarchy of the same scene.
 * @param links    an empty set; gives the scene, the oracle and the policy, and keeps the
 *                 message. Its own hierarchy does not grow
 * @param options  limits and budgets; its `epsilon` and `brightness` are not used; NULL for the
 *                 defaults
 * @param epsilon  `count` values
 * @param count    number of values
 * @param rows     receives `count` rows; on failure the rows before the failing one
 * @param done     receives the number of complete rows; may be NULL
 * @return as hr2d_refine_count()
 */
HR2D_API hr2d_status hr2d_study_run(hr2d_linkset *links, const hr2d_refine_options *options,
                                    const double *epsilon, size_t count, hr2d_study_row *rows,
                                    size_t *done);

/**
 * Fits L against N by unweighted least squares (GSL's QR decomposition), as in the paper's
 * figures.
 * @param rows   at least 3 rows with different N
 * @param count  number of rows
 * @param fit    receives the fit; unchanged on failure
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  some N or L is 0; fewer than 3 different N; all N lie within 2^-24 of
 *                      their range from its ends; or a coefficient is beyond the range of a
 *                      double
 *
 * The fit is made in x = (N − M)/h, with M the middle and 2h the range of the N, taken from the
 * integers: N of 10^18 that differ by 1 are distinguished. It is the exact fit of L − L_0,
 * except for some roundings of S = max |L − L_0|. If the N fill their range,
 *
 *     |δc| ≤ 1e-14 S/h²,  |δb| ≤ 1e-14 S (1 + 2M/h)/h,  |δa| ≤ 1e-14 (S (1 + M/h)² + L_0),
 *
 * and the error of the slope is at most 1e-14 of max |log L/L_0| / max |log N/N_0|. If all
 * inner N lie within a fraction w of an end of the range, the errors are up to 1/w² times as
 * large (tests/bounds/check-bounds-study.c).
 *
 * Thread-safe. Cost O(count); takes 40 bytes per row from malloc().
 */
HR2D_API hr2d_status hr2d_study_fit_rows(const hr2d_study_row *rows, size_t count,
                                         hr2d_study_fit *fit);

/** A term `factor`·ε^−`power` of a law. */
typedef struct hr2d_study_term {
  double factor; /**< 0: there is no such term */
  double power;  /**< at least 0 */
  double error;  /**< GSL's estimate of the error of `factor`: of the quadrature */
} hr2d_study_term;

/**
 * The law of N and L: their means over the phases of ε, as ε → 0. Each is a sum of terms, those
 * that grow most first. What is left out grows less than the first term.
 */
typedef struct hr2d_study_constants {
  double period; /**< the phases repeat when ε is divided by it: 2 for `size`, 4 for `size2`,
                      8 for `l1` */
  hr2d_study_term links[3];    /**< of L: the pairs that see each other, then the edges of
                                    shadows and horizons */
  hr2d_study_term elements[3]; /**< of N; the last term has the power 0: −1 for each patch that
                                    sees another, as a tree of n leaves has 2n − 1 elements,
                                    and 1 for each that sees none */
} hr2d_study_constants;

/**
 * Finds the constants of the law of N and L without refining anything.
 *
 * For `size` and the variant `modified`, with κ the ratio of the longer to the shorter patch of
 * a pair and l the length of a patch, L ε² and N ε have the means
 *
 *     3/(2 ln 2) Σ_pairs κ ∫∫ V/r² dx dy,   2/ln 2 Σ_p ∫ max_y (max(l_p, l_q)/l_p · 1/r) dx
 *
 * over an octave of ε, with y all points that x sees, and points at the edge of a shadow twice.
 * doc/theorem.md has the derivation, and the law for `original` and for `l1`. N and L do not
 * depend on the order p of the blocks of links.
 *
 * @param links      gives the scene, the oracle and the policy, and keeps the message; its
 *                   links are not looked at
 * @param options    `progress` with the phase "law", and `ordered`, which must be 0; NULL for
 *                   the defaults. Nothing else is used: no budget or level limits the law
 * @param constants  receives the law; unchanged on failure
 * @retval HR2D_OK           success
 * @retval HR2D_ENOMEM       an allocation failed
 * @retval HR2D_EINVAL       `struct_size` is too small
 * @retval HR2D_EUNSUPPORTED the oracle is not `size`, `size2` or `l1`; the policy is not
 *                           `original` or `modified`; pairs are ordered; the scene has
 *                           mirrors or a period; or with `size` and `size2` two patches touch
 *                           and see each other there, which the message names: 1/r² has no
 *                           integral in a corner
 * @retval other             the status of the progress callback
 *
 * The outer integrals are over the exact views of points of each patch. Estimated errors are
 * below 1e-7 of the factors for `size` and `size2`, and some 1e-6 for `l1`. Cost: some hundred
 * views of each patch, some thousand where views change often, and O(n²) to find corners: 9
 * seconds for 100 patches that hide each other, and four times as much for twice as many. `l1`
 * integrates along each part that is seen, at some 10 µs: a second for some patches and a
 * screen, but minutes for a hundred occluders.
 */
HR2D_API hr2d_status hr2d_study_law(hr2d_linkset *links, const hr2d_refine_options *options,
                                    hr2d_study_constants *constants);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
