/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file visibility.h
 * @brief Exchange areas with occluders, and of all patches of a scene.
 *
 * @defgroup visibility Visibility
 * Exchange areas with occluders, and of all patches of a scene.
 *
 * In the plane, the lines from a segment i to a segment j that miss every occluder fall into
 * finitely many line classes (homotopy classes). The lines of one class have the same
 * occluders on their right and the same on their left. They are the lines that separate two
 * convex chains, as in an hourglass of Guibas and Hershberger, and their measure is a sum of
 * unoccluded exchange areas, none negative. The sum over the classes is exact: nothing is
 * sampled, and there is no tolerance to choose.
 * @{
 */
#ifndef HR2D_VISIBILITY_H
#define HR2D_VISIBILITY_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/options.h>
#include <hr2d/refine.h>
#include <hr2d/scene.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * The exchange area AF = ∫i∫j G V of two segments with occluders between them.
 * @param i         a segment
 * @param j         another one
 * @param occluder  `count` segments that block light from either side. They may have any
 *                  position, and may touch, overlap and cross. A segment has no effect if it is
 *                  behind i or j, outside of the convex hull of both, or along i or j
 * @param count     number of occluders
 * @param alloc     hooks for work space; NULL for malloc()
 * @param area      receives AF in scene lengths
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a coordinate is not finite
 * @retval HR2D_ERANGE  the scales of the coordinates are too far apart for a common scale
 *
 * Swapping i and j changes no bit. Without an occluder in the way the value is
 * hr2d_exchange_area(i, j). Exact signs decide whether AF is 0. An end of an occluder that lies
 * within four units in the last place of the line of i or j counts as lying on it, because an
 * end that was computed to lie there is that far off. Where i, j and occluders miss each other
 * by as little, they count as touching.
 *
 * Let D be the extent of all segments. The error is
 * - below 2^-46 D, also in the worst case that hill climbing finds, and if ends miss each other
 *   or other segments by any distance;
 * - relative to AF itself if two points alone bound the view.
 *
 * An end that counts as lying on i or j, but does not, costs that distance, divided by the sine
 * of the angle at which its occluder stands there.
 *
 * Thread-safe. Occluders that are not between i and j cost O(count), the others O(count log
 * count) and the line classes that are not blocked: of random occluders in a room about 1 µs
 * for each that is outside, and 10 µs for each that is inside and leaves gaps.
 */
HR2D_API hr2d_status hr2d_exchange_area_occluded(const hr2d_segment *i, const hr2d_segment *j,
                                                 const hr2d_segment *occluder, size_t count,
                                                 const hr2d_allocator *alloc, double *area);

/** Options of hr2d_exchange_area_past(); members that are 0 have their defaults. */
typedef struct hr2d_past_options {
  size_t struct_size;          /**< so that the options can grow */
  const hr2d_allocator *alloc; /**< hooks for work space; NULL for malloc() */
  hr2d_progress_fn progress;   /**< optional; with the phase "factors" */
  void *progress_ctx;          /**< given to `progress` */
} hr2d_past_options;

/**
 * hr2d_exchange_area_occluded() with options, so that it can be stopped. With 100,000 occluders
 * it takes a tenth of a second and more.
 * @param i         a segment
 * @param j         another one
 * @param occluder  as there
 * @param count     as there
 * @param area      as there
 * @param options   NULL for the defaults
 * @retval other   the status of the progress callback; otherwise as there
 */
HR2D_API hr2d_status hr2d_exchange_area_past(const hr2d_segment *i, const hr2d_segment *j,
                                             const hr2d_segment *occluder, size_t count,
                                             const hr2d_past_options *options, double *area);

/** Options of the calls for all patches. Start from #HR2D_MATRIX_OPTIONS_INIT. */
typedef struct hr2d_matrix_options {
  size_t struct_size;        /**< so that the options can grow */
  unsigned threads;          /**< 0 for one, or #HR2D_ALL_THREADS; no bit depends on it */
  hr2d_progress_fn progress; /**< optional; with the phase "factors", from the calling thread */
  void *progress_ctx;        /**< given to `progress` */
  double *cut_off_estimate;  /**< NULL, or receives for each patch the estimated error of its
                                  row because images of a period are cut off: Σ_j |error of
                                  AF_ij|, in scene lengths; 0 if no visible image is cut off.
                                  symmetry.h has the extrapolation */
  double *cut_off_bound;     /**< likewise the bound of this error */
} hr2d_matrix_options;

/** The defaults: one thread, no callback. */
#define HR2D_MATRIX_OPTIONS_INIT                                                               \
  { sizeof(hr2d_matrix_options), 0, NULL, NULL, NULL, NULL }

/**
 * Does what #HR2D_MATRIX_OPTIONS_INIT does, for languages without macros: sets all bytes to 0,
 * and `struct_size`.
 * @param options  the struct
 * @param size     its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_matrix_options_init(hr2d_matrix_options *options, size_t size);

/** The work of the calls for all patches. */
typedef struct hr2d_matrix_counts {
  uint64_t exchange_areas;   /**< pairs of patches that see each other */
  uint64_t partial_pairs;    /**< of these, pairs that occluders hide from each other in part */
  uint64_t visibility_tests; /**< triangles between the patches that beams passed */
} hr2d_matrix_counts;

/**
 * The exchange areas of all pairs of patches, as a full matrix. Row i, divided by
 * hr2d_scene_length(i), has the view factors F_ij.
 * @param scene    committed
 * @param options  NULL for the defaults
 * @param area     receives n × n exchange areas in scene lengths, row by row, with n =
 *                 hr2d_scene_patches(); symmetric bit for bit; undefined on failure
 * @param counts   receives the work; may be NULL
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  `struct_size` of the options is too small
 * @retval HR2D_ESTATE  the scene is not committed
 * @retval other        the status of the progress callback
 *
 * Errors are those of hr2d_exchange_area_occluded(). In a closed room each row sums to the
 * length A of its patch within 1e-13·A and 64 units in the last place of the largest
 * coordinate. If ends pass through other patches by a rounding, the sum is within 2⁻²⁸ of that
 * coordinate; hr2d_scene_commit() refuses scenes that would lose more.
 *
 * Beams start at each wall and end at the first wall that they meet, so that hidden pairs cost
 * nothing; patches on one line are one wall. Several calls may run on one scene at once. With
 * several threads the hooks of the scene are called from all of them. Cost O(n²) for the
 * matrix, O(n log n) to triangulate the plane between the walls, some 50 ns for each pair that
 * sees each other and 15 ns for each triangle that beams pass, mostly four for each pair of
 * walls.
 */
HR2D_API hr2d_status hr2d_exchange_matrix(const hr2d_scene *scene,
                                          const hr2d_matrix_options *options, double *area,
                                          hr2d_matrix_counts *counts);

/** The end of a beam from a point. */
typedef enum hr2d_seen {
  HR2D_SEEN_FRONT, /**< the front of a patch */
  HR2D_SEEN_BACK,  /**< the back of a patch that has only a front: opaque and black */
  HR2D_SEEN_SKY,   /**< nothing: the background */
  HR2D_SEEN_PAST   /**< the view past the images of a period that are taken, see symmetry.h */
} hr2d_seen;

/** The directions in which a point sees a part of one patch or of one wall, or the sky. */
typedef struct hr2d_beam {
  size_t struct_size; /**< its size as the library knows it */
  hr2d_seen seen;     /**< the end of the beam */
  size_t patch;       /**< the patch whose front is seen: gn + k for image g of patch k, of n
                           patches that were given; 0 if none is */
  double from;        /**< where its part begins, a fraction of its length; else 0 */
  double to;          /**< where the part ends, above `from`; else 0 */
  double factor;      /**< the form factor from the point to its end, greater than 0 */
  hr2d_point right;   /**< the direction of the right border, a unit vector */
  hr2d_point left;    /**< of the left border; looking ahead, with the patch's b on the right */
  hr2d_segment end;   /**< the part that is seen, from right to left, in scene coordinates;
                           zeros: sky */
} hr2d_beam;

/**
 * Takes a beam, which is valid until the function returns.
 * @param ctx   as given to hr2d_beams_visit()
 * @param beam  the beam
 * @return HR2D_OK, or a status that ends the call
 */
typedef hr2d_status (*hr2d_beam_fn)(void *ctx, const hr2d_beam *beam);

/**
 * Shows the view from a point of a patch as beams, in order from the direction of its b to
 * that of its a. They come from a triangular expansion.
 * @param scene  committed
 * @param patch  index of a patch
 * @param t      fraction of the patch in [0,1], counted from its start. Where another patch
 *               touches this point, it is the limit from the inside of this patch, on the side
 *               of its middle
 * @param visit  called once for each beam, from the right to the left
 * @param ctx    given to `visit`
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  there is no such patch, or t is not in [0,1]
 * @retval HR2D_ESCENE  the scene has no effect of occlusion, and so many patches cross each
 *                      other within roundings that the plane between them is unknown
 * @retval HR2D_ESTATE  the scene is not committed
 * @retval other        the status of the visitor, or of the progress callback of the scene
 *
 * Patches that were given some periods apart appear where commit has brought them together,
 * see symmetry.h.
 *
 * Each beam begins in the direction in which the last one ended, so that the factors sum to 1
 * within roundings. The part of a patch that touches the point may be a single point. A patch
 * that lies within roundings behind another one sees a single back, at the point itself.
 *
 * Several calls may run on one scene at once. Cost: 0.1 µs for each triangle of the plane that
 * the view passes; if the scene does not call for occlusion, O(n log n) for that plane at each
 * call, which hr2d_scene_force() spares.
 */
HR2D_API hr2d_status hr2d_beams_visit(const hr2d_scene *scene, size_t patch, double t,
                                      hr2d_beam_fn visit, void *ctx);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
