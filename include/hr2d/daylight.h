/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file daylight.h
 * @brief Sun and sky: light from outside of the scene.
 *
 * @defgroup daylight Daylight: sun and sky
 * Light from outside of the scene: the sun, whose light is parallel, and the sky in pieces.
 *
 * The plane of the scene is a section. A sun that stands off this plane lights it with the
 * part of its light that lies in the plane, as doc/sun-and-sky.md says for rows of panels.
 *
 * Light of direction d and irradiance I, power per scene length across d, makes
 *
 *     H_sun = I max(0, −d·n)
 *
 * on a patch with normal n, the left of its direction, wherever nothing stands between the
 * patch and the sun; elsewhere 0. The borders of the light are those of the patches that cast
 * them, found by exact signs. In B = E + ρH the irradiance H contains H_sun, and the light
 * that the patch reflects goes on as all other light. Backs of patches that have only a front
 * are black and opaque.
 *
 * hr2d_solve_to() ends elements at the borders of the light, so that its error bounds hold
 * as without a sun. Suns of many bands may have more than 16 lit parts for each patch; then
 * elements do not end there, and the estimate contains the error that this leaves
 * (doc/sun-and-sky.md). hr2d_solve() takes elements as they are: H_sun is right in the average
 * over each, and its polynomials follow it only where elements end at its borders.
 * @{
 */
#ifndef HR2D_DAYLIGHT_H
#define HR2D_DAYLIGHT_H

#include <hr2d/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A sun. */
typedef struct hr2d_sun {
  hr2d_point direction; /**< in which its light travels, of any length above 0: (0,−1) falls
                             straight down */
  double irradiance;    /**< I ≥ 0 on a surface across the light, in the unit of E */
} hr2d_sun;

/**
 * Sets the sun.
 * @param scene  not yet committed
 * @param sun    one sun for all bands, or one for each band; copied. The direction of a sun
 *               without irradiance may be 0
 * @param bands  number of suns; 0 for no sun, as before the first call
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a number of bands without suns
 * @retval HR2D_ESTATE  the scene is committed
 * @retval HR2D_ESCENE  an irradiance is negative or not finite; or the direction of a sun with
 *                      light is 0 or not finite
 *
 * hr2d_scene_commit() finds the parts that each sun lights, at a cost of about 0.1 µs for each
 * triangle of the plane between the walls: 2 to 6 for each patch.
 */
HR2D_API hr2d_status hr2d_scene_set_sun(hr2d_scene *scene, const hr2d_sun *sun, size_t bands);

/**
 * The sun of a band.
 * @param scene  a scene
 * @param band   below hr2d_scene_bands()
 * @return the sun as it was given; all 0 without one
 */
HR2D_API hr2d_sun hr2d_scene_sun(const hr2d_scene *scene, size_t band);

/** A piece of the sky: an arc of bearings in degrees, clockwise from +y, so that 0 is above, 90
   on the right and −90 on the left. */
typedef struct hr2d_sky_piece {
  double from; /**< where it begins */
  double to;   /**< where it ends, clockwise from there: from < to ≤ from + 360 */
} hr2d_sky_piece;

/**
 * Sets the sky: a radiosity for each of some pieces. A point that looks between the patches to
 * infinity sees this radiosity in all directions of the piece. Other directions have the
 * background. A piece of 360 degrees is like a background.
 * @param scene   not yet committed
 * @param piece   `pieces` arcs, no two of which overlap; copied
 * @param pieces  number of pieces, at most 720; 0 for none, as before the first call
 * @param value   pieces × bands values ≥ 0 in the unit of E, piece by piece; copied
 * @param bands   values of each piece: one for all bands, or one for each
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  pieces without values
 * @retval HR2D_ESTATE  the scene is committed
 * @retval HR2D_ESCENE  a value is negative or not finite; an arc is none; or two overlap
 *
 * A point gets ½ L Δ sin φ from an arc of radiosity L that it sees, with φ from its normal.
 * That is exact at points; over elements it is integrated by Gauss rules of order + 6 points,
 * and hr2d_solve_to() ends elements where the edge of a piece comes into sight.
 */
HR2D_API hr2d_status hr2d_scene_set_sky(hr2d_scene *scene, const hr2d_sky_piece *piece,
                                        size_t pieces, const double *value, size_t bands);

/**
 * The radiosity of the sky in a direction.
 * @param scene    a scene
 * @param bearing  degrees, clockwise from +y; where two pieces meet, the one that lies
 *                 clockwise counts
 * @param band     below hr2d_scene_bands()
 * @return that of the piece, or of the background
 */
HR2D_API double hr2d_scene_sky(const hr2d_scene *scene, double bearing, size_t band);

/**
 * The pieces of the sky.
 * @param scene  a scene
 * @return their number, as given to hr2d_scene_set_sky(); 0 if all of the sky is background
 */
HR2D_API size_t hr2d_scene_sky_pieces(const hr2d_scene *scene);

/**
 * The average of H_sun over a patch. H without the light that comes straight from the sun is
 * hr2d_solution_irradiance() less this.
 * @param scene  a committed scene
 * @param patch  the index of a patch
 * @param band   below hr2d_scene_bands()
 * @return power per length, in the unit of E. An end of the light is off by roundings of
 *         coordinates, a few units of 2^-52·hr2d_scene_unit() across the light
 *
 * Cost: logarithmic in the number of lit parts, plus those of the patch.
 */
HR2D_API double hr2d_scene_sunlight(const hr2d_scene *scene, size_t patch, size_t band);

/**
 * The sunlight that a band may lack in a period. If a sun shines past more images than there
 * are (symmetry.h), its light from beyond them counts as shadow. The true irradiance of a
 * front is H_sun or more, by up to this value times the cosine of the angle of incidence; B
 * and H of the band may also lack its reflections. No error of an account contains this. Other
 * bands lack nothing.
 * @param scene  committed
 * @param band   below hr2d_scene_bands()
 * @return the irradiance of the sun if there are too few images for it; else 0
 *
 * Cost: O(patches of the cell), if there is such a sun.
 */
HR2D_API double hr2d_scene_sunlight_cut_off(const hr2d_scene *scene, size_t band);

/**
 * The average of H_sun over a part of a patch.
 * @param scene  a committed scene
 * @param patch  the index of a patch
 * @param from   where the part begins, a fraction of the patch in [0,1]
 * @param to     where it ends; from < to
 * @param band   below hr2d_scene_bands()
 * @return as hr2d_scene_sunlight(), at its cost
 */
HR2D_API double hr2d_scene_sunlight_over(const hr2d_scene *scene, size_t patch, double from,
                                         double to, size_t band);

/**
 * H_sun at a point of a patch.
 * @param scene  a committed scene
 * @param patch  the index of a patch
 * @param t      fraction of the patch in [0,1], counted from its start; a border of the
 *               light counts as lit
 * @param band   below hr2d_scene_bands()
 * @return power per length, in the unit of E
 */
HR2D_API double hr2d_scene_sunlight_at(const hr2d_scene *scene, size_t patch, double t,
                                       size_t band);

/**
 * The parts of a patch that the sun of a band lights.
 * @param scene  a committed scene
 * @param patch  the index of a patch
 * @param band   below hr2d_scene_bands()
 * @param part   receives the first `room` parts, from their start to their end: fractions
 *               of the patch, in its direction; may be NULL if `room` is 0
 * @param room   number of parts that there is room for
 * @return the number of parts; 0 if the patch is in the shade
 */
HR2D_API size_t hr2d_scene_sunlit_parts(const hr2d_scene *scene, size_t patch, size_t band,
                                        double (*part)[2], size_t room);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
