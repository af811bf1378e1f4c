/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file policy.h
 * @brief Policies: Acceptable, RecursionLimit and PreferredSubdivision (paper, section 2).
 *
 * @defgroup policy Refinement policies
 * A policy answers the questions of ProjectKernel that the oracle does not answer (paper,
 * section 2): Acceptable, RecursionLimit and PreferredSubdivision.
 * @{
 */
#ifndef HR2D_POLICY_H
#define HR2D_POLICY_H

#include <hr2d/oracle.h>
#include <hr2d/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The elements of a refused pair that are subdivided. */
enum {
  HR2D_SPLIT_FIRST = 0,  /**< the first element: two new pairs */
  HR2D_SPLIT_SECOND = 1, /**< the second element: two new pairs */
  HR2D_SPLIT_BOTH = 2    /**< both: four new pairs */
};

/** Properties of a policy on which the library relies. */
enum {
  HR2D_POLICY_THREAD_SAFE = 2 /**< may be called from several threads at once */
};

/**
 * A policy. Set struct_size to sizeof (hr2d_policy).
 *
 * Every function may be NULL; its comment names the default. Functions return HR2D_OK,
 * HR2D_STOPPED to end the refinement, or any other status.
 */
typedef struct hr2d_policy {
  size_t struct_size; /**< so that the table can grow */
  const char *name;   /**< required; for messages */
  unsigned flags;     /**< HR2D_POLICY_… */

  /**
   * Writes 1 for each acceptable pair, 0 or nothing for others. Default: error ≤ ε.
   */
  hr2d_status (*acceptable)(void *ctx, const hr2d_batch *batch, const double *error,
                            unsigned char *accepted);

  /**
   * Writes 1 for each refused pair that must be linked all the same, 0 or nothing for others.
   * Default: no pair. One limit always holds: an element is not subdivided on level
   * hr2d_refine_options::max_level, or if its midpoint is not a double between its ends.
   */
  hr2d_status (*recursion_limit)(void *ctx, const hr2d_batch *batch, unsigned char *limited);

  /**
   * Writes HR2D_SPLIT_… for each pair. If a value is not one of these or is not written, the
   * refinement fails with HR2D_ECALLBACK. Default: the longer element, or the first of equal
   * ones.
   */
  hr2d_status (*preferred_subdivision)(void *ctx, const hr2d_batch *batch,
                                       unsigned char *split);

  /** Optional. Called once when the owner of ctx, a link set, is destroyed. */
  void (*destroy)(void *ctx);
} hr2d_policy;

/**
 * The paper's algorithm of section 2: the longer element is split.
 * @return a static table
 */
HR2D_API const hr2d_policy *hr2d_policy_original(void);

/**
 * The paper's algorithm of section 3.1: both elements are split.
 * @return a static table
 */
HR2D_API const hr2d_policy *hr2d_policy_modified(void);

/**
 * Finds a built-in policy by its name.
 * @param name  "original" or "modified"
 * @return a static table, or NULL if no policy has this name
 */
HR2D_API const hr2d_policy *hr2d_policy_find(const char *name);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
