/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file policy.h
 * @brief Policies answer the other questions of ProjectKernel (paper, section 2):
 *        Acceptable, RecursionLimit and PreferredSubdivision.
 */
#ifndef HR2D_POLICY_H
#define HR2D_POLICY_H

#include <hr2d/oracle.h>
#include <hr2d/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What to subdivide when a pair is refused. */
enum {
  HR2D_SPLIT_FIRST = 0,  /**< the first element: two new pairs */
  HR2D_SPLIT_SECOND = 1, /**< the second element: two new pairs */
  HR2D_SPLIT_BOTH = 2    /**< both: four new pairs */
};

/** What the library may assume of a policy. */
enum {
  HR2D_POLICY_THREAD_SAFE = 2 /**< may be called from several threads at once */
};

/**
 * A policy: set struct_size to sizeof (hr2d_policy).  Every function may be
 * NULL, which means the default named with it.  Functions return HR2D_OK,
 * HR2D_STOPPED to end the refinement, or any other status.
 */
typedef struct hr2d_policy {
  size_t struct_size; /**< so that the table can grow */
  const char *name;   /**< required; for messages */
  unsigned flags;     /**< HR2D_POLICY_… */

  /**
   * Writes 1 for each pair whose error is acceptable, for others 0 or nothing.  Default:
   * error ≤ ε.
   */
  hr2d_status (*acceptable)(void *ctx, const hr2d_batch *batch, const double *error,
                            unsigned char *accepted);

  /**
   * Writes 1 for each refused pair that is to be linked all the same, for others 0 or
   * nothing.  Default:
   * never, beyond the limit that always holds: an element on level
   * hr2d_refine_options::max_level, or one whose midpoint is no longer a double
   * between its ends, is not subdivided.
   */
  hr2d_status (*recursion_limit)(void *ctx, const hr2d_batch *batch, unsigned char *limited);

  /**
   * Writes HR2D_SPLIT_… for each pair; anything else, and nothing, is an error of the
   * callback (HR2D_ECALLBACK).  Default: the longer element, on a tie the first.
   */
  hr2d_status (*preferred_subdivision)(void *ctx, const hr2d_batch *batch,
                                       unsigned char *split);

  /** Optional.  Called once when the owner of ctx, a link set, is destroyed. */
  void (*destroy)(void *ctx);
} hr2d_policy;

/** The paper's algorithm of section 2: the longer element is split. */
HR2D_API const hr2d_policy *hr2d_policy_original(void);

/** The paper's algorithm of section 3.1: both elements are split. */
HR2D_API const hr2d_policy *hr2d_policy_modified(void);

/**
 * A built-in policy by name: "original", "modified".
 * @return NULL if there is none of that name
 */
HR2D_API const hr2d_policy *hr2d_policy_find(const char *name);

#ifdef __cplusplus
}
#endif
#endif
