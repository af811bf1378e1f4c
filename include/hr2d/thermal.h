/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file thermal.h
 * @brief Patches with a temperature or a net heat flux, and the temperatures that follow.
 *
 * @defgroup thermal Thermal: temperatures and heat fluxes
 * Patches with a temperature or a net heat flux, and the temperatures that follow.
 *
 * Lengths are in metres, E, B, H and q in W/m², T in kelvin, σ is #HR2D_STEFAN_BOLTZMANN.
 *
 * | given       | in the equation B = E + ρH | found              |
 * |-------------|----------------------------|--------------------|
 * | T and ε     | ρ = 1 − ε, E = (1 − ρ)σT⁴  | q = E − (1 − ρ)H   |
 * | q and ε     | ρ = 1, E = q               | σT⁴ = H + q/ε      |
 *
 * q is the net heat flux that leaves the patch into the scene. It is 0 on an insulated, that is
 * adiabatic, wall, and negative where heat is taken away. Kirchhoff's law holds for the doubles
 * themselves: E has the factor 1 − ρ of absorption, in which ε is rounded. So a closed room of
 * one temperature is in equilibrium to all digits, for any ε. The answer is that of a scene
 * with these E and ρ, bit for bit.
 *
 * **Heaters.** #HR2D_HEAT_POWER gives the net heat Q of a patch, in W for each metre across the
 * section, in the place of q. With HR2D_SIDES_BOTH it is that of both sides together; in a
 * file, "heat" is that of all patches of a feature. It leaves evenly: q = Q/Σ lengths, which
 * commit computes. So Q stays when a patch is moved or cut by hr2d_scene_snap() or
 * hr2d_scene_split_crossings(). Otherwise such a patch is one of given q, and
 * hr2d_scene_heat() calls it so. hr2d_temperatures::heat has Q of every patch.
 *
 * **Shields.** #HR2D_HEAT_SHIELD makes a patch a side of a sheet so thin that both sides have
 * one temperature at each place, and that gives no net heat there, as a radiation shield: ε(σT⁴
 * − H) + ε′(σT⁴ − H′) = 0 with ε′ and H′ of the other side. HR2D_SIDES_BOTH adds two sides that
 * are alike; for sides that differ add each. In one band that is a pane (scene.h), exactly:
 * with τ = εε′/(ε + ε′) and ρ = 1 − τ on both sides. B − H of the back is the heat that goes
 * through from the front.
 *
 * **Average and points.** On a patch of given q, T differs from point to point. The temperature
 * of the patch is that of its average H + q/ε, the mean of T⁴; for points there is
 * hr2d_solution_gather_temperature(). The two sides of a patch of given q do not exchange heat:
 * each has the q that is given.
 *
 * **Existence.** Patches of given q that exchange heat only with each other, in a closed part
 * of the scene, have no solution, or one at every temperature: hr2d_solve() and
 * hr2d_solve_to() return HR2D_ENO_SOLUTION. They do so, too, if a patch loses so much that B
 * would be negative. If B is positive and H + q/ε is not, the patch is marked:
 * HR2D_TEMPERATURE_IMPOSSIBLE. It cannot lose so much heat, even at 0 K.
 *
 * **Bands.** With hr2d_scene_set_wavelengths() bands are parts of the spectrum, and ε has a
 * value for each. A patch of given T emits in each band its part f_b of the black body,
 * hr2d_black_body_part(). So does a patch of given q, whose T divides its emission among the
 * bands: B_b = ε_b f_b(T)σT⁴ + (1 − ε_b)H_b. In several bands such a patch has one T, and q is
 * the mean over its length: Σ_b ε_b (f_b(T)σT⁴ − H̄_b) = q with the averages H̄_b. (In one
 * band every point of the patch has this q and its own T. The two models agree in the limit
 * if a wall is cut into short patches.) So has a shield, and its balance is that of both sides.
 * These T are unique. hr2d_solve() finds those of its
 * links, by Newton's method
 * over linear solves, 10 to 50 times the cost of one. So does hr2d_solve_to(), and its account
 * has their part of the error. hr2d_target::seconds is a budget of the solves; the
 * temperatures take some iterations more. Where T would be below 0 K, HR2D_ENO_SOLUTION is
 * returned. E and ρ of the scene are then those of the sum over the bands, q and 1.
 *
 * **Emissivity that depends on temperature** is a table or a function. On a patch of given T it
 * is a number. On one of given q it is a part of the equation for T: in one band of
 * ε(T)(σT⁴ − H) = q alone, from point to point; in several bands of the heat balance, where 1 −
 * ε reflects. If the left-hand side rises with T there is one T. If ε falls too fast for this,
 * there may be several: one is found, or in several bands HR2D_ENOT_CONVERGED is returned.
 *
 * examples/adiabatic-walls.c computes a furnace, examples/paint-oven.c a published one.
 * @{
 */
#ifndef HR2D_THERMAL_H
#define HR2D_THERMAL_H

#include <hr2d/accuracy.h>
#include <hr2d/scene.h>
#include <hr2d/solve.h>
#include <hr2d/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** σ, W/(m² K⁴): CODATA 2018, where it is exact but for digits that are left out. */
#define HR2D_STEFAN_BOLTZMANN 5.670374419e-8

/** c₂ = hc/k, m K: CODATA 2018, as above. */
#define HR2D_SECOND_RADIATION_CONSTANT 0.01438776877

/** The most wavelengths of a scene: each patch of given T has an E for each of their bands. */
#define HR2D_MAX_WAVELENGTHS 511

/** The quantities that are given of a patch. */
typedef enum hr2d_heat {
  HR2D_HEAT_NONE = 0,    /**< E and ρ */
  HR2D_HEAT_TEMPERATURE, /**< T and ε */
  HR2D_HEAT_FLUX,        /**< q and ε */
  HR2D_HEAT_SHIELD,      /**< ε of a side of a sheet without net heat */
  HR2D_HEAT_POWER        /**< Q and ε, to hr2d_scene_add_thermal(): a flux of Q per length */
} hr2d_heat;

/**
 * An emissivity that depends on temperature.
 * @param ctx     hr2d_thermal::emissivity_ctx
 * @param kelvin  T ≥ 0
 * @param band    the band; 0 if there is one
 * @return ε as of hr2d_thermal::emissivity; another value ends the call with HR2D_ECALLBACK, or
 *         leaves NaN for T. The same T must get the same ε. With hr2d_scene_add_thermal() it is
 *         called for a given T alone; otherwise, as long as the scene exists, from any thread
 *         that works with it
 */
typedef double (*hr2d_emissivity_fn)(void *ctx, double kelvin, size_t band);

/** The thermal properties of a patch. Start from #HR2D_THERMAL_INIT. */
typedef struct hr2d_thermal {
  size_t struct_size;       /**< so that the struct can grow */
  hr2d_heat given;          /**< the meaning of `value`: a temperature or a flux; or a shield */
  double value;             /**< T ≥ 0 in kelvin, q in W/m², or Q in W/m; 0 of a shield */
  const double *emissivity; /**< ε in (0,1] with a flux or of a shield, in [0,1] with a
                                 temperature; copied */
  size_t emissivity_bands;  /**< number of values in `emissivity`: one per band, or one for all;
                                 0: ε = 1 */
  const double *kelvin; /**< for a table: the temperatures of its entries, which rise; copied */
  size_t kelvins;       /**< their number; `emissivity` has `emissivity_bands` values for each,
                             entry by entry. Between entries ε is on a straight line, beyond
                             them it is that of the last. 0: ε does not depend on T */
  hr2d_emissivity_fn emissivity_of; /**< in the place of values: a function; NULL: none */
  void *emissivity_ctx;             /**< given to `emissivity_of` */
} hr2d_thermal;

/** A black patch, without a temperature or a flux yet. */
#define HR2D_THERMAL_INIT                                                                      \
  { sizeof(hr2d_thermal), HR2D_HEAT_NONE, 0, NULL, 0, NULL, 0, NULL, NULL }

/**
 * Does what #HR2D_THERMAL_INIT does, for languages without macros: sets all bytes to 0, and
 * `struct_size`.
 * @param thermal  the struct
 * @param size     its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_thermal_init(hr2d_thermal *thermal, size_t size);

/**
 * Adds a patch of given temperature or flux; otherwise like hr2d_scene_add().
 * @param scene    not yet committed
 * @param patch    its ends, its name and its sides; without emission and reflectance
 * @param thermal  what is given; copied
 * @param index    receives the index of the (front) patch; may be NULL
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  as hr2d_scene_add(); `patch` has emission or reflectance; `given` is
 *                      none of them; a shield has a value; there are both values and a function
 * for ε, or a table without values; or `struct_size` is not set
 * @retval HR2D_ECALLBACK  `emissivity_of` gives no emissivity for a given T
 * @retval HR2D_EUNSUPPORTED  the emissivity of a shield depends on temperature
 * @retval HR2D_ESTATE  the scene is committed
 * @retval HR2D_ESCENE  as hr2d_scene_add(); T is negative, so large that E is beyond a double,
 *                      or not finite; q or Q is not finite; ε is outside of its range; a
 *                      flux or a shield has a transmittance, or ε + τ > 1; or several ε are
 *                      given that are not one for each band of the wavelengths; or the
 *                      temperatures of a table are negative or do not rise
 *
 * hr2d_scene_emission() and hr2d_scene_reflectance() return E and ρ of the table above.
 */
HR2D_API hr2d_status hr2d_scene_add_thermal(hr2d_scene *scene, const hr2d_patch *patch,
                                            const hr2d_thermal *thermal, size_t *index);

/**
 * Divides the spectrum into bands: `count` wavelengths make `count` + 1 bands. The first band
 * has all shorter wavelengths, the last one all longer ones, so that no heat is left out.
 * @param scene       not yet committed, without patches of given temperature or flux
 * @param wavelength  in micrometres, above 0 and rising; copied
 * @param count       number of wavelengths, at most #HR2D_MAX_WAVELENGTHS; 0 for one band, as
 *                    before the first call
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a number of wavelengths without values
 * @retval HR2D_ESTATE  the scene is committed, or has patches of given temperature or flux
 * @retval HR2D_ESCENE  a wavelength is not finite, not above 0, or not above the one before; or
 *                      there are too many
 *
 * A file may have them, too. If the scene has patches of given temperature or flux already, a
 * file with other wavelengths is refused with HR2D_ESTATE.
 *
 * hr2d_scene_commit() returns HR2D_ESCENE if other arrays of the scene have another number of
 * bands.
 */
HR2D_API hr2d_status hr2d_scene_set_wavelengths(hr2d_scene *scene, const double *wavelength,
                                                size_t count);

/**
 * Divides what black bodies emit into bands by weights, as a weighted sum of grey gases does
 * (Hottel and Sarofim, Radiative Transfer, 1967): `count` weights make `count` + 1 bands. Of
 * the emission σT⁴ of a black body at T band b has the part
 *
 *     a_b(T) = Σ_j weight[(b − 1) terms + j] T^j  for b ≥ 1,   a_0(T) = 1 − Σ a_b(T).
 *
 * Band 0 is that of the gaps between the lines of a gas: its κ is mostly 0. Tables of
 * combustion gases have such polynomials and the κ that belong to them, hr2d_gas::absorption.
 * Patches are as with wavelengths: of given T, with an ε for all bands or for each.
 *
 * @param scene   not yet committed, without patches of given temperature or flux
 * @param weight  count × terms coefficients, that of T^j in K^−j; copied
 * @param count   number of weights, at most #HR2D_MAX_WAVELENGTHS; 0 for one band, as before
 * the first call. Wavelengths are forgotten, as weights are by hr2d_scene_set_wavelengths()
 * @param terms   coefficients of each, at most #HR2D_MAX_WAVELENGTHS
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a number of weights without values or terms
 * @retval HR2D_ESTATE  the scene is committed, or has patches of given temperature or flux
 * @retval HR2D_ESCENE  a coefficient is not finite, or there are too many
 *
 * A polynomial holds for some temperatures only: where a part of a given T is not in [0,1],
 * hr2d_scene_add_thermal(), or for a gas hr2d_scene_commit(), returns HR2D_ESCENE. Fluxes and
 * shields are refused with HR2D_EUNSUPPORTED, and so are states of such a scene.
 */
HR2D_API hr2d_status hr2d_scene_set_weights(hr2d_scene *scene, const double *weight,
                                            size_t count, size_t terms);

/**
 * The temperature or heat flux that is given of a patch.
 * @param scene  a scene
 * @param patch  the index of a patch
 * @param value  receives T or q; NaN if neither is given; may be NULL. Of a given power it is
 *               the q that follows, after the commit
 * @return which of them it is; #HR2D_HEAT_FLUX of a given power
 */
HR2D_API hr2d_heat hr2d_scene_heat(const hr2d_scene *scene, size_t patch, double *value);

/**
 * The emissivity of a patch in one band, as it was given.
 * @param scene  a scene
 * @param patch  the index of a patch
 * @param band   below hr2d_scene_bands()
 * @return ε; NaN if neither T nor q is given, or if q is and ε depends on T. Of a given T it is
 *         that of this T
 */
HR2D_API double hr2d_scene_emissivity(const hr2d_scene *scene, size_t patch, size_t band);

/**
 * The emissivity of a patch at a temperature.
 * @param scene   a scene
 * @param patch   the index of a patch
 * @param band    below hr2d_scene_bands()
 * @param kelvin  T ≥ 0; does not matter unless q is given and ε depends on T
 * @return ε; NaN if neither T nor q is given
 */
HR2D_API double hr2d_scene_emissivity_at(const hr2d_scene *scene, size_t patch, size_t band,
                                         double kelvin);

/**
 * The temperature of a patch on which H arrives: given, or in a scene of one band the root of
 * ε(T)(σT⁴ − H) = q.
 * @param scene       a scene
 * @param patch       the index of a patch
 * @param irradiance  H ≥ 0 in W/m²
 * @return T; NaN if it is not known, or cannot be
 */
HR2D_API double hr2d_scene_temperature(const hr2d_scene *scene, size_t patch,
                                       double irradiance);

/**
 * σT⁴, the emission of a black body over all wavelengths.
 * @param kelvin  T
 * @return W/m²; the relative error is at most 2·2^-52
 */
HR2D_API double hr2d_black_body(double kelvin);

/**
 * The part of σT⁴ that a black body emits between two wavelengths: the fraction
 * f(λT) = (15/π⁴) ∫ u³/(eᵘ − 1) du over u > c₂/(λT), at `to` less that at `from`.
 * @param kelvin  T ≥ 0
 * @param from    the shorter wavelength in micrometres, ≥ 0
 * @param to      the longer one; may be infinite
 * @return the part, in [0,1]; NaN for other arguments. The relative error is at most
 *         (20 + 4x)·2^-52, with x = c₂/(`to` T), as long as the part is above 1e-300
 */
HR2D_API double hr2d_black_body_part(double kelvin, double from, double to);

/** How a temperature is known. */
typedef enum hr2d_temperature_state {
  HR2D_TEMPERATURE_NONE = 0,   /**< the patch has E and ρ: it is not known */
  HR2D_TEMPERATURE_GIVEN,      /**< it was given */
  HR2D_TEMPERATURE_FOUND,      /**< it follows from the flux */
  HR2D_TEMPERATURE_IMPOSSIBLE, /**< H + q/ε is negative: the patch cannot lose so much */
  HR2D_TEMPERATURE_UNLIT       /**< no heat reaches the patch: it has 0 K where it sees out, and
                                    in a closed room any temperature */
} hr2d_temperature_state;

/** The results for each patch. Start from #HR2D_TEMPERATURES_INIT. */
typedef struct hr2d_temperatures {
  size_t struct_size;    /**< so that the struct can grow */
  double *kelvin;        /**< receives T; NaN unless it is given or found; NULL: not wanted, as
                              all below */
  double *estimate;      /**< receives the most likely error of T, in kelvin */
  double *bound;         /**< receives the bound of the error of T, in kelvin */
  double *heat;          /**< receives the heat that leaves the patch: q, over all bands, times
                              its length, in W per metre */
  double *heat_estimate; /**< receives the most likely error of it */
  double *heat_bound;    /**< receives the bound of the error of it */
  unsigned char *state;  /**< receives an #hr2d_temperature_state each */
} hr2d_temperatures;

/** Nothing is wanted. */
#define HR2D_TEMPERATURES_INIT                                                                 \
  { sizeof(hr2d_temperatures), NULL, NULL, NULL, NULL, NULL, NULL, NULL }

/**
 * The temperatures of all patches, and the heat that they give.
 *
 * Errors follow from those of H. With the relative error e of hr2d_account::irradiance and the
 * floor of the target, |δH| ≤ e·max(H, floor·max H), and |δ(σT⁴)| ≤ |δH| for a patch of given
 * q. In several bands errors of H change all unknown T together: the reported error is the
 * largest change of T that errors of this size can cause, and it needs the `target` of the
 * solve. A patch of given T has no error of T, one of given q none of its heat.
 *
 * @param solution      a solution
 * @param target        that of hr2d_solve_to(), for its floor and its important patches; NULL
 *                      for the defaults
 * @param account       that of hr2d_solve_to(); NULL: errors that follow from those of H are
 *                      NaN. All errors are NaN for patches that are not important
 * @param temperatures  what is wanted: arrays with an item for each patch
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed; with important patches only
 * @retval HR2D_EINVAL  a `struct_size` is not set, or `target` is not valid
 * @retval HR2D_EUNSUPPORTED  the solution is one of several lights of an operator
 *
 * Cost O(n·bands).
 */
HR2D_API hr2d_status hr2d_solution_temperatures(const hr2d_solution *solution,
                                                const hr2d_target *target,
                                                const hr2d_account *account,
                                                const hr2d_temperatures *temperatures);

/**
 * T at points of a patch: given, from H of hr2d_solution_gather_irradiance(), or in several
 * bands that of the patch.
 * @param solution  a solution
 * @param patch     the index of a patch
 * @param t         `count` fractions of the patch, as for hr2d_solution_gather()
 * @param count     the number of points
 * @param kelvin    receives `count` values; NaN where T is not known, or
 *                  H + q/ε is negative
 * @return as hr2d_solution_gather(), with its cost
 */
HR2D_API hr2d_status hr2d_solution_gather_temperature(const hr2d_solution *solution,
                                                      size_t patch, const double *t,
                                                      size_t count, double *kelvin);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
