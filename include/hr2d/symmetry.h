/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file symmetry.h
 * @brief Mirrors, and a period that repeats the scene for ever.
 *
 * @defgroup symmetry Symmetry: mirrors and periods
 * A scene that is symmetric or periodic is given by one of its parts: the cell (fundamental
 * domain).
 *
 * A *mirror* is a line at which the scene is reflected: everything behind it is the image of
 * the scene in front. It is an endless line; the length of its segment does not matter. It
 * neither emits nor absorbs. Two mirrors may be perpendicular, so that there are four images;
 * or parallel, with the scene between them, so that images go on for ever. Of three mirrors
 * two are parallel.
 *
 * A *period* (dx, dy) repeats the scene for ever, at each multiple of the vector: rows of
 * panels, streets, blinds, the unit cell of a bed. A mirror beside a period is parallel to it
 * or perpendicular.
 *
 * hr2d_scene_commit() makes the images. They occlude and are seen as the patches themselves,
 * and the radiosity of an image is that of its patch: only the patches of the cell have
 * unknowns. Indices are those of the cell in all calls; powers are those of the cell; elements
 * are counted with those of the images. An element of image g of patch k has the patch gn + k,
 * for n patches of the cell. A link of the link set joins an element of the cell
 * with one of the cell or of an image; between elements of a patch and of its own mirror image
 * it has half of their exchange area, because both of its ends receive for the same patch.
 *
 * In a period K images on each side are taken; commit doubles K until the patches see nothing
 * beyond. Where they can see for ever, as between two plates, the last images stand for those
 * that are cut off: exchange areas with image k are series in 1/k that begin with 1/k³, and
 * their sums are extrapolated. Estimates and bounds of hr2d_solve_to() contain the error of
 * this extrapolation, of averages and at points: the size of the last term of the series, or
 * the difference from an extrapolation by four other images. The bound is derived for the case
 * in which a single vertex hides images, however many. For several vertices it is assumed.
 *
 * One more gather at a point (solve.h) extrapolates its own view, if images that are cut off
 * are in it. Past the tip of a patch that is oblique to the period these may fill some percent
 * of the view. The sky that shows there is extrapolated, too, and has the light of the
 * horizon; the remaining directions see backs.
 *
 * Points between the patches (field.h) see for ever, too: from above a street all roofs are in
 * view. They use as many images as patches that see for ever. The angle that image k fills is
 * a series in 1/k that begins with 1/k². hr2d_field_values::cut_off receives the part of all
 * directions that is past the images, which is exact; so the light from there adds at most
 * this part of the largest radiosity to M. hr2d_field_values::error contains a bound of the
 * error of the extrapolation, derived as that of hr2d_solve_to(), and at most as large as that
 * part allows. There may be no such series: for instance if the ground shows here and there
 * through gaps of a row of panels, or far above the scene. Then the light past the images is
 * taken as that of the last ones, and the error is the largest that the part allows; likewise
 * if a piece of the sky ends past the images. Suns shine past any number of images, exactly.
 * Rows of points (hr2d_field_rows_visit()) are extrapolated in the same way; their sums may
 * differ from 1 by its error.
 *
 * Images in a mirror that is not parallel to an axis are rounded: their ends are off by some
 * 2⁻⁵⁰ of the largest coordinate. Errors of the account are those of the rounded scene; a patch
 * as short as d, or as near to its image, may be off by that part of d as well.
 *
 * Exchange areas of patches (visibility.h) are sums over all images: a patch may see images of
 * its own. One thread makes them, in memory that grows with the number of pairs that see each
 * other; hr2d_exchange_rows_visit(), too, holds this memory until it ends. The contribution of
 * images that are cut off is extrapolated, but never below 0.
 * hr2d_matrix_options::cut_off_estimate and hr2d_matrix_options::cut_off_bound receive its
 * error, derived in the same way, and at most the sum of the extrapolated contribution and of
 * the view past the images, which is exact. With thousands of patches in a cell there are few
 * images, and some percent of a row may be cut off. Powers have hr2d_solution_power_cut_off().
 * hr2d_leaf_sums() has the rows of the patches of the cell.
 *
 * Not supported, and refused with HR2D_EUNSUPPORTED: over a period in which patches see for
 * ever, a sky with a piece that ends between the horizon and the last images.
 * @{
 */
#ifndef HR2D_SYMMETRY_H
#define HR2D_SYMMETRY_H

#include <hr2d/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Adds a mirror.
 * @param scene  not yet committed
 * @param line   any two points of it
 * @retval HR2D_OK           success
 * @retval HR2D_ESTATE       the scene is committed
 * @retval HR2D_ESCENE       the points are the same, or not finite
 * @retval HR2D_EUNSUPPORTED the scene has three mirrors already
 *
 * hr2d_scene_commit() fails with HR2D_ESCENE if patches lie on both sides of a mirror, if a
 * patch on a mirror looks away from the scene, if mirrors are neither parallel nor
 * perpendicular to each other and to the period, or if a sun or sky with light is not
 * symmetric; and with HR2D_EUNSUPPORTED if images would repeat in two directions.
 */
HR2D_API hr2d_status hr2d_scene_add_mirror(hr2d_scene *scene, hr2d_segment line);

/**
 * Sets the period.
 * @param scene   not yet committed
 * @param period  the vector from a patch to its next image; (0, 0) for none, as before the
 *                first call
 * @retval HR2D_OK      success
 * @retval HR2D_ESTATE  the scene is committed
 * @retval HR2D_ESCENE  a component is not finite
 *
 * hr2d_scene_commit() fails with HR2D_ESCENE if an image crosses a patch. Patches may reach
 * over several periods, and stand any number of periods apart. A sun shines in past at most
 * 256 images: sunlight from beyond them counts as shadow, and no error contains that
 * (hr2d_scene_sunlight_cut_off()).
 */
HR2D_API hr2d_status hr2d_scene_set_period(hr2d_scene *scene, hr2d_point period);

/**
 * The number of mirrors.
 * @param scene  a scene
 * @return at most 3
 */
HR2D_API size_t hr2d_scene_mirrors(const hr2d_scene *scene);

/**
 * A mirror, as it was given.
 * @param scene   a scene
 * @param mirror  below hr2d_scene_mirrors()
 * @return its segment
 */
HR2D_API hr2d_segment hr2d_scene_mirror(const hr2d_scene *scene, size_t mirror);

/**
 * The period.
 * @param scene  a scene
 * @return as given; (0, 0) without one
 */
HR2D_API hr2d_point hr2d_scene_period(const hr2d_scene *scene);

/**
 * The number of images of each patch, with the patch itself as number 0.
 * @param scene  committed
 * @return at least 1
 */
HR2D_API size_t hr2d_scene_images(const hr2d_scene *scene);

/**
 * An image of a patch.
 * @param scene  a committed scene
 * @param patch  the index of a patch
 * @param image  below hr2d_scene_images()
 * @return the segment, in scene lengths, with its front on the left
 */
HR2D_API hr2d_segment hr2d_scene_image(const hr2d_scene *scene, size_t patch, size_t image);

/**
 * The largest view of images that a period cuts off.
 * @param scene  committed
 * @return the largest form factor from a patch to images that are extrapolated; 0 if no
 *         visible image is cut off
 */
HR2D_API double hr2d_scene_cut_off(const hr2d_scene *scene);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
