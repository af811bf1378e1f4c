/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file enclosure.h
 * @brief Lower and upper ends of the mean radiosities of patches, without an assumption.
 *
 * @defgroup enclosure Enclosure
 * Lower and upper ends of the mean radiosities of patches, without an assumption.
 *
 * The estimate and the bound of hr2d_solve_to() come from more coefficients on the same
 * elements; errors that these do not show are assumed to be small. An enclosure assumes
 * nothing about B. It costs far more for a given number of digits: its gap falls like 1/L, or
 * like L^−1.5.
 *
 *     hr2d_enclosure *enclosure;
 *     hr2d_status status = hr2d_enclose(scene, NULL, &enclosure, NULL);
 *     if (!status)
 *       printf("B of patch 0 is from %.6g to %.6g\n", hr2d_enclosure_lower(enclosure, 0, 0),
 *              hr2d_enclosure_upper(enclosure, 0, 0));
 *     hr2d_enclosure_destroy(enclosure);
 *
 * **Method.** It goes back to Lischinski, Smits and Greenberg, "Bounds and Error Estimates for
 * Radiosity" (SIGGRAPH 1994). The kernel G V is never negative. On each element j B(y) is in a
 * strip between two straight lines, and its mean in a range. With F(x,j) = ∫j G V dy the light
 * from j that falls on a point x of an element i is
 *
 *     h(x) = ∫j G V B dy = F(x,j) mean(B) + A_j cov(G V, B),
 *
 * and its mean over i, with F_ij = AF/A_i, the exact exchange area of the pair, is
 *
 *     mean h = F_ij mean(B) + (A_j/A_i) cov(F(·,i), B).
 *
 * Where F(·,i) and B are between straight lines, their covariance is the product of the rises
 * of the middle lines by 12, and a rest that is at most a product of standard deviations. The
 * extremes of F along an element are known in closed form: F is half the difference of the
 * sines under which the ends of j appear, and its derivative vanishes at the roots of a
 * quadratic; a bound of its second derivative gives the strip. Pairs that see each other in
 * part have F(x,j) from 0 to that of a free view. So one sweep over all pairs makes new strips
 * of B = E + ρH from true ones, and the true B stays inside. It begins with 0 ≤ B ≤ max(max
 * E/(1 − max ρ), max E + max ρ · background).
 *
 * **Refinement.** All links join leaves. The leaves that contribute most to the gap are halved
 * until it is small enough: it falls like h³ on elements of length h with a free view, like h²
 * past edges of occluders, and L grows like h⁻².
 *
 * **Roundings** are in the ends: of factors, of sums, and of coordinates of elements, which are
 * off by a rounding for each level. So are the gaps that commit takes for touching (scene.h).
 * The sum of all is mostly below 1e-8.
 *
 * **Limits.** HR2D_EUNSUPPORTED refuses suns, and skies in pieces; periods in which patches
 * see for ever; patches of given heat flux, and negative E; a reflectance of 1. Mirrors, other
 * periods, several bands, given temperatures and an even background are enclosed. If black
 * backs are seen before a background, its light is enclosed between 0 and that of all
 * directions without fronts: such a gap does not become small.
 * @{
 */
#ifndef HR2D_ENCLOSURE_H
#define HR2D_ENCLOSURE_H

#include <hr2d/options.h>
#include <hr2d/progress.h>
#include <hr2d/scene.h>
#include <hr2d/solve.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Lower and upper ends of the means of B and of H over patches; opaque. */
typedef struct hr2d_enclosure hr2d_enclosure;

/** The default of hr2d_enclose_options::gap. */
#define HR2D_DEFAULT_GAP 1e-3

/** The default of hr2d_enclose_options::max_links. */
#define HR2D_DEFAULT_ENCLOSURE_LINKS 1000000

/** Options of hr2d_enclose(). Start from #HR2D_ENCLOSE_OPTIONS_INIT. */
typedef struct hr2d_enclose_options {
  size_t struct_size; /**< so that the struct can grow */
  double gap;         /**< the largest distance of an upper from a lower end that is wanted,
                           relative to the largest lower end of the band, of B and of H; 0
                           stands for #HR2D_DEFAULT_GAP */
  uint64_t max_links; /**< budget for L, some 100 bytes each; 0 stands for
                           #HR2D_DEFAULT_ENCLOSURE_LINKS */
  hr2d_progress_fn progress; /**< optional */
  void *progress_ctx;        /**< given to `progress` */
} hr2d_enclose_options;

/** The defaults: a gap of 1e-3, a million links, no callback. */
#define HR2D_ENCLOSE_OPTIONS_INIT                                                              \
  { sizeof(hr2d_enclose_options), 0, 0, NULL, NULL }

/**
 * Does what #HR2D_ENCLOSE_OPTIONS_INIT does, for languages without macros: sets all bytes to 0,
 * and `struct_size`.
 * @param options  the struct
 * @param size     its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_enclose_options_init(hr2d_enclose_options *options, size_t size);

/** The result and the work of hr2d_enclose(). */
typedef struct hr2d_enclosure_account {
  double gap;        /**< the largest distance of ends, as in hr2d_enclose_options; infinite
                          where nothing was enclosed, or where it is not known that the band has
                          any light at all */
  uint64_t elements; /**< N */
  uint64_t leaves;   /**< elements without children */
  uint64_t links;    /**< L */
  uint64_t rounds;   /**< how often leaves were halved */
  uint64_t sweeps;   /**< sweeps over all links, of all rounds */
  double seconds;    /**< time */
  char reason[400];  /**< why the gap was not reached, or why the scene is refused; "" if
                          neither */
} hr2d_enclosure_account;

/**
 * Encloses the means of B and H over all patches.
 * @param scene      committed; must outlive the enclosure
 * @param options    NULL for the defaults
 * @param enclosure  receives the enclosure, also with HR2D_EACCURACY, otherwise NULL; the
 *                   caller destroys it
 * @param account    receives the gap and the work; may be NULL
 * @retval HR2D_OK            the gap is reached
 * @retval HR2D_EACCURACY     it is not; the enclosure is the best that was reached, and true
 * @retval HR2D_ENOMEM        an allocation failed
 * @retval HR2D_EINVAL        an option is not valid
 * @retval HR2D_ESTATE        the scene is not committed
 * @retval HR2D_EUNSUPPORTED  something in the scene is not enclosed, see above; `reason` names
 *                            it, and a remedy
 * @retval other              the status of the progress callback
 *
 * Scenes, and one scene, may be enclosed from different threads. The same bits on every run.
 * Cost: O(L) for each of some ten sweeps; L grows like 1/gap.
 */
HR2D_API hr2d_status hr2d_enclose(const hr2d_scene *scene, const hr2d_enclose_options *options,
                                  hr2d_enclosure **enclosure, hr2d_enclosure_account *account);

/**
 * Destroys an enclosure.
 * @param enclosure  may be NULL
 */
HR2D_API void hr2d_enclosure_destroy(hr2d_enclosure *enclosure);

/**
 * The lower end of the average of B over a patch.
 * @param enclosure  an enclosure
 * @param patch      the index of a patch
 * @param band       a band
 * @return in the unit of E; hr2d_solution_average() of the exact solution is not below
 */
HR2D_API double hr2d_enclosure_lower(const hr2d_enclosure *enclosure, size_t patch,
                                     size_t band);

/**
 * The upper end of the average of B over a patch.
 * @param enclosure  an enclosure
 * @param patch      the index of a patch
 * @param band       a band
 * @return in the unit of E; the exact average is not above
 */
HR2D_API double hr2d_enclosure_upper(const hr2d_enclosure *enclosure, size_t patch,
                                     size_t band);

/**
 * The lower end of the average of the irradiance H over a patch.
 * @param enclosure  an enclosure
 * @param patch      the index of a patch
 * @param band       a band
 * @return in the unit of E
 */
HR2D_API double hr2d_enclosure_lower_irradiance(const hr2d_enclosure *enclosure, size_t patch,
                                                size_t band);

/**
 * The upper end of the average of the irradiance H over a patch.
 * @param enclosure  an enclosure
 * @param patch      the index of a patch
 * @param band       a band
 * @return in the unit of E
 */
HR2D_API double hr2d_enclosure_upper_irradiance(const hr2d_enclosure *enclosure, size_t patch,
                                                size_t band);

/**
 * The error of a solution, for certain: in #HR2D_NORM_AVERAGE of accuracy.h no average is
 * further from the exact one. It is the distance from the farther end, relative to the lower
 * end of the average, which counts as no less than `floor` times the largest of the band.
 * @param enclosure   of the scene of the solution
 * @param solution    of any oracle, policy and order
 * @param floor       as hr2d_target::floor; 0 stands for #HR2D_FLOOR
 * @param average     receives the error of averages of B; infinite if nothing is known
 * @param irradiance  that of H; each may be NULL
 * @retval HR2D_OK      success
 * @retval HR2D_EINVAL  the solution is of another scene, or `floor` is not from 0 to 1
 *
 * An error that is much below the gap cannot be distinguished from it.
 */
HR2D_API hr2d_status hr2d_enclosure_error(const hr2d_enclosure *enclosure,
                                          const hr2d_solution *solution, double floor,
                                          double *average, double *irradiance);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
