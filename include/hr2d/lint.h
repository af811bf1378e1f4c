/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file lint.h
 * @brief Warnings about scenes that are valid, but maybe not meant.
 *
 * @defgroup lint Warnings
 * Warnings about scenes that are valid, but maybe not meant.
 *
 * A valid scene may still not be the one that its author has in mind: a wall ends a millimetre
 * short of the next one, a front looks out of the room, a property has another name.
 * hr2d_scene_lint() says so. Nothing that it finds changes a solution.
 * @{
 */
#ifndef HR2D_LINT_H
#define HR2D_LINT_H

#include <hr2d/geometry.h>
#include <hr2d/options.h>
#include <hr2d/progress.h>
#include <hr2d/scene.h>
#include <hr2d/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The subject of a warning. New values are only added before HR2D_WARNING_COUNT. */
typedef enum hr2d_warning_code {
  HR2D_WARNING_IGNORED = 0,  /**< a file has a property that is not read, but looks meant */
  HR2D_WARNING_MISPLACED,    /**< a property stands where it is not read */
  HR2D_WARNING_ALTITUDE,     /**< positions have a third number, which is not read */
  HR2D_WARNING_DEGREES,      /**< coordinates look like longitude and latitude */
  HR2D_WARNING_UNITS,        /**< coordinates look like centimetres or millimetres,
                                  temperatures like degrees Celsius, or wavelengths like metres
                                  or nanometres */
  HR2D_WARNING_LOOSE_END,    /**< a patch ends just short of another one */
  HR2D_WARNING_NARROW_GAP,   /**< there is a narrow opening between two patches */
  HR2D_WARNING_NEAR_COPY,    /**< a patch lies beside another one, just off it */
  HR2D_WARNING_DARK_SCENE,   /**< nothing sends light */
  HR2D_WARNING_UNLIT,        /**< no light reaches the front of a patch */
  HR2D_WARNING_SEES_NOTHING, /**< the front of a patch sees no other front */
  HR2D_WARNING_NO_ABSORBER,  /**< no patch absorbs light in some band */
  HR2D_WARNING_NO_SUNLIGHT,  /**< no sun lights the front of any patch */
  HR2D_WARNING_SEES_BACK,    /**< fronts see the back of a patch, which is black */
  HR2D_WARNING_NO_SKY,       /**< the surroundings send light, and no front sees them */
  HR2D_WARNING_SHIELD,       /**< both sides of a patch have a given flux */
  HR2D_WARNING_LOW_SUN,      /**< images of a period that are cut off may stand in the light of
                                  a sun */
  HR2D_WARNING_SKIPPED,      /**< a file has geometries or positions that make no patch */
  HR2D_WARNING_COUNT         /**< the number of codes */
} hr2d_warning_code;

/** A warning. */
typedef struct hr2d_warning {
  size_t struct_size;     /**< its size as the library knows it */
  hr2d_warning_code code; /**< its subject */
  const char *text;       /**< a sentence with the place and a remedy */
  size_t patches;         /**< how many members of `patch` are set: 0, 1 or 2 */
  size_t patch[2];        /**< the patches it names; of many, the first two */
  hr2d_point at;          /**< of a gap: the end of `patch[0]` beside it; else (0, 0) */
  double gap;             /**< of a gap: its width in scene lengths; else 0 */
} hr2d_warning;

/**
 * Takes a warning, which is valid until the function returns.
 * @param ctx      as given to hr2d_scene_lint()
 * @param warning  the warning
 * @return HR2D_OK, or a status that ends the call
 */
typedef hr2d_status (*hr2d_warning_fn)(void *ctx, const hr2d_warning *warning);

/** Options of hr2d_scene_lint(); members that are 0 have their defaults. */
typedef struct hr2d_lint_options {
  size_t struct_size;        /**< so that the options can grow */
  double gap;                /**< openings below this part of the scene are narrow (1e-3); at
                                  most 0.1 */
  hr2d_progress_fn progress; /**< optional; with the phase "lint" */
  void *progress_ctx;        /**< given to `progress` */
} hr2d_lint_options;

/** The defaults. */
#define HR2D_LINT_OPTIONS_INIT                                                                 \
  { sizeof(hr2d_lint_options), 0, NULL, NULL }

/**
 * Does what #HR2D_LINT_OPTIONS_INIT does, for languages without macros: sets all bytes to 0,
 * and `struct_size`.
 * @param options  the struct
 * @param size     its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_lint_options_init(hr2d_lint_options *options, size_t size);

/**
 * Finds valid properties of a scene that its author may not have meant, and shows each as a
 * warning.
 *
 * A gap is the distance from an end of a patch to another patch, if no patches close it there.
 * It is narrow below options.gap of the extent of the scene, unless it is wider than a
 * twentieth of the shorter patch. An end is loose if no other patch touches it. Two loose ends
 * of patches at an angle make a corner that is missed, up to five times as wide a gap, and a
 * hundredth of the shorter patch. Two patches along each other whose fronts look apart, as the
 * two sides of a thin plate, are no gap.
 *
 * A front "sees nothing" if no ray from nine of its points meets a front, or the sky of a scene
 * with a background. Without a background only patches that emit are tested; of the others,
 * those that no light reaches are shown. In a scene without light, patches whose back is seen
 * are shown.
 *
 * A back is seen if it fills a hundredth or more of the view from the middle of a front.
 *
 * Backs that are seen make one warning, fronts that see nothing another, and those that no
 * light reaches a third: its text names the first three and counts the rest. A patch of a
 * feature without a name is called by the number of the feature in its file, "patch 8 (feature
 * 3)".
 *
 * @param scene    committed or not; without a commit warnings about light and views are
 *                 missing. This helps with a scene that hr2d_scene_commit() refuses
 * @param warn     called for each warning; those of one code come by patch, and all in the same
 * order for the same scene
 * @param ctx      given to `warn`
 * @param options  NULL for the defaults
 * @retval HR2D_OK      success, with or without warnings
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  `struct_size` of the options is too small, or `gap` is not in [0, 0.1]
 * @retval other        the status of `warn`, or of the progress callback
 *
 * Several calls may run on one committed scene at once. Cost O(n log n + k), with k the pairs
 * of patches that are nearer than the narrow gap, and a few rays from each patch that is
 * tested.
 */
HR2D_API hr2d_status hr2d_scene_lint(const hr2d_scene *scene, hr2d_warning_fn warn, void *ctx,
                                     const hr2d_lint_options *options);

/**
 * The name of a code.
 * @param code  the code
 * @return a static string, for example "loose-end"; NULL outside of the enumeration
 */
HR2D_API const char *hr2d_warning_name(hr2d_warning_code code);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
