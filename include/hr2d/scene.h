/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file scene.h
 * @brief The patches of a scene, their emission and reflectance.
 *
 * @defgroup scene Scene
 * The patches of a scene, their emission and reflectance.
 *
 * A scene is filled (hr2d_scene_add(), hr2d_scene_read()) and then committed once
 * (hr2d_scene_commit()). From then on it is only read.
 *
 * Only one thread at a time may use a scene that is not committed. Several threads may read a
 * committed scene.
 * @{
 */
#ifndef HR2D_SCENE_H
#define HR2D_SCENE_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/progress.h>
#include <hr2d/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A set of patches; opaque. */
typedef struct hr2d_scene hr2d_scene;

/** The sides of a segment that are patches. */
typedef enum hr2d_sides {
  HR2D_SIDES_FRONT = 0, /**< the left of a→b */
  HR2D_SIDES_BOTH       /**< left and right: two patches back to back */
} hr2d_sides;

/**
 * A patch to be added. Start from #HR2D_PATCH_INIT and set the members that differ.
 *
 * Emission, reflectance and transmittance are arrays with one value per band. A single value
 * holds for every band; no value means 0. hr2d_scene_add() copies everything.
 *
 * **Panes.** Patches with a transmittance τ are the sides of a pane, which scatters what falls
 * on either side to both: B = E + ρH + τH′, with H′ at the same place on the other side. Both
 * sides are patches, back to back and end to end, of the same τ, for light passes both ways
 * alike; E and ρ may differ. HR2D_SIDES_BOTH adds two sides that are alike; for sides that
 * differ add each. ρ + τ ≤ 1 on both.
 */
typedef struct hr2d_patch {
  /** start; the front is the left of a→b */
  hr2d_point a, b;             /**< end */
  const char *name;            /**< UTF-8, or NULL: "patch K", with K its index */
  const double *emission;      /**< E ≥ 0, power per scene length */
  size_t emission_bands;       /**< number of values in `emission` */
  const double *reflectance;   /**< 0 ≤ ρ ≤ 1, dimensionless */
  size_t reflectance_bands;    /**< number of values in `reflectance` */
  hr2d_sides sides;            /**< HR2D_SIDES_BOTH adds two patches */
  const double *transmittance; /**< 0 ≤ τ ≤ 1, dimensionless: that of a pane, see above */
  size_t transmittance_bands;  /**< number of values in `transmittance` */
} hr2d_patch;

/** A black patch without emission. */
#define HR2D_PATCH_INIT                                                                        \
  { {0, 0}, {0, 0}, NULL, NULL, 0, NULL, 0, HR2D_SIDES_FRONT, NULL, 0 }

/**
 * Does what #HR2D_PATCH_INIT does, for languages without macros: sets all bytes to 0.
 * @param patch  the struct
 */
HR2D_API void hr2d_patch_init(hr2d_patch *patch);

/**
 * Effects that change the answer in some scenes only. The library works on an effect only if
 * the scene calls for it.
 */
typedef enum hr2d_effect {
  HR2D_EFFECT_OCCLUSION = 0,   /**< a patch can stand between two others */
  HR2D_EFFECT_INTERREFLECTION, /**< a patch reflects light */
  HR2D_EFFECT_EMISSION,        /**< a patch emits, or light comes in; patches that no light can
                                    reach get no links */
  HR2D_EFFECT_BANDS,           /**< there is more than one band */
  HR2D_EFFECT_TWO_SIDED,       /**< patches stand back to back */
  HR2D_EFFECT_FACING,          /**< some patches see each other only in part: clipping */
  HR2D_EFFECT_BACKGROUND,      /**< light comes in through the openings of the scene */
  HR2D_EFFECT_CORNER,          /**< patches touch: the kernel is singular there */
  HR2D_EFFECT_PANES,           /**< light passes through panes */
  HR2D_EFFECT_MEDIUM,          /**< a gas absorbs and emits (gas.h) */
  HR2D_EFFECT_COUNT            /**< the number of effects */
} hr2d_effect;

/**
 * Makes an empty scene.
 * @param allocator  hooks, copied; NULL for malloc()
 * @param scene      receives the scene; the caller destroys it
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a hook is missing
 */
HR2D_API hr2d_status hr2d_scene_create(const hr2d_allocator *allocator, hr2d_scene **scene);

/**
 * Destroys a scene. Destroy all objects that are made from it first.
 * @param scene  may be NULL
 */
HR2D_API void hr2d_scene_destroy(hr2d_scene *scene);

/**
 * Adds one patch, or two if `sides` is HR2D_SIDES_BOTH.
 *
 * The back of a two-sided patch has the index `index` + 1 and the name of its front followed by
 * " (back)".
 *
 * @param scene  not yet committed
 * @param patch  the patch; copied
 * @param index  receives the index of the (front) patch; may be NULL
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a number of bands without values, or `sides` outside of its enumeration
 * @retval HR2D_ESTATE  the scene is committed
 * @retval HR2D_ESCENE  the length is 0, a coordinate, E, ρ or τ is not finite, E < 0, ρ or τ is
 *                      outside of [0,1], or the name is not UTF-8; the message names the patch
 *
 * Amortised constant cost.
 */
HR2D_API hr2d_status hr2d_scene_add(hr2d_scene *scene, const hr2d_patch *patch, size_t *index);

/**
 * Adds the patches of a scene file: GeoJSON or View2D's .vs2; see doc/scene-files.md.
 *
 * The text of the file shows which format it has. GeoJSON has the structure of RFC 7946, with
 * planar coordinates in scene lengths; it is a collection, one feature, or one geometry.
 * Points, geometries without positions and repeated positions make no patch: hr2d_scene_lint()
 * counts them, and warns of degrees. A name that is no string is taken as its text; that of an
 * object is its member "en", or the first one that has a text.
 *
 * A background in a GeoJSON file replaces the background of the scene; a file without a
 * background does not change it. A .vs2 file has no emission. Its values obs, bas and cmb must
 * be integers and are not used. Numbers have a decimal point in any locale.
 *
 * @param scene  not yet committed; unchanged on failure, including its background
 * @param path   a file name
 * @retval HR2D_OK            success
 * @retval HR2D_ENOMEM        an allocation failed
 * @retval HR2D_EINVAL        `scene` or `path` is NULL
 * @retval HR2D_ESTATE        the scene is committed
 * @retval HR2D_EIO           the file cannot be opened or read
 * @retval HR2D_ESYNTAX       the text has neither of the formats, or is UTF-16, or GeoJSON with
 *                            a NUL byte, as an escape, too
 * @retval HR2D_ESCENE        a value or a patch is not valid
 * @retval HR2D_EUNSUPPORTED  the file asks for an effect that this version lacks
 *
 * The message names the line or the feature. Cost linear in the size of the file, in time and
 * memory; see hr2d_scene_parse().
 */
HR2D_API hr2d_status hr2d_scene_read(hr2d_scene *scene, const char *path);

/**
 * Adds the patches of a scene file that is in memory; otherwise like hr2d_scene_read().
 * @param scene  as in hr2d_scene_read()
 * @param text   the text; it need not be terminated
 * @param size   number of bytes of the text, without a NUL byte that ends it
 * @return as hr2d_scene_read(), except HR2D_EIO
 *
 * Memory besides the text: at most 32 kB and 256 bytes for each byte of the text, whatever the
 * text is. This includes jansson's memory. Short segments with long names take most.
 */
HR2D_API hr2d_status hr2d_scene_parse(hr2d_scene *scene, const char *text, size_t size);

/**
 * Sets the light from the surroundings: a point that looks between the patches to infinity sees
 * this radiosity.
 *
 * The back of a patch that has only a front is black and opaque.
 *
 * @param scene       not yet committed
 * @param background  values ≥ 0 in the unit of E, one per band or one for all bands; copied
 * @param bands       number of values; 0 for no light, as before the first call
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a number of bands without values
 * @retval HR2D_ESTATE  the scene is committed
 * @retval HR2D_ESCENE  a value is negative or not finite
 */
HR2D_API hr2d_status hr2d_scene_set_background(hr2d_scene *scene, const double *background,
                                               size_t bands);

/**
 * Turns an effect on, even if the scene does not call for it. This tests the analysis of
 * effects: an effect that is not called for costs time, but changes no bit of the answer.
 *
 * Exception: HR2D_EFFECT_EMISSION gives links to patches that no light can reach. From 262,144
 * links on, these may change the order in which the other links are summed.
 *
 * @param scene   not yet committed
 * @param effect  the effect
 * @retval HR2D_OK      success
 * @retval HR2D_EINVAL  `effect` is outside of the enumeration
 * @retval HR2D_ESTATE  the scene is committed
 */
HR2D_API hr2d_status hr2d_scene_force(hr2d_scene *scene, hr2d_effect effect);

/**
 * Sets the callback that calls on a scene ask whether to go on.
 *
 * These are the calls that have no options with a `progress` of their own, or in whose options
 * it is NULL: reading and cutting the scene, hr2d_scene_commit(), hr2d_linkset_validate(),
 * hr2d_solution_gather() and its companions, hr2d_state_read(), hr2d_state_write(), and the
 * long calls on the scene and on objects made from it. A stopped call returns the status of the
 * callback and leaves its objects as they were: a scene whose commit was stopped is not
 * committed and takes more patches, or another commit.
 *
 * @param scene     committed or not
 * @param progress  called from the thread of each call: from several threads at once, if calls
 *                  on the scene run in several threads. NULL for none, the initial value
 * @param ctx       given to `progress`
 */
HR2D_API void hr2d_scene_set_progress(hr2d_scene *scene, hr2d_progress_fn progress, void *ctx);

/**
 * Cuts patches that cross properly at their crossings, so that hr2d_scene_commit() does not
 * refuse them.
 *
 * The pieces of a patch take its place, in the order of its direction. Its name gets the
 * suffixes " [1]", " [2]", …; the indices of later patches increase. The pieces of both patches
 * share the crossing, bit for bit.
 *
 * A crossing is rounded. If its pieces meet other patches again, they are cut there, too, and
 * so they are at ends of patches that would come to lie on their other side. Two patches that
 * lie on one another within rounding are cut at each other's ends. Such cuts can leave copies.
 * One of two copies is dropped if it is no longer than 1e-9 of the largest coordinate and no
 * longer than 1e-6 of the patch.
 *
 * @param scene  not yet committed; unchanged on failure
 * @param cuts   receives the number of places where patches were cut; may be NULL
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_ESTATE  the scene is committed
 * @retval HR2D_ERANGE  as for hr2d_scene_commit()
 * @retval HR2D_ESCENE  crossings are left after 32 rounds
 *
 * Cost O(n log n + k), with k the number of pairs whose extents in x overlap.
 */
HR2D_API hr2d_status hr2d_scene_split_crossings(hr2d_scene *scene, size_t *cuts);

/** The repairs that hr2d_scene_snap() made. */
typedef struct hr2d_snap_report {
  size_t ends;     /**< ends of patches that were joined to another end */
  size_t feet;     /**< points that were moved to stand on a patch, or after it */
  size_t slivers;  /**< patches that have lost their length, and were dropped */
  size_t copies;   /**< patches that have become copies of others, and were dropped */
  size_t cuts;     /**< cuts of patches: at ends of others along them, and where they crossed */
  double farthest; /**< the farthest that an end was moved, in scene lengths */
  hr2d_point from; /**< where that end was */
  hr2d_point to;   /**< where it is now */
} hr2d_snap_report;

/**
 * Repairs a drawing whose patches nearly meet.
 *
 * - Ends within the tolerance of each other become one point, that of the first patch.
 * - Ends within the tolerance of another patch are moved onto it, whether they were short of
 *   it or beyond. Where patches share a stretch within the tolerance, they are cut at each
 *   other's ends instead, and share these: the names of pieces are those of
 *   hr2d_scene_split_crossings().
 * - Patches that have lost their length are dropped, and so is the later of two patches that
 * have come to lie on one another with their fronts on the same side.
 * - Patches that cross still are cut there, as by hr2d_scene_split_crossings().
 *
 * An end is joined by at most the tolerance, and moved by at most the tolerance to stand on a
 * patch; where that patch is moved, too, it follows. Choose a tolerance above the errors of the
 * drawing, and far below its smallest detail: smaller details are lost.
 *
 * @param scene      not yet committed; unchanged on failure. Indices of patches change where
 *                   some are dropped or cut
 * @param tolerance  in scene lengths; less than a rounding counts as a rounding
 * @param report     receives the repairs; may be NULL
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  the tolerance is not greater than 0, or not finite
 * @retval HR2D_ESTATE  the scene is committed
 * @retval HR2D_ERANGE  as for hr2d_scene_commit()
 * @retval HR2D_ESCENE  no patch is left, or crossings are left
 *
 * Cost O(n log n + k), with k the pairs of patches whose extents are nearer than the tolerance.
 */
HR2D_API hr2d_status hr2d_scene_snap(hr2d_scene *scene, double tolerance,
                                     hr2d_snap_report *report);

/**
 * Checks the patches against each other, scales their coordinates by a power of two and finds
 * the effects that the scene calls for.
 *
 * A *rounding* is four units in the last place of 1, in units of hr2d_scene_unit(). A computed
 * end that should lie on a patch is off by at most one rounding.
 * - An end that passes through a patch by at most one rounding counts as ending there. But if
 *   the angle is so flat that 2⁻³⁰ of the scene or 2⁻²⁰ of the patch lies beyond, the patches
 *   cross. The accepted rest can change the answer by that much, and by no more.
 * - Patches that are closer than two roundings along a stretch lie on one another.
 *
 * Far from the origin, the coordinates themselves are rounded. At a distance of 1e8 patch
 * lengths, eight digits of the distances between patches are lost. From 1e12 on (2⁴⁰ times the
 * extent of the scene) the scene is refused. Exceptions, because nothing has to be decided: a
 * pair of patches, and patches that are all in front of each other.
 *
 * @param scene  not yet committed; not committed on failure
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_ESTATE  the scene is already committed
 * @retval HR2D_ESCENE  the scene is empty; numbers of bands differ; patches cross; patches
 *                      overlap with their fronts on the same side; patches face each other
 *                      with at most one rounding between them; or a pane has one side, two
 *                      transmittances, or ρ + τ > 1
 * @retval HR2D_ERANGE  the scales of the coordinates are so far apart that scaling would lose
 *                      digits; the scene is too far from the origin; or doubles cannot
 *                      represent a length
 *
 * The message names the patches. Cost O(n log n) in most scenes. If patches have others on
 * both sides and yet nothing occludes any pair, beams from the backs of walls show this, or,
 * if these are many, O(n²) tests of pairs. In a scene with dark patches, the search for
 * patches that light can reach traces beams from lit patches, in the parts of the plane where
 * dark patches are.
 */
HR2D_API hr2d_status hr2d_scene_commit(hr2d_scene *scene);

/**
 * The reason of the last call that failed on this scene.
 * @param scene  a scene
 * @return a sentence, owned by the scene and overwritten by the next failure; "" if no call
 *         failed
 */
HR2D_API const char *hr2d_scene_message(const hr2d_scene *scene);

/**
 * The number n of patches. A two-sided patch counts twice.
 * @param scene  a scene
 * @return n
 */
HR2D_API size_t hr2d_scene_patches(const hr2d_scene *scene);

/**
 * The number of bands.
 * @param scene  committed; the number is not known before
 * @return at least 1; 1 for a grey scene
 */
HR2D_API size_t hr2d_scene_bands(const hr2d_scene *scene);

/**
 * The segment of a patch, as it was given.
 * @param scene  a scene
 * @param patch  the index of a patch
 * @return the segment in scene lengths
 */
HR2D_API hr2d_segment hr2d_scene_segment(const hr2d_scene *scene, size_t patch);

/**
 * The length A of a patch: the hypotenuse of the differences of its coordinates.
 * @param scene  a scene
 * @param patch  the index of a patch
 * @return A in scene lengths; the relative error is at most 3·2^-53 if hypot() is accurate to
 *         one unit in the last place
 */
HR2D_API double hr2d_scene_length(const hr2d_scene *scene, size_t patch);

/**
 * The name of a patch.
 * @param scene  a scene
 * @param patch  the index of a patch
 * @return the name, owned by the scene
 */
HR2D_API const char *hr2d_scene_name(const hr2d_scene *scene, size_t patch);

/**
 * Finds the first patch with a given name. Cost O(n).
 * @param scene  a scene
 * @param name   the name
 * @param patch  receives the index of the patch
 * @retval HR2D_OK      success
 * @retval HR2D_EINVAL  no patch has this name
 */
HR2D_API hr2d_status hr2d_scene_find(const hr2d_scene *scene, const char *name, size_t *patch);

/**
 * The emission of a patch in one band.
 * @param scene  a scene
 * @param patch  the index of a patch
 * @param band   below hr2d_scene_bands()
 * @return E, power per scene length; negative only on a patch of given flux (thermal.h)
 */
HR2D_API double hr2d_scene_emission(const hr2d_scene *scene, size_t patch, size_t band);

/**
 * The reflectance of a patch in one band.
 * @param scene  a scene
 * @param patch  the index of a patch
 * @param band   below hr2d_scene_bands()
 * @return ρ, dimensionless
 */
HR2D_API double hr2d_scene_reflectance(const hr2d_scene *scene, size_t patch, size_t band);

/**
 * The transmittance of a patch in one band.
 * @param scene  a scene
 * @param patch  the index of a patch
 * @param band   below hr2d_scene_bands()
 * @return τ, dimensionless; 0 unless the patch is a side of a pane
 */
HR2D_API double hr2d_scene_transmittance(const hr2d_scene *scene, size_t patch, size_t band);

/**
 * The other side of a pane.
 * @param scene  committed; before, nobody knows it
 * @param patch  the index of a patch
 * @return the patch on the other side; `patch` itself unless it is a side of a pane;
 *         #HR2D_NO_ELEMENT without such a patch
 */
HR2D_API size_t hr2d_scene_other_side(const hr2d_scene *scene, size_t patch);

/**
 * The light from the surroundings in one band.
 * @param scene  a scene
 * @param band   below hr2d_scene_bands()
 * @return the radiosity of the background, in the unit of E
 */
HR2D_API double hr2d_scene_background(const hr2d_scene *scene, size_t band);

/**
 * The power of two by which commit divides the coordinates, so that the largest is in [1,2).
 * The division is exact.
 * @param scene  committed
 * @return scene lengths per unit of the coordinates of elements
 */
HR2D_API double hr2d_scene_unit(const hr2d_scene *scene);

/**
 * Tests whether a committed scene calls for an effect, and gives the reason.
 * @param scene   committed
 * @param effect  the effect
 * @param reason  receives a phrase, owned by the scene; may be NULL
 * @retval 1  the scene calls for the effect, or it was forced
 * @retval 0  otherwise, also if `effect` is outside of the enumeration
 */
HR2D_API int hr2d_scene_effect(const hr2d_scene *scene, hr2d_effect effect,
                               const char **reason);

/**
 * The name of an effect.
 * @param effect  the effect
 * @return a static string, for example "occlusion"; NULL outside of the enumeration
 */
HR2D_API const char *hr2d_effect_name(hr2d_effect effect);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
