/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file sky.h
 * @brief Continuous skies: CIE, Perez, a circumsolar disc, a brighter horizon.
 *
 * @defgroup sky Continuous skies
 * Skies in space, and what a section sees of them.
 *
 * A sky has the radiance
 *
 *     L = s (1 + a exp(b/cos Z) + g cos Z) (1 + c (exp(d χ) − exp(d π/2)) + e cos² χ)
 *         + L_disc + L_band
 *
 * with the angle Z from the zenith and χ from the sun. The first factor is the gradation, the
 * second one the indicatrix of the CIE standard general sky (ISO 15469:2004, CIE S 011), of
 * which the all-weather model of Perez, Seals and Michalsky (Solar Energy 50, 1993) is a
 * multiple. s makes the irradiance of a horizontal surface under these two the given one. A
 * circumsolar disc and a band along the horizon have a constant radiance each.
 *
 * The scene is cut across rows, streets or rooms that are long in a direction e. A ray belongs
 * to a bearing φ of the section and an angle β out of it, and what is in its way depends on φ
 * alone. So a surface with normal n gets
 *
 *     H = ∫∫ L cos²β (n·φ) dβ dφ = ½ ∫ M (n·φ) dφ,  M(φ) = 2 ∫ L cos²β dβ:
 *
 * cos β is of the solid angle cos β dβ dφ, and another one is of the angle to n. M is the
 * radiosity of the sky in the section; of the same radiance L everywhere it is πL, that of a
 * background. doc/sun-and-sky.md has more.
 * @{
 */
#ifndef HR2D_SKY_H
#define HR2D_SKY_H

#include <hr2d/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A sky in space. Start from #HR2D_SKY_INIT. Angles are in degrees; azimuths clockwise from
    north, or from any other direction that is the same for all of them. */
typedef struct hr2d_sky {
  size_t struct_size;        /**< so that the struct can grow */
  double irradiance;         /**< of a horizontal surface under the sky without disc and band,
                                  ≥ 0 in the unit of E */
  double a;                  /**< of the gradation, which is nowhere negative */
  double b;                  /**< at most 0, unless a is 0 */
  double g;                  /**< the same */
  double c;                  /**< of the indicatrix, which is nowhere negative */
  double d;                  /**< the same */
  double e;                  /**< the same */
  double disc_irradiance;    /**< across the light of the circumsolar disc, ≥ 0; what of it is
                                  below the horizon is missing */
  double disc_radius;        /**< in (0,90] if there is a disc */
  double horizon_irradiance; /**< of a vertical surface under the band alone, ≥ 0 */
  double horizon_height;     /**< of the band, in (0,90] if there is one */
  double sun_elevation;      /**< in [0,90] */
  double sun_azimuth;        /**< of the sun */
  double section_azimuth;    /**< of the scene's +x, which is the bearing 90 */
  double tolerance;          /**< of H, as a part of the sum of the irradiances: from 1e-12,
                                  the default for 0, to 0.01 */
} hr2d_sky;

/** A dark sky with the gradation and the indicatrix 1, and the sun at the horizon. */
#define HR2D_SKY_INIT                                                                          \
  { sizeof(hr2d_sky), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 }

/**
 * Does what #HR2D_SKY_INIT does, for languages without macros: sets all bytes to 0, and
 * `struct_size`.
 * @param sky   the struct
 * @param size  its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_sky_init(hr2d_sky *sky, size_t size);

/**
 * Sets a, b, c, d, e and g to those of a CIE sky.
 * @param type  1 to 15: the types of ISO 15469:2004, from overcast (1), over uniform (5) and
 *              clear (12), to turbid with a broad corona (15). 16: the traditional overcast
 * sky, whose radiance is 1 + 2 cos Z (Moon and Spencer 1942)
 * @param sky   receives them; other members stay
 * @retval HR2D_OK      success
 * @retval HR2D_EINVAL  no such type, or no sky
 */
HR2D_API hr2d_status hr2d_sky_cie(int type, hr2d_sky *sky);

/**
 * Sets a, b, c, d, e and g to those of the all-weather model, from its coefficients by
 * clearness, for sky->sun_elevation. Its indicatrix 1 + c exp(dχ) + e cos²χ becomes the one
 * above by a factor, so that c and e of the struct are not those of the model.
 * @param clearness   ε ≥ 1 (hr2d_sky_clearness())
 * @param brightness  Δ ≥ 0
 * @param sky         receives them; other members stay
 * @retval HR2D_OK      success
 * @retval HR2D_EINVAL  ε or Δ are out of range, or no sky
 * @retval HR2D_ESCENE  the model has a radiance at the horizon without bounds, b > 0, or a
 *                      negative one. That is so for small Δ at ε between 1.23 and 2.8;
 * gendaylit of Radiance takes at least 0.2 for Δ where ε is in (1.065,2.8). Members stay
 */
HR2D_API hr2d_status hr2d_sky_perez(double clearness, double brightness, hr2d_sky *sky);

/**
 * Clearness and brightness of the sky from irradiances,
 *
 *     ε = ((D + I)/D + κ Z³)/(1 + κ Z³),  Δ = m D/I₀
 *
 * with κ = 1.041, Z in radians and the air mass m of Kasten (1966). Units cancel out.
 * @param diffuse            D > 0, of a horizontal surface by the sky
 * @param direct             I ≥ 0, of the sun, across its light
 * @param extraterrestrial   I₀ > 0, outside of the atmosphere across the light: about 1361
 *                           W/m², ±3.4 % over the year
 * @param sun_elevation      degrees, in [0,90]
 * @param brightness         receives Δ; may be NULL
 * @return ε; NaN, and NaN for Δ, if an argument is out of range
 */
HR2D_API double hr2d_sky_clearness(double diffuse, double direct, double extraterrestrial,
                                   double sun_elevation, double *brightness);

/**
 * The radiance of a sky, in the unit of irradiances per steradian.
 * @param sky        the sky
 * @param elevation  of a direction, degrees in [0,90]
 * @param azimuth    of it
 * @return L ≥ 0; NaN if the sky is none, or the elevation out of range. For a sky with a given
 *         radiance at the zenith: it is in proportion to the irradiances.
 *
 * Cost: about a millisecond, for the integral that gives s.
 */
HR2D_API double hr2d_sky_radiance(const hr2d_sky *sky, double elevation, double azimuth);

/**
 * Sets a continuous sky in the place of that of hr2d_scene_set_sky(): M(φ), from the bearing
 * −90 over 0 to 90. Other bearings have the background.
 * @param scene  not yet committed
 * @param sky    one sky for all bands, or one for each; copied. All have the same
 *               `struct_size`
 * @param bands  number of skies; 0 for none
 * @retval HR2D_OK       success
 * @retval HR2D_ENOMEM   an allocation failed
 * @retval HR2D_EINVAL   bands without skies, or a struct without its size
 * @retval HR2D_ESTATE   the scene is committed
 * @retval HR2D_ESCENE   a member is out of range, a radiance negative, or the skies of all
 * bands need more than 720 pieces for their tolerance
 * @retval HR2D_ESTOPPED or another status of the callback of hr2d_scene_set_progress()
 *
 * M becomes polynomials of degree 15 in φ over pieces that are divided until the integral of
 * their error is below the tolerance. Pieces are the same for all bands; the smallest tolerance
 * counts. hr2d_scene_sky() has the values, and points and elements get their light as from a
 * sky in pieces. hr2d_solve_to() ends elements where the sun, an edge of the disc or of the
 * band, or the horizon comes into sight.
 *
 * Cost: 10 ms to 0.2 s for each sky.
 */
HR2D_API hr2d_status hr2d_scene_set_continuous_sky(hr2d_scene *scene, const hr2d_sky *sky,
                                                   size_t bands);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
