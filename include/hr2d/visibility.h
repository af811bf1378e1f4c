/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file visibility.h
 * @brief What is exchanged when there are things in the way.
 *
 * In the plane the lines from a segment i to a segment j that miss every occluder fall
 * into finitely many classes, by which occluders they leave on their right and which on
 * their left.  The lines of one class are those that separate two convex chains, and
 * their measure is a sum of unoccluded exchange areas, none negative.  The sum over the
 * classes is exact: nothing is sampled and there is no tolerance to choose.
 */
#ifndef HR2D_VISIBILITY_H
#define HR2D_VISIBILITY_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
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
 *
 * @param i,j       two segments
 * @param occluder  `count` segments that block light from either side, in any position:
 *                  what is behind i or j, or outside of the pair's shaft, does nothing; nor
 *                  does what lies along i or j; occluders may touch, overlap and cross
 * @param alloc     hooks for work space; NULL for malloc
 * @param area      receives AF in scene lengths
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_EINVAL for a coordinate that is not finite,
 *         HR2D_ERANGE for coordinates whose scales lie too far apart to be scaled alike
 *
 * Swapping i and j changes no bit.  Without an occluder in the way the value is
 * hr2d_exchange_area(i, j).  Whether AF is 0 is decided by exact signs; an end of an
 * occluder that lies within four units in the last place of the line of i or of j counts as
 * lying on it, as one does that was computed to.
 *
 * With D the extent of all that is given, the error is below 2^-46 D on rooms of every kind
 * that the tests draw at random, and below 1e-11 D for the worst that hill climbing finds among
 * segments whose ends lie on the lines of others exactly or at least 1e-6 D off them; where the
 * view is bounded by two points alone it is relative to AF itself.  Ends nearer than that, but
 * not on the line, cost digits in proportion; with patches whose ends miss each other or an
 * occluder's line by 1e-13 D and less, what is in the way may be taken wrongly, and AF with it:
 * let ends that are to meet have the same coordinates (hr2d_scene_split_crossings() sees to
 * it). Cost O(count) and what the classes of lines cost that are not blocked.
 */
HR2D_API hr2d_status hr2d_exchange_area_occluded(const hr2d_segment *i, const hr2d_segment *j,
                                                 const hr2d_segment *occluder, size_t count,
                                                 const hr2d_allocator *alloc, double *area);

/** How to integrate all exchange areas.  Start from #HR2D_MATRIX_OPTIONS_INIT. */
typedef struct hr2d_matrix_options {
  size_t struct_size;        /**< so that the options can grow */
  unsigned threads;          /**< 0 for all; no bit depends on it */
  hr2d_progress_fn progress; /**< optional; with the phase "factors", from the calling
                                  thread */
  void *progress_ctx;        /**< given to `progress` */
} hr2d_matrix_options;

/** One thread, no callback. */
#define HR2D_MATRIX_OPTIONS_INIT                                                               \
  { sizeof(hr2d_matrix_options), 1, NULL, NULL }

/** What hr2d_exchange_matrix() took. */
typedef struct hr2d_matrix_counts {
  uint64_t exchange_areas;   /**< pairs of patches whose exchange area was computed */
  uint64_t partial_pairs;    /**< of these, pairs integrated around occluders */
  uint64_t blocked_pairs;    /**< pairs that occluders hide from each other */
  uint64_t visibility_tests; /**< walls, and boxes of walls, tested against a shaft */
} hr2d_matrix_counts;

/**
 * The exchange areas of all pairs of patches: row i, divided by hr2d_scene_length(i), has
 * the view factors F_ij.
 *
 * @param scene    committed
 * @param options  NULL for the defaults
 * @param area     receives n × n exchange areas in scene lengths, row by row, n being
 *                 hr2d_scene_patches(); symmetric bit for bit
 * @param counts   receives what it took; may be NULL
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_ESTATE if the scene is not committed, or the status of
 *         the progress callback
 *
 * Errors are those of hr2d_exchange_area_occluded().  In a closed room each row sums to its
 * patch's length A within 1e-13·A and 64 units in the last place of the largest coordinate; and
 * within 2⁻²⁸ of that coordinate where ends go through other patches by a rounding
 * (hr2d_scene_commit(), which refuses what would cost more).
 *
 * Runs of patches on one line are treated as one wall as long as what they see is wholly
 * clear or wholly blocked.  Several calls may run on one scene at once; with several
 * threads the scene's hooks are called from all of them.  Cost O(n²), and a test per wall in
 * the shaft of each two runs of which one is in the other's way.
 */
HR2D_API hr2d_status hr2d_exchange_matrix(const hr2d_scene *scene,
                                          const hr2d_matrix_options *options, double *area,
                                          hr2d_matrix_counts *counts);

#ifdef __cplusplus
}
#endif
#endif
