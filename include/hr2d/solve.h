/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file solve.h
 * @brief From links to radiosity: B = E + ρ ∫ G V B (paper, equations 1 and 2).
 *
 * @defgroup solve Solve
 * From links to radiosity: B = E + ρ ∫ G V B (paper, equations 1 and 2).
 *
 * **Method.** Light is gathered over the links of all levels, pushed down to the leaves and
 * pulled up as averages. If each link serves both directions, the operator is symmetric, and
 * conjugate gradients solve it for every ρ. Directed links take BiCGSTAB. All bands are solved
 * at once. If every ρ is 0, nothing is iterated.
 *
 * **Order.** At an order p above 1 (hr2d_hierarchy_set_order()) each link first gets its p × p
 * block ∫∫ G V φ_l φ_m, with Legendre polynomials φ. Blocks are exact if elements are near,
 * touch or see each other in part. They are kept for the next solve.
 *
 * **Closure** makes ∫ G of every leaf exact: the row sum of the leaf in the discrete kernel. At
 * order 1 a link spreads its exchange over the leaves below by the parts of these sums that
 * come from above, instead of evenly; at an order above 1, d·B is added on each leaf, with d
 * the part of ∫ G that its row lacks. The mean of d over a patch is a rounding; it multiplies H
 * and not B where H is reported, since a lamp may get much less light than it sends. With
 * closure
 * - a closed room with E = 1−ρ has B = 1 exactly;
 * - no light is lost or created;
 * - at order 1 the discrete equation has one solution if ρ < 1.
 *
 * Switch closure off to measure the paper's algorithm as it is; and at an order above 1 if all
 * light that is reflected comes from patches of constant B, as a sky or black lamps. There
 * averages are exact without closure, and d·B adds an error like that of elements, 1e-4 to
 * 1e-7. At order 1 such averages are exact with closure, too
 * (tests/unit/solve/check-closure.c). Elsewhere at order 1 the errors of elements differ: over
 * random scenes those of averages are half as large with closure on the mean and those of
 * leaves a tenth, but in one of seven scenes an average is better without.
 *
 * Without closure rows may exceed 1, and a coarse solve with ρ near 1 need not converge. At a
 * low order above 1 this can happen in narrow corners even with closure: HR2D_ENOT_CONVERGED.
 *
 * **Rounding.** A component is a set of patches that exchange light. Let λ be the part of its
 * light that a component loses at each reflection: λ = (∫(1−ρ) + escape)/∫1. The effect of
 * roundings on B grows like 1/λ unless they are balanced. They are balanced with closure if
 * links serve both directions:
 * - If nothing escapes, ∫(1−ρ)H = ∫E to 1e-14 and B is accurate to 1e-13 for any λ. The reason
 *   is that 1−ρ is exact in a double, from ρ = ½ to 1 − 2⁻⁵³.
 * - If something escapes, B is accurate to 1e-13 + 2⁻⁵²/λ. Exchange areas do not give the
 *   escape more accurately. An escape of less than 1e-14 of all light counts as zero; the check
 *   for HR2D_ENO_SOLUTION counts less than 1e-13 as zero.
 *
 * Without closure or with directed links B is accurate to 1e-13/λ. All this is rounding only;
 * the error of finite elements and links adds to it, see accuracy.h. E may have any magnitude
 * of a double, and different magnitudes in different bands.
 *
 * **Error of the discrete solution.** In a closed room at order 1 with closure, B differs from
 * the exact solution B_d of the discrete equation, in the norm ∫B², by
 *
 *     ‖B − B_d‖ ≤ (tolerance + 1e-15) ‖B_d‖ / (1 − max ρ)
 *
 * (tests/bounds/check-bounds-solution.c). Averages, and hr2d_solution_at() on leaves, have the
 * same error. hr2d_solution_gather() has this error of B_h plus the roundings of one gather,
 * times ρ.
 * @{
 */
#ifndef HR2D_SOLVE_H
#define HR2D_SOLVE_H

#include <hr2d/linkset.h>
#include <hr2d/options.h>
#include <hr2d/refine.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Radiosity on every element of a hierarchy; opaque. */
typedef struct hr2d_solution hr2d_solution;

/** The default of hr2d_solve_options::tolerance, and the least tolerance. */
#define HR2D_DEFAULT_TOLERANCE 1e-15

/** The default of hr2d_solve_options::max_iterations. */
#define HR2D_DEFAULT_MAX_ITERATIONS 10000

/** Whether a solve uses closure; see above. */
typedef enum hr2d_closure {
  HR2D_CLOSURE_DEFAULT = 0, /**< as HR2D_CLOSURE_ON */
  HR2D_CLOSURE_ON,          /**< the exchange of every leaf with all others is exact */
  HR2D_CLOSURE_OFF          /**< the paper's algorithm unchanged: coarse links spread their
                                 exchange evenly over the leaves below */
} hr2d_closure;

/** Options of a solve. Start from #HR2D_SOLVE_OPTIONS_INIT. */
typedef struct hr2d_solve_options {
  size_t struct_size; /**< so that the options can grow */
  double tolerance;   /**< stop when ‖residual‖ ≤ tolerance·‖B‖ in each band, in the
                           norm ∫B², and also ∫|residual| ≤ max(tolerance, 1e-13)·∫B; at
                           least 1e-15, and finite; 0 stands for #HR2D_DEFAULT_TOLERANCE */
  unsigned max_iterations; /**< after this number stop with HR2D_ENOT_CONVERGED; 0 stands for
                                #HR2D_DEFAULT_MAX_ITERATIONS */
  unsigned threads;        /**< 0 for one, or #HR2D_ALL_THREADS; the result does not depend on
                                it, bit for bit */
  hr2d_closure closure;    /**< on by default */
  const hr2d_solution *start; /**< warm start: a solution on the same hierarchy, perhaps older
                                   than its last refinement; NULL: none. If it solves the
                                   equation already, to 1e-11 of the largest B and H on the
                                   same elements, the new solution has its bits */
  hr2d_progress_fn progress;  /**< optional */
  void *progress_ctx;         /**< given to `progress` */
} hr2d_solve_options;

/** The defaults: tolerance 1e-15, at most 10000 iterations, one thread, with closure. */
#define HR2D_SOLVE_OPTIONS_INIT                                                                \
  { sizeof(hr2d_solve_options), 0, 0, 0, HR2D_CLOSURE_DEFAULT, NULL, NULL, NULL }

/**
 * Does what #HR2D_SOLVE_OPTIONS_INIT does, for languages without macros: sets all bytes to 0,
 * and `struct_size`.
 * @param options  the struct
 * @param size     its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_solve_options_init(hr2d_solve_options *options, size_t size);

/**
 * The balance of the power of one band, per length perpendicular to the plane. A sum beyond the
 * range of a double is infinite.
 */
typedef struct hr2d_power {
  double emitted;  /**< ∫ E */
  double received; /**< power that comes in from the background and the suns */
  double absorbed; /**< ∫ (1−ρ) H, with H the irradiance */
  double escaped;  /**< power that leaves through the openings of the scene, or meets the back
                        of a patch that has only a front: B·(A − Σ AF) */
} hr2d_power;

/** The work of a solve. */
typedef struct hr2d_solve_work {
  uint64_t gathers;         /**< gathers over all links; one serves all bands */
  uint64_t iterations;      /**< iterations of the Krylov method; 0 if nothing reflects */
  uint64_t row_sums;        /**< leaves whose exchange with all patches was summed: for closure
                                 in open scenes, and for the background */
  uint64_t background_rows; /**< of these, leaves whose view of the background was needed */
  uint64_t kernels;         /**< to integrate blocks, at an order above 1: values of G at two
                                 points, or integrals of G over the lines of one direction */
  double coefficients_seconds; /**< wall time of this integration */
} hr2d_solve_work;

/**
 * Solves for B.
 * @param links     filled by hr2d_refine(); must outlive the solution
 * @param options   NULL for the defaults
 * @param solution  receives the solution; the caller destroys it
 * @retval HR2D_OK             success
 * @retval HR2D_ENOMEM         an allocation failed
 * @retval HR2D_EINVAL         `tolerance`, `closure` or `struct_size` is out of range, or
 *                             `start` is on another hierarchy
 * @retval HR2D_ESTATE         the set was never refined, or the call comes from a callback of a
 *                             call that refines or solves these links
 * @retval HR2D_ENO_SOLUTION   light is emitted in a closed part of the scene in which nothing
 *                             absorbs; the message names the patch. Without light B is 0 there.
 *                             Or a given flux takes away more heat than there is (thermal.h)
 * @retval HR2D_ECALLBACK      a function of emissivity gives a value that is none
 * @retval HR2D_ENOT_CONVERGED `max_iterations` are done, or rows of links exceed 1 so far that
 *                             light would grow for ever, or powers are not balanced to 1e-9
 *                             because lengths differ too much
 * @retval HR2D_ERANGE         B is beyond the range of a double
 * @retval other               the status of the progress callback
 *
 * The solution stays valid if its links are refined or solved again. Different link sets may be
 * solved from different threads. Cost O((N + L)·p²·bands) per iteration.
 */
HR2D_API hr2d_status hr2d_solve(hr2d_linkset *links, const hr2d_solve_options *options,
                                hr2d_solution **solution);

/**
 * Destroys a solution.
 * @param solution  may be NULL
 */
HR2D_API void hr2d_solution_destroy(hr2d_solution *solution);

/**
 * The average of B over a patch.
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param band      a band
 * @return the average, in the unit of E
 */
HR2D_API double hr2d_solution_average(const hr2d_solution *solution, size_t patch, size_t band);

/**
 * B at a point of a patch.
 *
 * At order 1 it is the constant of the leaf that contains the point; on the border of two
 * leaves it is on the straight line between the values at their centres. At an order above 1 it
 * is the polynomial of the leaf, on a border the mean of both. The back of a two-sided patch
 * starts where its front ends.
 *
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param t         fraction of the patch in [0,1], counted from its start
 * @param band      the band
 * @return B in the unit of E; cost: one step per level
 */
HR2D_API double hr2d_solution_at(const hr2d_solution *solution, size_t patch, double t,
                                 size_t band);

/**
 * B at points of a patch after one more gather: B' = E + ρ ∫ G V B_h, with G and V exact.
 *
 * Far more accurate than hr2d_solution_at(), in which B jumps from leaf to leaf, and more
 * expensive.
 *
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param t         `count` fractions of the patch in [0,1], counted from its start; where
 *                  another patch touches this point, B is the limit from the inside of
 *                  this patch, on the side of its middle
 * @param count     number of points
 * @param value     receives `count` × bands values in the unit of E, point by point
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 *
 * Several threads may ask one solution at once. Cost per point: that of the elements that it
 * sees, plus 0.1 µs for each triangle of the plane that its view passes if the scene calls
 * for occlusion, else O(n).
 */
HR2D_API hr2d_status hr2d_solution_gather(const hr2d_solution *solution, size_t patch,
                                          const double *t, size_t count, double *value);

/**
 * The irradiance H at points of a patch after one more gather: H' = ∫ G V B_h plus the light
 * from the background and the sun, with G and V exact. Patches that reflect nothing have it,
 * too.
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param t         `count` fractions of the patch, as for hr2d_solution_gather()
 * @param count     the number of points
 * @param value     receives `count` × bands values in the unit of E
 * @return as hr2d_solution_gather(), with its cost
 */
HR2D_API hr2d_status hr2d_solution_gather_irradiance(const hr2d_solution *solution,
                                                     size_t patch, const double *t,
                                                     size_t count, double *value);

/**
 * The net flux B − H = E − (1−ρ) H' at points of a patch; negative where the patch gains.
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param t         `count` fractions of the patch, as for hr2d_solution_gather()
 * @param count     the number of points
 * @param value     receives `count` × bands values in the unit of E
 * @return as hr2d_solution_gather(), with its cost
 */
HR2D_API hr2d_status hr2d_solution_gather_net_flux(const hr2d_solution *solution, size_t patch,
                                                   const double *t, size_t count,
                                                   double *value);

/**
 * The links from which a solution was made, and through them its elements.
 * @param solution  a solution
 * @return the link set; a solution of hr2d_solve_to() owns it, and with many patches the set
 *         lacks the links between clusters
 */
HR2D_API const hr2d_linkset *hr2d_solution_links(const hr2d_solution *solution);

/**
 * The coefficients of B, for a user-written solver or file.
 * @param solution  a solution
 * @return the coefficients of all elements that existed at the solve, in the form of
 *         hr2d_hierarchy_pull() and hr2d_solution_adopt(); owned by the solution. Unlike
 *         averages they may be below 0 by roundings
 */
HR2D_API const double *hr2d_solution_field(const hr2d_solution *solution);

/**
 * The size of hr2d_solution_field().
 * @param solution  a solution
 * @return how many numbers it has: elements at the solve × order × bands; 0 for NULL
 */
HR2D_API size_t hr2d_solution_field_size(const hr2d_solution *solution);

/**
 * The average of B over an element.
 * @param solution  a solution
 * @param element   number of an element that existed at the solve
 * @param band      the band
 * @return the average, in the unit of E
 */
HR2D_API double hr2d_solution_element(const hr2d_solution *solution, uint32_t element,
                                      size_t band);

/**
 * The average of H over an element: of the solution's H itself, which
 * hr2d_solution_irradiance() averages over a patch. An average of
 * hr2d_solution_irradiance_at(), which is nowhere below 0, may be larger.
 * @param solution  a solution
 * @param element   number of an element that existed at the solve
 * @param band      the band
 * @return the average, in the unit of E. Where images of a period are cut off (symmetry.h)
 *         averages over patches are far better than those over their elements: there
 *         hr2d_solution_gather_irradiance() has the better values
 */
HR2D_API double hr2d_solution_element_irradiance(const hr2d_solution *solution,
                                                 uint32_t element, size_t band);

/**
 * The average over a patch of the irradiance H, which arrives from other patches, from the
 * background and from the sun. Without the last part it is H less hr2d_scene_sunlight().
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param band      a band
 * @return H, power per length, in the unit of E
 */
HR2D_API double hr2d_solution_irradiance(const hr2d_solution *solution, size_t patch,
                                         size_t band);

/**
 * H at a point of a patch, computed as in hr2d_solution_at().
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param t         fraction of the patch in [0,1], counted from its start
 * @param band      the band
 * @return H in the unit of E
 */
HR2D_API double hr2d_solution_irradiance_at(const hr2d_solution *solution, size_t patch,
                                            double t, size_t band);

/**
 * The average net flux B − H that leaves a patch.
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param band      a band
 * @return B − H, power per length, in the unit of E; negative if the patch gains power
 */
HR2D_API double hr2d_solution_net_flux(const hr2d_solution *solution, size_t patch,
                                       size_t band);

/**
 * The net power that leaves a patch: the integral of B − H over it.
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param band      a band
 * @return power in the unit of E times a scene length; with temperatures W per metre across the
 *         section. Negative if the patch gains power. hr2d_solution_temperatures() has its sum
 *         over the bands, with the bound of its error
 */
HR2D_API double hr2d_solution_net_power(const hr2d_solution *solution, size_t patch,
                                        size_t band);

/**
 * The balance of the power of a band.
 * @param solution  a solution
 * @param band      a band
 * @return the balance: emitted + received = absorbed + escaped
 */
HR2D_API hr2d_power hr2d_solution_power(const hr2d_solution *solution, size_t band);

/**
 * The uncertainty of that balance because images of a period are cut off (symmetry.h).
 * @param solution  a solution
 * @param band      a band
 * @return the error that `received` and `escaped` may each have from this; that of `absorbed`
 *         follows from the averages of H. 0 if no visible image is cut off; infinite if it is
 *         unknown, as after hr2d_solve_to() in a time that does not suffice. Averages may be
 *         known much better: in an isothermal scene light that patches seem to lack comes from
 *         the background
 */
HR2D_API double hr2d_solution_power_cut_off(const hr2d_solution *solution, size_t band);

/**
 * The work of the solve.
 * @param solution  a solution
 * @return counts and times
 */
HR2D_API hr2d_solve_work hr2d_solution_work(const hr2d_solution *solution);

/**
 * The largest relative residual over the bands, computed from B itself.
 * @param solution  a solution
 * @return the residual, dimensionless
 */
HR2D_API double hr2d_solution_residual(const hr2d_solution *solution);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
