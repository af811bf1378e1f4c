/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file solve.h
 * @brief From links to radiosity: B = E + ρ ∫ G V B (paper, equations 1 and 2).
 *
 * Light is gathered over the links of all levels, pushed down to the leaves and
 * pulled up as averages.  With one link for both directions the operator is
 * symmetric and conjugate gradients solve it for every ρ; directed links take
 * BiCGSTAB.  All bands are solved at once.  Where every ρ is 0 nothing is iterated.
 * At an order p above 1 (hr2d_hierarchy_set_order()) each link first gets its p × p block
 * ∫∫ G V φ_l φ_m, with Legendre polynomials φ: exact where elements are near, touch or see
 * each other in part; blocks are kept for the next solve.
 *
 * Closure adds d·B on each leaf, d being what its row of the discrete kernel misses
 * of the exact ∫ G.  A closed room of E = 1−ρ then has B = 1 exactly, no light is
 * lost or made, and at order 1 the discrete equation has one solution wherever ρ < 1;
 * without it rows may exceed 1 and a coarse solve with ρ near 1 need not converge.  At a
 * low order above 1 that may happen in narrow corners in spite of it: HR2D_ENOT_CONVERGED.
 *
 * How many digits: let λ be the part of its light that a component of patches that exchange
 * light loses at each reflection, (∫(1−ρ) + what escapes)/∫1.  What roundings do to B grows
 * like 1/λ, unless they are balanced: with closure and one link for both directions,
 *  - where nothing escapes, ∫(1−ρ)H = ∫E to 1e-14 and B is good to 1e-13, however small λ is:
 *    1−ρ is exact in a double, from ρ = ½ to 1 − 2⁻⁵³;
 *  - where something escapes, to 1e-13 + 2⁻⁵²/λ, since that is how well exchange areas tell
 *    what does.  Less than 1e-13 of all light is told to be none.
 * Without closure or with directed links it is 1e-13/λ.  All this is rounding; the error of
 * finite elements and links comes besides, see accuracy.h.  E may be as small or as large as a
 * double can be, also in one band beside another.
 *
 * Of its own discrete equation a solution B differs from the exact one, B_d, in the norm ∫B² by
 * no more than (tolerance + 1e-15) ‖B_d‖ / (1 − max ρ), in a closed room at order 1 with
 * closure (tests/bounds/check-bounds-solution.c); averages share that, and hr2d_solution_at()
 * on leaves. hr2d_solution_gather() adds the roundings of one gather to the error of B_h, times
 * ρ.
 */
#ifndef HR2D_SOLVE_H
#define HR2D_SOLVE_H

#include <hr2d/linkset.h>
#include <hr2d/refine.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Radiosity on every element of a hierarchy; opaque. */
typedef struct hr2d_solution hr2d_solution;

/** How to solve.  Start from #HR2D_SOLVE_OPTIONS_INIT. */
typedef struct hr2d_solve_options {
  size_t struct_size; /**< so that the options can grow */
  double tolerance;   /**< stop when ‖residual‖ ≤ tolerance·‖B‖, in each band, in
                           the norm ∫B²; at least 1e-15, and finite */
  unsigned max_iterations;    /**< give up with HR2D_ENOT_CONVERGED after so many */
  unsigned threads;           /**< 0 for all; the result does not depend on it, bit for bit */
  int closure;                /**< 1: the exchange of every leaf with all others is exact; 0:
                                   the paper's algorithm as it stands, whose coarse links
                                   spread their exchange evenly over the leaves below */
  const hr2d_solution *start; /**< warm start: a solution on the same hierarchy, perhaps
                                   before it was refined further; NULL: none */
  hr2d_progress_fn progress;  /**< optional */
  void *progress_ctx;         /**< given to `progress` */
} hr2d_solve_options;

/** Tolerance 1e-15, at most 10000 iterations, one thread, with closure. */
#define HR2D_SOLVE_OPTIONS_INIT                                                                \
  { sizeof(hr2d_solve_options), 1e-15, 10000, 1, 1, NULL, NULL, NULL }

/** Where the power of one band goes; power per length across the plane; infinite where that is
    beyond a double. */
typedef struct hr2d_power {
  double emitted;  /**< ∫ E */
  double received; /**< what comes in from the background */
  double absorbed; /**< ∫ (1−ρ) H, with H the irradiance */
  double escaped;  /**< what leaves through the openings of the scene, or meets the back of
                        a patch that has a front only: B·(A − Σ AF) */
} hr2d_power;

/** What a solve took. */
typedef struct hr2d_solve_work {
  uint64_t gathers;         /**< gathers over all links; one serves all bands */
  uint64_t iterations;      /**< of the Krylov method; 0 where nothing reflects */
  uint64_t row_sums;        /**< leaves whose exchange with all patches was summed: for
                                 closure in open scenes, and for the background */
  uint64_t background_rows; /**< of these, leaves whose view of the background was needed */
  uint64_t kernels;         /**< values of G it took to integrate blocks, at an order above 1 */
  double coefficients_seconds; /**< wall time of that */
} hr2d_solve_work;

/**
 * Solves for B.
 *
 * @param links     filled by hr2d_refine()
 * @param options   NULL for the defaults
 * @param solution  receives the solution; the caller destroys it
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_EINVAL, HR2D_ESTATE for an empty set of a scene whose
 *         patches do see each other, and from a callback of a call that refines or solves on
 *         these links, HR2D_ENO_SOLUTION where light is emitted in a
 *         closed part of the scene in which nothing absorbs (the message names the
 *         patch; without light B is 0 there), HR2D_ENOT_CONVERGED after max_iterations or
 *         where rows of links exceed 1 so far that light would grow for ever, HR2D_ERANGE
 *         where B is beyond a double, or the status of the progress callback
 *
 * Cost O((N + L)·bands) per iteration.  Different link sets may be solved from
 * different threads.
 */
HR2D_API hr2d_status hr2d_solve(hr2d_linkset *links, const hr2d_solve_options *options,
                                hr2d_solution **solution);

/** Destroys a solution; NULL is allowed. */
HR2D_API void hr2d_solution_destroy(hr2d_solution *solution);

/** The average of B over patch `patch` in band `band`, in the unit of E. */
HR2D_API double hr2d_solution_average(const hr2d_solution *solution, size_t patch, size_t band);

/**
 * B at fraction t of a patch, counted from its start: the constant of the leaf
 * that holds the point, and on the border of two leaves the straight line between the
 * values at their centres; at an order above 1 the leaf's polynomial.  The back of a two-sided
 * patch starts where its front ends.
 * @param t  in [0,1]
 */
HR2D_API double hr2d_solution_at(const hr2d_solution *solution, size_t patch, double t,
                                 size_t band);

/**
 * B at points of a patch after one more gather, B' = E + ρ ∫ G V B_h, with G and V exact: far
 * better than hr2d_solution_at(), in which B jumps from leaf to leaf, and dearer.
 *
 * @param t       `count` fractions of the patch in [0,1], counted from its start; where the
 *                end of another stands there B is that of one side of it
 * @param value   receives count × bands values
 * @return HR2D_OK or HR2D_ENOMEM
 * Several threads may ask one solution at once.  Cost O(N) per point, and where the scene calls
 * for occlusion O(n log n).
 */
HR2D_API hr2d_status hr2d_solution_gather(const hr2d_solution *solution, size_t patch,
                                          const double *t, size_t count, double *value);

/** The links a solution was made from, and through them its elements. */
HR2D_API const hr2d_linkset *hr2d_solution_links(const hr2d_solution *solution);

/** The average of B over an element. */
HR2D_API double hr2d_solution_element(const hr2d_solution *solution, uint32_t element,
                                      size_t band);

/**
 * The average irradiance H over patch `patch`: what arrives per length, from other
 * patches and from the background, in the unit of E.
 */
HR2D_API double hr2d_solution_irradiance(const hr2d_solution *solution, size_t patch,
                                         size_t band);

/** H at fraction t of a patch, as hr2d_solution_at(). */
HR2D_API double hr2d_solution_irradiance_at(const hr2d_solution *solution, size_t patch,
                                            double t, size_t band);

/** The net flux B − H that leaves patch `patch`, per length; negative where it gains. */
HR2D_API double hr2d_solution_net_flux(const hr2d_solution *solution, size_t patch,
                                       size_t band);

/** Where the power of a band goes; emitted + received = absorbed + escaped. */
HR2D_API hr2d_power hr2d_solution_power(const hr2d_solution *solution, size_t band);

/** What the solve took. */
HR2D_API hr2d_solve_work hr2d_solution_work(const hr2d_solution *solution);

/** The largest relative residual over the bands, computed from B itself. */
HR2D_API double hr2d_solution_residual(const hr2d_solution *solution);

#ifdef __cplusplus
}
#endif
#endif
