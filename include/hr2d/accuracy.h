/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file accuracy.h
 * @brief Ask for digits or for seconds, and know the error of what you get.
 *
 * hr2d_solve_to() does not refine until a constant kernel is good enough.  Its elements
 * are as large as B is smooth, its links as large as the kernel is smooth, and both carry
 * p Legendre coefficients; the error then falls exponentially with p, and links grow like
 * the number of elements and not like its square.
 *
 *     hr2d_target target = HR2D_TARGET_INIT;
 *     target.error = 1e-9;
 *     hr2d_solution *solution;
 *     hr2d_account account;
 *     hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
 *     if (!status) printf("%.9g\n", hr2d_solution_average(solution, 0, 0));
 *     hr2d_solution_destroy(solution);
 *
 * Errors are relative.  What is reported is the radiosity after one more gather,
 * B' = E + ρKB_h, whose averages are those of B_h; hr2d_solution_gather() has it at points.
 * With r = E + ρKB_h − B_h the residual, B − B' = (I − ρK)⁻¹ ρKr, and because (I − ρK)⁻¹
 * maps nothing positive to anything negative,
 *
 *     |B − B'| ≤ (I − ρK)⁻¹ S     for any S ≥ |ρKr|.
 *
 * The *bound* is the right side, S being constant on each element; the *estimate* is
 * (I − ρK)⁻¹ ρKr itself.  In both K is taken on finer elements with two coefficients more,
 * and S from the points of a rule: the bound is rigorous but for that.
 */
#ifndef HR2D_ACCURACY_H
#define HR2D_ACCURACY_H

#include <hr2d/refine.h>
#include <hr2d/scene.h>
#include <hr2d/solve.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** In which norm an error is measured. */
typedef enum hr2d_norm {
  HR2D_NORM_AVERAGE = 0, /**< the largest |error| of a patch's average B, relative to that
                              average, over patches and bands; averages below
                              256 roundings of the band's largest count as dark */
  HR2D_NORM_SUP          /**< the largest |error| of B at a point, relative to the largest B
                              of the band, over points and bands */
} hr2d_norm;

/** A relative error. */
typedef struct hr2d_error {
  double estimate; /**< what it most likely is */
  double bound;    /**< what it does not exceed; see above */
} hr2d_error;

/** Stands for all patches. */
#define HR2D_ALL_PATCHES ((size_t)-1)

/** What is asked for.  Start from #HR2D_TARGET_INIT. */
typedef struct hr2d_target {
  size_t struct_size;    /**< so that the struct can grow */
  double error;          /**< relative error to be reached; 0: as small as can be had, which
                              wants a budget of seconds or takes what doubles give */
  hr2d_norm norm;        /**< the norm in which it is measured */
  double seconds;        /**< budget of wall time; 0 for none.  The best solution that was ready
                              by then is returned */
  size_t importance;     /**< only the average of this patch has to reach the target;
                              #HR2D_ALL_PATCHES for all */
  unsigned threads;      /**< 0 for all; no bit depends on it but through `seconds` */
  uint64_t max_elements; /**< budget for N; 0 for none */
  uint64_t max_links;    /**< budget for L; 0 for none */
  uint64_t max_bytes;    /**< budget for elements, links and blocks; 0 for none */
  hr2d_progress_fn progress; /**< optional */
  void *progress_ctx;        /**< given to `progress` */
} hr2d_target;

/** 1e-6 in averages, no budget, all patches, one thread, no callback. */
#define HR2D_TARGET_INIT                                                                       \
  { sizeof(hr2d_target), 1e-6, HR2D_NORM_AVERAGE, 0, HR2D_ALL_PATCHES, 1, 0, 0, 0, NULL, NULL }

/** What was done and what it took. */
typedef struct hr2d_account {
  hr2d_error average;    /**< of the solution, in #HR2D_NORM_AVERAGE; of the one patch where
                              importance was asked for */
  hr2d_error sup;        /**< in #HR2D_NORM_SUP */
  unsigned order;        /**< p of the solution */
  unsigned solves;       /**< solutions made on the way, this one included */
  uint64_t elements;     /**< N */
  uint64_t leaves;       /**< elements without children */
  uint64_t links;        /**< L, links between clusters of patches included */
  uint64_t events;       /**< visibility events at which elements end */
  uint64_t bytes;        /**< of elements, links and blocks */
  uint64_t kernels;      /**< values of G integrated, over all solves */
  double refine_seconds; /**< for elements and links, over all solves */
  double coefficients_seconds; /**< for blocks */
  double solve_seconds;        /**< for the iterations */
  double error_seconds;        /**< for estimates and bounds, finer solves included */
  double seconds;              /**< in all */
  char reason[160];            /**< why the target was not reached; "" if it was */
} hr2d_account;

/**
 * Solves to a target error, or as well as a budget allows.  It is reached when the estimate,
 * which is within a factor of 2 of the error, is below half of it; the bound may be
 * above.
 *
 * @param scene     committed; must outlive the solution
 * @param target    NULL for the defaults
 * @param solution  receives the solution, which owns the hierarchy and the links it stands
 *                  on; also with HR2D_EACCURACY; else NULL.  The caller destroys it
 * @param account   receives the errors and what it took; may be NULL
 * @return HR2D_OK; HR2D_EACCURACY where the target was not reached, be it for a budget or for
 *         the precision of doubles (account->reason says): the best solution is returned with
 *         its errors, which are infinite if there was no time to measure them, and NULL if
 *         there was none for the coarsest; HR2D_ENOMEM, HR2D_EINVAL, HR2D_ESTATE for a scene
 *         that is not committed, HR2D_ENO_SOLUTION, HR2D_ENOT_CONVERGED, or the status of the
 *         progress callback.  With `error` 0 it is HR2D_OK when the budget is used up
 *
 * Different scenes, and one scene, may be solved from different threads.  Cost: L is O(N) at
 * fixed order, N grows like the number of patches times log(1/error).
 */
HR2D_API hr2d_status hr2d_solve_to(const hr2d_scene *scene, const hr2d_target *target,
                                   hr2d_solution **solution, hr2d_account *account);

/** What a target will cost. */
typedef struct hr2d_prediction {
  unsigned order;    /**< p of the first solve */
  uint64_t elements; /**< N */
  uint64_t leaves;   /**< elements without children */
  uint64_t links;    /**< L */
  uint64_t bytes;    /**< of elements, links and blocks, of the finer solve for the error */
  double seconds;    /**< of hr2d_solve_to(), its account of the error included */
} hr2d_prediction;

/**
 * Predicts what hr2d_solve_to() will take, by making the elements and links and integrating
 * a few of the blocks.  Errors and parameters as there.  On a machine at rest `seconds` is
 * right within a factor of 2 for most scenes; tests/unit/accuracy/check-accuracy.c has the
 * list.
 */
HR2D_API hr2d_status hr2d_predict(const hr2d_scene *scene, const hr2d_target *target,
                                  hr2d_prediction *prediction);

/**
 * The error of any solution, of whatever oracle, policy and order: its distance from that of
 * hr2d_solve_to() for a target far below, whose own bound is added to make this bound.
 *
 * @param solution  of a scene that is still there
 * @param how       threads, budgets, progress; its `error` is the least distance that has to
 *                  be told from 0, relative; NULL for the defaults
 * @param average   receives the error in #HR2D_NORM_AVERAGE; may be NULL
 * @param sup       receives the error of hr2d_solution_at(), in #HR2D_NORM_SUP; may be NULL
 * @return as hr2d_solve_to(), but HR2D_OK where that returns HR2D_EACCURACY with a solution
 */
HR2D_API hr2d_status hr2d_solution_error(const hr2d_solution *solution, const hr2d_target *how,
                                         hr2d_error *average, hr2d_error *sup);

#ifdef __cplusplus
}
#endif
#endif
