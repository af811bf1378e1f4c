/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file gas.h
 * @brief Grey gases between the patches that absorb and emit.
 *
 * @defgroup gas Gas: an absorbing medium
 * A grey gas between the patches that absorbs and emits.
 *
 * A gas fills the whole plane, or a polygon. It absorbs the part κ of what passes per length,
 * and emits isotropically: a black body of its temperature would have the radiosity E_g. At the
 * distance r the part T(κr) of the light arrives, and the gas on the way adds (1 − T)E_g. With
 * the lines of their directions, AF_ij = ½∫∫ T dp dθ, and with G_i, the integral of 1 − T over
 * all lines that leave i,
 *
 *     B = E + ρH,   A_i H_i = Σ AF_ij B_j + G_i E_g,   heat of the gas = Σ G_i (E_g − B_i).
 *
 * In a closed room Σ AF_ij + G_i = A_i. Isothermal scenes are isothermal on any elements, and
 * thin gas keeps all digits of its heat: κ may be 1e-12 or 1e6.
 *
 * **Section.** In the section of a long enclosure (#HR2D_SECTION_LONG) lines also leave the
 * plane: T(x) = (4/π) Ki₃(x), a Bickley function. Between infinite plates that is the plane
 * layer of textbooks, 2E₃. In a flat world (#HR2D_SECTION_FLAT) T(x) = e^−x. A thin gas emits
 * 4κE_g, or πκE_g, per area of the section.
 *
 * **Heat.** Of a gas whose heat Q is given, 0 in a furnace whose flue gas neither burns nor
 * flows, the temperature follows: E_g = (Q + ∑ G_i B_i)/∑ G_i. It is one more patch that sees
 * all others. Needs a closed scene of one band. Where Q is so negative that E_g would be, or
 * nothing absorbs, solves return HR2D_ENO_SOLUTION.
 *
 * **Borders.** A gas with a border fills a polygon, the one without what is left; where they
 * overlap the gas counts that was added last. Borders are no walls: they may touch, cross and
 * reach into walls, and may cross themselves (the even-odd rule). On a line with depths x_k at
 * borders, gas k takes D(x_k) − D(x_{k−1}) and sends so much of E_k, with D = 1 − T; gases
 * exchange second differences of D. Those of given heat are as hot as all together make them.
 * Needs a closed scene without mirrors and period. A pair of elements with borders between
 * costs a rule for each part that these divide its lines into, one without what it costs in one
 * gas; patches do not exchange by clusters.
 *
 * **Bands.** κ may differ from band to band: a weighted sum of grey gases has a band for each
 * of them, hr2d_scene_set_weights(), and one in which nothing absorbs. Bands of equal κ share
 * their blocks, and cost as much as one; each other κ has blocks and an equation of its own on
 * the same elements. A band with κ = 0 is as in a scene without gas.
 *
 * **Open scenes.** A line that meets no patch stays in gas for ever, and brings E_g.
 *
 * **Points.** hr2d_solution_gather() and its companions, and hr2d_field_at() and
 * hr2d_field_on_grid() see through gas. The mean M around a point has Ki₂ in the place of
 * (4/π)Ki₃; the gas there gives 4κ(E_g − M) per area of the section, or πκ(E_g − M) in a flat
 * world, which is ∇·q for a code of fluid dynamics. A grid with a tolerance has borders of
 * light where a wall goes out of sight, also before walls as bright: gas in front of them is as
 * deep as they are far.
 *
 * **What goes through gas.** hr2d_solve(), hr2d_solve_to(), what is read from their solutions,
 * and points as above, with their errors. In a scene with gas these return HR2D_EUNSUPPORTED,
 * as the whole list of what this version does not do: the oracles `l1`, `l1-grid` and `bounds`;
 * fields with a period; view factors and exchange matrices, operators, enclosures, states,
 * shares, and predictions. So does hr2d_scene_commit() if the scene has light of a background,
 * a sky or a sun in a band that gas absorbs, a period of which images are cut off, more than
 * 256 different κ, a border of a gas beside mirrors or a period, patches of given flux in
 * several bands, or a gas of given heat in several bands; and hr2d_solve() if patches see the
 * backs of others.
 *
 * Exchange areas of links (hr2d_link::exchange_area) are those without gas.
 * @{
 */
#ifndef HR2D_GAS_H
#define HR2D_GAS_H

#include <hr2d/scene.h>
#include <hr2d/solve.h>
#include <hr2d/status.h>
#include <hr2d/thermal.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What the plane of the scene is a section of. */
typedef enum hr2d_section {
  HR2D_SECTION_LONG = 0, /**< a long enclosure */
  HR2D_SECTION_FLAT      /**< nothing else: a flat world */
} hr2d_section;

/** A gas. Start from #HR2D_GAS_INIT. */
typedef struct hr2d_gas {
  size_t struct_size;       /**< so that the struct can grow */
  const double *absorption; /**< κ ≥ 0 per scene length; copied */
  size_t absorption_bands;  /**< number of values: one per band, or one for all; 0: κ = 0 */
  const double *emission;   /**< E_g ≥ 0 in the unit of E, unless T is given; copied */
  size_t emission_bands;    /**< number of values; 0: the gas is cold */
  hr2d_heat given;          /**< HR2D_HEAT_TEMPERATURE: `value` is T in kelvin, from which E_g
                                 follows: σT⁴, in each band its part of it. HR2D_HEAT_FLUX:
                                 `value` is the heat that the gas gives to patches, per length
                                 of the enclosure, over all its area, and with mirrors over
                                 that of the part that is drawn; 0: none. E_g follows */
  double value;             /**< as `given` says */
  hr2d_section section;     /**< how lines leave the plane; the same for all gases */
  const hr2d_point *border; /**< the corners of a polygon that the gas fills, in any order of
                                 rotation; copied */
  size_t border_points;     /**< at least 3; 0: the gas fills what is left */
} hr2d_gas;

/** No gas: κ = 0. */
#define HR2D_GAS_INIT                                                                          \
  { sizeof(hr2d_gas), NULL, 0, NULL, 0, HR2D_HEAT_NONE, 0, HR2D_SECTION_LONG, NULL, 0 }

/**
 * Does what #HR2D_GAS_INIT does, for languages without macros: sets all bytes to 0, and
 * `struct_size`.
 * @param gas   the struct
 * @param size  its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_gas_init(hr2d_gas *gas, size_t size);

/**
 * Fills the scene, or a polygon of it, with a gas. With κ = 0 in all bands everything is as
 * without one, to the bit.
 *
 * @param scene  not yet committed
 * @param gas    the gas; copied
 * @param index  receives the index of the gas; may be NULL
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a number of bands or of points without values; both E_g and T; `given`
 *                      or `section` outside of its enumeration; or `struct_size` is not set
 * @retval HR2D_ESTATE  the scene is committed
 * @retval HR2D_ESCENE  κ, E_g or T is negative or not finite, the heat is not finite, E_g is
 *                      beyond a double, κ and E_g have different numbers of bands, the border
 *                      has one or two points or one that is not finite, or the section is not
 *                      that of the gas before
 * @retval HR2D_EUNSUPPORTED  the scene has a gas without border already, and this one has none
 */
HR2D_API hr2d_status hr2d_scene_add_gas(hr2d_scene *scene, const hr2d_gas *gas, size_t *index);

/**
 * The number of gases.
 * @param scene  a scene
 * @return so many were added
 */
HR2D_API size_t hr2d_scene_gases(const hr2d_scene *scene);

/**
 * κ in one band.
 * @param scene  a scene
 * @param gas    the index of a gas
 * @param band   below hr2d_scene_bands()
 * @return κ per scene length; NaN if there is no such gas or band
 */
HR2D_API double hr2d_scene_absorption(const hr2d_scene *scene, size_t gas, size_t band);

/**
 * What a solution says of the gas in one band.
 * @param solution  a solution
 * @param gas       the index of a gas
 * @param band      below hr2d_scene_bands()
 * @param emission  receives E_g; may be NULL
 * @param heat      receives what the gas emits to patches and to other gases less what it
 *                  absorbs of their light, in the unit of E times scene lengths; may be NULL
 * @retval HR2D_OK      success
 * @retval HR2D_EINVAL  there is no such gas or band, or `solution` is NULL
 *
 * In a closed room `heat` has all relative digits that B has, however thin the gas is. Of all
 * gases together it is hr2d_power::received less hr2d_power::escaped, which has the same.
 */
HR2D_API hr2d_status hr2d_solution_gas(const hr2d_solution *solution, size_t gas, size_t band,
                                       double *emission, double *heat);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
