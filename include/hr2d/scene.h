/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file scene.h
 * @brief The patches of a scene, their emission and reflectance.
 *
 * A scene is filled (hr2d_scene_add(), hr2d_scene_read()), committed once
 * (hr2d_scene_commit()) and from then on only read.  While it is filled it must
 * be used from one thread at a time; a committed scene may be read from many.
 */
#ifndef HR2D_SCENE_H
#define HR2D_SCENE_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A set of patches; opaque. */
typedef struct hr2d_scene hr2d_scene;

/** Which sides of a patch take part. */
typedef enum hr2d_sides {
  HR2D_SIDES_FRONT = 0, /**< the left of a→b */
  HR2D_SIDES_BOTH       /**< left and right: two patches back to back */
} hr2d_sides;

/**
 * A patch to be added.  Start from #HR2D_PATCH_INIT and write what differs.
 * Emission and reflectance are arrays with one value per band; a single value
 * holds for every band, no value means 0.  All is copied.
 */
typedef struct hr2d_patch {
  hr2d_point a, b;           /**< end points; the front is the left of a→b */
  const char *name;          /**< UTF-8, or NULL: "patch K", with K its index */
  const double *emission;    /**< E ≥ 0, power per scene length */
  size_t emission_bands;     /**< how many values `emission` has */
  const double *reflectance; /**< 0 ≤ ρ ≤ 1, dimensionless */
  size_t reflectance_bands;  /**< how many values `reflectance` has */
  hr2d_sides sides;          /**< HR2D_SIDES_BOTH adds two patches */
} hr2d_patch;

/** A black patch that emits nothing. */
#define HR2D_PATCH_INIT                                                                        \
  { {0, 0}, {0, 0}, NULL, NULL, 0, NULL, 0, HR2D_SIDES_FRONT }

/** What can change the answer in some scenes and cannot in others. */
typedef enum hr2d_effect {
  HR2D_EFFECT_OCCLUSION = 0,   /**< a patch can stand between two others */
  HR2D_EFFECT_INTERREFLECTION, /**< light is reflected at all */
  HR2D_EFFECT_EMISSION,        /**< something emits, or light comes in; patches that no
                                    light can reach get no links */
  HR2D_EFFECT_BANDS,           /**< more than one band */
  HR2D_EFFECT_TWO_SIDED,       /**< patches back to back */
  HR2D_EFFECT_FACING,          /**< some patches see each other only in part: clipping */
  HR2D_EFFECT_BACKGROUND,      /**< light comes in through the openings of the scene */
  HR2D_EFFECT_CORNER,          /**< patches touch: the kernel is singular there */
  HR2D_EFFECT_COUNT            /**< how many there are */
} hr2d_effect;

/**
 * Makes an empty scene.
 * @param allocator  hooks, copied; NULL for malloc
 * @param scene      receives the scene; the caller destroys it
 * @return HR2D_OK, HR2D_ENOMEM, or HR2D_EINVAL for hooks that are missing
 */
HR2D_API hr2d_status hr2d_scene_create(const hr2d_allocator *allocator, hr2d_scene **scene);

/** Destroys a scene; NULL is allowed.  What was made from it must be gone. */
HR2D_API void hr2d_scene_destroy(hr2d_scene *scene);

/**
 * Adds one patch, or two for HR2D_SIDES_BOTH: `index`, and `index + 1` for the
 * back, named with " (back)" behind.
 *
 * @param scene  not yet committed
 * @param patch  what to add; copied
 * @param index  receives the index of the (front) patch; may be NULL
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_ESTATE after commit, or HR2D_ESCENE for zero
 *         length, a coordinate, E or ρ that is not finite, E < 0 or ρ outside
 *         [0,1], with a message that names the patch; HR2D_EINVAL for bands without
 *         values and for `sides` outside its enumeration
 * Amortised constant cost.
 */
HR2D_API hr2d_status hr2d_scene_add(hr2d_scene *scene, const hr2d_patch *patch, size_t *index);

/**
 * Adds the patches of a scene file: GeoJSON (RFC 7946 structure, planar coordinates in
 * scene lengths) or View2D's .vs2, which the text itself tells; see doc/scene-files.md.
 * A background in a GeoJSON file takes the place of the scene's; a file without one leaves
 * it alone.  A .vs2 file has no emission; its obs, bas and cmb are checked to be integers
 * and not used.  Numbers have a decimal point in any locale.
 *
 * @param scene  not yet committed; unchanged on failure, its background too
 * @param path   a file name
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_EINVAL without a path, HR2D_ESTATE after commit,
 *         HR2D_EIO, HR2D_ESYNTAX for what is not such a file, HR2D_ESCENE for a value or
 *         patch that makes no sense, and HR2D_EUNSUPPORTED for an effect this version
 *         lacks; the message names the line or the feature
 * Cost linear in the size of the file, in time and memory: see hr2d_scene_parse().
 */
HR2D_API hr2d_status hr2d_scene_read(hr2d_scene *scene, const char *path);

/**
 * As hr2d_scene_read(), from `size` bytes of memory, which need not be terminated.
 * Beside the text it takes at most 256 bytes of memory for each byte of it, and 32 kB, whatever
 * the text is and with what jansson takes; most is for short segments with long names.
 */
HR2D_API hr2d_status hr2d_scene_parse(hr2d_scene *scene, const char *text, size_t size);

/**
 * Sets the light that comes in from the surroundings: what a point sees between the
 * patches, to infinity, has this radiosity.  The back of a patch that has a front only
 * is black and lets nothing through.
 *
 * @param scene       not yet committed
 * @param background  ≥ 0, one value per band or one for all, in the unit of emission;
 *                    copied
 * @param bands       how many values; 0 for no light, as before the first call
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_ESTATE after commit, HR2D_ESCENE for a value that is
 *         negative or not finite, HR2D_EINVAL for bands without values
 */
HR2D_API hr2d_status hr2d_scene_set_background(hr2d_scene *scene, const double *background,
                                               size_t bands);

/**
 * Turns an effect on whether or not the scene calls for it.  That costs time and changes
 * no bit of the answer where the effect is not called for: a means to test just this.
 * Forcing HR2D_EFFECT_EMISSION also gives links to patches that no light can reach; from
 * 262,144 links on that may change in which order the others are summed up.
 *
 * @param scene  not yet committed
 * @return HR2D_OK, HR2D_ESTATE after commit, HR2D_EINVAL outside the enumeration
 */
HR2D_API hr2d_status hr2d_scene_force(hr2d_scene *scene, hr2d_effect effect);

/**
 * Cuts patches that cross each other properly at their crossings, so that commit does
 * not refuse them.  The pieces of a patch take its place, in the order of its direction,
 * named with " [1]", " [2]", … behind, and share the crossing bit for bit with those of
 * the other; indices behind them move up.  Where patches meet again in a rounded piece
 * they are cut there, too; two that lie on one another within rounding are cut at each
 * other's ends, and of copies no longer than 1e-9 of the largest coordinate and 1e-6 of the
 * patch, which such cuts can leave, one is dropped.
 *
 * @param scene  not yet committed; unchanged on failure
 * @param cuts   receives the number of places where patches were cut; may be NULL
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_ESTATE after commit, HR2D_ERANGE as
 *         hr2d_scene_commit(), HR2D_ESCENE if crossings are left after 32 rounds
 * Cost O(n log n + pairs whose extents in x meet).
 */
HR2D_API hr2d_status hr2d_scene_split_crossings(hr2d_scene *scene, size_t *cuts);

/**
 * Checks the patches against each other, scales their coordinates by a power of
 * two and analyses which effects the scene calls for.
 *
 * A rounding is four units in the last place of 1, in units of hr2d_scene_unit(): ends that
 * were computed to lie on a patch are within that, so that one that goes through by no more
 * ends there, and patches closer than two roundings along a stretch lie on one another.  An
 * end that is through by a rounding at so flat an angle that 2⁻³⁰ of the scene or 2⁻²⁰ of the
 * patch is beyond crosses: what stays allowed can change the answer by as much, and no more.
 * Far from the origin roundings are those of the coordinates: 1e8 patch lengths away eight
 * digits of what is between patches are not there any more, and from 1e12 on (2⁴⁰ times what
 * the scene is across) the scene is refused, unless it is a pair of patches or all of them are
 * in front of each other, so that nothing has to be decided.
 *
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_ESTATE if committed before, HR2D_ESCENE for
 *         an empty scene, differing band counts, patches that cross, patches
 *         that overlap with their fronts on the same side, and patches that face each
 *         other with no more than a rounding between them; HR2D_ERANGE for coordinates
 *         whose scales lie so far apart that scaling would lose digits, a scene too far from
 *         the origin, or a length beyond a double; the message names the patches
 * Cost O(n²) comparisons; in a scene with dark patches and occluders a search for the
 * patches that light can reach, O(n²) looks between two patches at worst.
 */
HR2D_API hr2d_status hr2d_scene_commit(hr2d_scene *scene);

/** What went wrong in the last call that failed on this scene; "" if none did. */
HR2D_API const char *hr2d_scene_message(const hr2d_scene *scene);

/** The number of patches; a two-sided patch counts twice. */
HR2D_API size_t hr2d_scene_patches(const hr2d_scene *scene);

/** The number of bands, known once the scene is committed; 1 for a grey scene. */
HR2D_API size_t hr2d_scene_bands(const hr2d_scene *scene);

/** The segment of patch `patch` as it was given; `patch` must be in range. */
HR2D_API hr2d_segment hr2d_scene_segment(const hr2d_scene *scene, size_t patch);

/**
 * The length A of patch `patch`, in scene lengths: the hypotenuse of the differences, to a
 * relative 3·2^-53 where hypot() is good to a unit in the last place.
 */
HR2D_API double hr2d_scene_length(const hr2d_scene *scene, size_t patch);

/** The name of patch `patch`; owned by the scene. */
HR2D_API const char *hr2d_scene_name(const hr2d_scene *scene, size_t patch);

/**
 * The index of the first patch called `name`.
 * @return HR2D_OK, or HR2D_EINVAL if there is none
 * Cost O(n).
 */
HR2D_API hr2d_status hr2d_scene_find(const hr2d_scene *scene, const char *name, size_t *patch);

/** E of patch `patch` in band `band` < hr2d_scene_bands(). */
HR2D_API double hr2d_scene_emission(const hr2d_scene *scene, size_t patch, size_t band);

/** ρ of patch `patch` in band `band` < hr2d_scene_bands(). */
HR2D_API double hr2d_scene_reflectance(const hr2d_scene *scene, size_t patch, size_t band);

/** The light from the surroundings in band `band` < hr2d_scene_bands(). */
HR2D_API double hr2d_scene_background(const hr2d_scene *scene, size_t band);

/**
 * The power of two by which committed coordinates are divided, so that the
 * largest lies in [1,2): exact, and nothing is lost by it.  An element's coordinates times this
 * are scene lengths.
 */
HR2D_API double hr2d_scene_unit(const hr2d_scene *scene);

/**
 * Whether a committed scene calls for an effect, and why.
 * @param reason  receives a phrase owned by the scene; may be NULL
 * @return 1 or 0
 */
HR2D_API int hr2d_scene_effect(const hr2d_scene *scene, hr2d_effect effect,
                               const char **reason);

/** The name of an effect, as "occlusion"; NULL outside the enumeration. */
HR2D_API const char *hr2d_effect_name(hr2d_effect effect);

#ifdef __cplusplus
}
#endif
#endif
