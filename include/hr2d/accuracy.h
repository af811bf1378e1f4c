/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file accuracy.h
 * @brief Solve to a target error or within a time budget, with an account of the error.
 *
 * @defgroup accuracy Accuracy: solve to a target
 * Solve to a target error or within a time budget, with an account of the error.
 *
 * hr2d_solve_to() does not refine until a constant kernel is good enough. It is an hp-Galerkin
 * method with discontinuity meshing: its elements are as large as B is smooth, its links as
 * large as the kernel is smooth, and both carry p Legendre coefficients. The error then falls
 * exponentially with p, and the number of links grows like the number of elements, not like
 * its square.
 *
 *     hr2d_target target = HR2D_TARGET_INIT;
 *     target.error = 1e-9;
 *     hr2d_solution *solution;
 *     hr2d_account account;
 *     hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
 *     if (!status) printf("%.9g\n", hr2d_solution_average(solution, 0, 0));
 *     hr2d_solution_destroy(solution);
 *
 * Errors are relative: of averages of B and H, and of B' = E + ρKB_h and H' = KB_h at points,
 * which hr2d_solution_gather() gives. Let K⁺ be the operator with two coefficients more on the
 * same elements and links, and r = E + ρK⁺B_h − B_h the residual. Then
 *
 *     B − B_h = (I − ρK⁺)⁻¹ r,     H − H_h = K⁺B_h − H_h + K⁺(B − B_h).
 *
 * The *estimate* is an a posteriori error estimate: it solves this equation. Beside corners,
 * where K⁺ shows a known part of the error, r is divided by that part. Errors of averages are
 * sums of terms with signs, which may cancel by chance. Let s be the size that such a sum has
 * with random signs; a sum e becomes the estimate √(e² + (s/10)²). The *bound* has four parts:
 * - a multiple of √(e² + s²), and at points of the estimate: 2.5 times, from 7 to 28
 *   times where views change, 3 times at points at least;
 * - a tenth or more of the largest error of an average without signs;
 * - where views change, the target: elements are made for it, and the error that kinks inside
 *   them cause beyond K⁺ is assumed to be below that. Likewise the estimate is a tenth of the
 *   target at least;
 * - a bound of the roundings of B, of H and of coordinates. (I − ρK)⁻¹ = Σ(ρK)^k maps nothing
 *   positive to anything negative, so it carries a bound on as it carries light.
 *
 * Sunlight that may be missing because a sun shines past more images of a period than there are
 * is no part of any error: hr2d_scene_sunlight_cut_off() has it.
 *
 * The multiples are from measurements; the bound is not proved. doc/adversary.md says how it
 * was attacked, and with which result. hr2d_solution_error() measures against another solution,
 * and does not need the assumption; hr2d_enclose() (enclosure.h) has a bound without any.
 * @{
 */
#ifndef HR2D_ACCURACY_H
#define HR2D_ACCURACY_H

#include <hr2d/options.h>
#include <hr2d/refine.h>
#include <hr2d/scene.h>
#include <hr2d/share.h>
#include <hr2d/solve.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The norm in which an error of B, or of H, is measured. */
typedef enum hr2d_norm {
  HR2D_NORM_AVERAGE = 0, /**< the largest |error| of the average over a patch, relative to this
                              average, but to no less than hr2d_target::floor times the largest
                              average of the band; over patches and bands */
  HR2D_NORM_SUP          /**< the largest |error| at a point, relative to the largest value of
                              the band, over points and bands */
} hr2d_norm;

/** A relative error. */
typedef struct hr2d_error {
  double estimate; /**< the most likely error */
  double bound;    /**< the error does not exceed this; see above */
} hr2d_error;

/** The default of hr2d_target::error. */
#define HR2D_DEFAULT_ERROR 1e-6

/** As hr2d_target::error: the smallest error that a budget, or doubles, allow. */
#define HR2D_SMALLEST_ERROR (-1e300)

/** The default of hr2d_target::floor: patches with averages below this part of the largest one
    count as equally dark. */
#define HR2D_FLOOR 1e-6

/** The target of a solve. Start from #HR2D_TARGET_INIT. */
typedef struct hr2d_target {
  size_t struct_size;      /**< so that the struct can grow */
  double error;            /**< relative error of B and of H to be reached, or
                                #HR2D_SMALLEST_ERROR; 0 stands for #HR2D_DEFAULT_ERROR */
  hr2d_norm norm;          /**< the norm in which it is measured */
  double seconds;          /**< budget of wall time; 0 for none. The best solution that is
                                ready by then is returned */
  const size_t *important; /**< indices of the patches whose averages have to reach the
                                target; the errors of other averages do not count. Any order;
                                one may occur twice. Only read, and only during the call. NULL
                                for all patches */
  size_t important_count;  /**< the number of indices; 0 for all patches. An index of no patch,
                                or a count without indices, is not valid */
  unsigned threads;        /**< 0 for one, or #HR2D_ALL_THREADS; no bit depends on it, except
                                through `seconds` */
  uint64_t max_elements;   /**< budget for N; 0 for none */
  uint64_t max_links;      /**< budget for L; 0 for none */
  uint64_t max_bytes;      /**< budget for elements, links and their blocks, for the fields of
                                a solve and its account, some hundred bytes for each band of a
                                coefficient, for the best solve so far while the next one is
                                made, and for the work space of a refinement; 0 for none. The
                                scene and its events come on top. Without a budget the line
                                classes between patches are kept during the call, in up to 1
                                GiB, which saves some percent of the time */
  hr2d_progress_fn progress; /**< optional */
  void *progress_ctx;        /**< given to `progress` */
  double floor;              /**< an average counts as no less than this part of the largest
                                  average of its band; from 0 to 1; 0 stands for
                                  #HR2D_FLOOR */
  int no_error;              /**< not 0: no error is measured. The first solve that is expected
                                  to reach the target stands, mostly within the target, and
                                  all errors of the account are infinite. Saves the time for
                                  the account: for interactive work, and for series of scenes
                                  that are alike */
  hr2d_share *share;         /**< NULL, or one of several shares that solve together:
                                  unstable interface, see share.h */
  int points;                /**< not 0: errors at points are measured, too. They are gathered
                                  for, which may take several times as long as the rest of the
                                  account. #HR2D_NORM_SUP implies it */
} hr2d_target;

/** The defaults: 1e-6 in averages, no budget, all patches, one thread, no callback, no errors
    at points. */
#define HR2D_TARGET_INIT                                                                       \
  {                                                                                            \
    sizeof(hr2d_target), 0, HR2D_NORM_AVERAGE, 0, NULL, 0, 0, 0, 0, 0, NULL, NULL, 0, 0, NULL, \
        0                                                                                      \
  }

/**
 * Does what #HR2D_TARGET_INIT does, for languages without macros: sets all bytes to 0, and
 * `struct_size`.
 * @param target  the struct
 * @param size    its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_target_init(hr2d_target *target, size_t size);

/** The result and the work of hr2d_solve_to(). Errors at points that hr2d_target::points does
    not ask for are not measured: NaN. */
typedef struct hr2d_account {
  hr2d_error average;    /**< error of the solution in #HR2D_NORM_AVERAGE; with `important`, of
                              these patches */
  hr2d_error sup;        /**< error in #HR2D_NORM_SUP of hr2d_solution_gather(); with
                              `important`, at points of these patches. NaN without `points` */
  hr2d_error irradiance; /**< error of hr2d_solution_irradiance(), in the norm of `average` with
                              H in the place of B */
  hr2d_error irradiance_sup;   /**< error of hr2d_solution_gather_irradiance(), in the norm of
                                    `sup` with H in the place of B. NaN without `points` */
  unsigned order;              /**< p of the solution */
  unsigned solves;             /**< solutions that were made, this one included */
  uint64_t elements;           /**< N */
  uint64_t leaves;             /**< elements without children */
  uint64_t links;              /**< L, links between clusters of patches included */
  uint64_t events;             /**< visibility events; elements end at those that matter */
  uint64_t bytes;              /**< memory of elements, links and blocks, of this share */
  uint64_t kernels;            /**< hr2d_solve_work::kernels, over all solves, of this share */
  double refine_seconds;       /**< time for elements and links, over all solves */
  double coefficients_seconds; /**< time for blocks, of the solve and of its error */
  double solve_seconds;        /**< time for the iterations */
  double error_seconds;        /**< time for estimates and bounds, not for their blocks */
  double seconds;              /**< total time */
  char reason[160];            /**< why the target was not reached; "" if it was */
} hr2d_account;

/**
 * Solves to a target error, or as well as a budget allows.
 *
 * The estimate of averages is mostly within a factor of 2 of the error. Where views change,
 * it is a tenth of the target at least. The target is reached when the bound is
 * below it, or when the estimate is below half of it; the bound may then be above it.
 *
 * @param scene     committed; must outlive the solution
 * @param target    NULL for the defaults
 * @param solution  receives the solution, also with HR2D_EACCURACY, otherwise NULL; it owns its
 *                  hierarchy and links; the caller destroys it
 * @param account   receives the errors and the work; may be NULL
 * @retval HR2D_OK             the target is reached; or `error` is #HR2D_SMALLEST_ERROR, and
 *                             the solution is as good as a budget or doubles allow; or
 *                             `no_error` is set, and nothing is said about the error
 * @retval HR2D_EACCURACY      the target was not reached, because a budget ran out or double
 *                             precision does not suffice; see hr2d_account::reason. The best
 *                             solution so far is returned with its errors. The errors are
 *                             infinite if there was no time to measure them. If the time
 *                             did not even suffice for all factors of whole patches, B is
 *                             one constant per patch, from the factors that were ready.
 *                             The solution is NULL if `max_elements` or `max_bytes` is too
 *                             small for the patches
 * @retval HR2D_ENOMEM         an allocation failed
 * @retval HR2D_EINVAL         a member of `target` is not valid
 * @retval HR2D_ESTATE         the scene is not committed
 * @retval HR2D_ENO_SOLUTION   as hr2d_solve(), or a patch of given flux would be colder than
 *                             0 K, see thermal.h
 * @retval HR2D_ENOT_CONVERGED as hr2d_solve(), or ε falls so fast with T that temperatures do
 *                             not settle
 * @retval HR2D_ECALLBACK      a function gives no emissivity, see thermal.h
 * @retval other               the status of the progress callback
 *
 * Different scenes, and one scene, may be solved from different threads. Cost: L is O(N) at a
 * fixed order; N grows like the number of patches times log(1/error).
 */
HR2D_API hr2d_status hr2d_solve_to(const hr2d_scene *scene, const hr2d_target *target,
                                   hr2d_solution **solution, hr2d_account *account);

/** The predicted cost of a target. */
typedef struct hr2d_prediction {
  unsigned order;       /**< p of the first solve */
  uint64_t elements;    /**< N */
  uint64_t leaves;      /**< elements without children */
  uint64_t links;       /**< L */
  uint64_t bytes;       /**< memory of elements, links and blocks at most */
  double seconds;       /**< wall time of hr2d_solve_to(), its account of the error included */
  double least_seconds; /**< the range of that time begins here */
  double most_seconds;  /**< and ends here, with the solves that follow if the first one does
                             not reach the target */
} hr2d_prediction;

/**
 * Predicts the cost of hr2d_solve_to(): makes the elements and links, and integrates a few of
 * the blocks.
 *
 * On a machine at rest `seconds` is mostly right within a factor of 2, and within 3 but under
 * mirrors and periods, if the first solve reaches the target, which is so in nine of ten cases.
 * The range covers further solves, too.
 * bench/bench-prediction.c measures both on all kinds of scenes of the adversary.
 *
 * @param scene       committed
 * @param target      NULL for the defaults; with `no_error` the time is that without an account
 * @param prediction  receives the cost
 * @return as hr2d_solve_to(), but an exhausted budget gives HR2D_EMAX_ELEMENTS, HR2D_EMAX_LINKS
 *         or HR2D_EMAX_BYTES
 */
HR2D_API hr2d_status hr2d_predict(const hr2d_scene *scene, const hr2d_target *target,
                                  hr2d_prediction *prediction);

/**
 * Measures the error of a solution of any oracle, policy and order.
 *
 * The error is the distance from a reference solution of hr2d_solve_to() for a target far
 * below. The bound is this distance plus the bound of the reference.
 *
 * @param solution  its scene must still exist
 * @param how       threads, budgets, progress, important patches, floor, but not `no_error`;
 *                  `error` is the
 *                  smallest relative distance that must be distinguished from 0; here both 0
 *                  and #HR2D_SMALLEST_ERROR stand for 1e-14. The budgets hold for each
 *                  reference. NULL for the defaults
 * @param average   receives the error in #HR2D_NORM_AVERAGE; may be NULL
 * @param sup       receives the error of hr2d_solution_at() in #HR2D_NORM_SUP; may be NULL
 * @return as hr2d_solve_to(), but HR2D_OK if that returns HR2D_EACCURACY with a solution
 */
HR2D_API hr2d_status hr2d_solution_error(const hr2d_solution *solution, const hr2d_target *how,
                                         hr2d_error *average, hr2d_error *sup);

/**
 * Measures all errors of a solution of any oracle, policy and order, as hr2d_solution_error()
 * does, those of H as well.
 *
 * Errors at points, if `how` asks for them, are sampled between the ends of the leaves of the
 * solution and of the reference, which end where radiosity jumps or bends, and at the borders
 * of sunlight.
 * @param solution  its scene must still exist
 * @param how       as for hr2d_solution_error()
 * @param account   receives the errors, at points those of hr2d_solution_at() and
 *                  hr2d_solution_irradiance_at(), NaN without `points`; `order`, `elements`,
 * `leaves` and `links` of the solution; and the time that this took. The rest is 0, but for
 * `solves`, which is 1. Unchanged on failure
 * @return as hr2d_solution_error()
 */
HR2D_API hr2d_status hr2d_solution_account(const hr2d_solution *solution,
                                           const hr2d_target *how, hr2d_account *account);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
