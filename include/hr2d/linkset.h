/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file linkset.h
 * @brief Links: accepted pairs of elements with their exchange areas.
 *
 * @defgroup linkset Link set
 * Links: accepted pairs of elements with their exchange areas.
 *
 * A link set joins a hierarchy with an oracle and a policy. It starts empty; hr2d_refine()
 * fills it, and can refine it further. One link serves both directions of transport, because
 * A_i F_ij = A_j F_ji, unless the set is directed.
 * @{
 */
#ifndef HR2D_LINKSET_H
#define HR2D_LINKSET_H

#include <hr2d/hierarchy.h>
#include <hr2d/oracle.h>
#include <hr2d/policy.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The links of a hierarchy, chosen by an oracle and a policy; opaque. */
typedef struct hr2d_linkset hr2d_linkset;

/** An accepted pair. */
typedef struct hr2d_link {
  hr2d_pair pair;       /**< the elements */
  double exchange_area; /**< AF, in scene lengths */
} hr2d_link;

/** The result and the work of a refinement. */
typedef struct hr2d_refine_counts {
  uint64_t elements;         /**< N: all nodes of all trees, roots included */
  uint64_t leaves;           /**< elements without children */
  uint64_t links;            /**< L: accepted pairs */
  uint64_t limited_links;    /**< links that only a recursion limit accepted */
  uint64_t oracle_calls;     /**< pairs that the oracle was asked about */
  uint64_t facing_tests;     /**< pairs below the roots, tested for facing each other */
  uint64_t visibility_tests; /**< triangles passed by beams, and line classes cut to elements */
  uint64_t exchange_areas;   /**< exchange areas that were computed */
  uint64_t partial_links;    /**< links whose exchange area was integrated around occluders */
  uint64_t blocked_pairs;    /**< pairs dropped because occluders hide them from each other */
  uint64_t dark_pairs;       /**< pairs of patches dropped because no light reaches them */
  unsigned levels;           /**< the deepest level */
} hr2d_refine_counts;

/**
 * Makes an empty link set.
 * @param hierarchy   must outlive the link set
 * @param oracle      NULL for hr2d_oracle_size(); the table is copied
 * @param oracle_ctx  given to the functions of the oracle
 * @param policy      NULL for hr2d_policy_original(); the table is copied
 * @param policy_ctx  given to the functions of the policy
 * @param links       receives the link set; the caller destroys it
 * @retval HR2D_OK      success
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  a table lacks a required member
 *
 * On success the link set owns both contexts: it gives each to the `destroy` of its table,
 * exactly once. On failure the caller keeps them.
 */
HR2D_API hr2d_status hr2d_linkset_create(hr2d_hierarchy *hierarchy, const hr2d_oracle *oracle,
                                         void *oracle_ctx, const hr2d_policy *policy,
                                         void *policy_ctx, hr2d_linkset **links);

/**
 * Destroys a link set. Destroy all solutions that are made from it first.
 * @param links  may be NULL
 */
HR2D_API void hr2d_linkset_destroy(hr2d_linkset *links);

/**
 * The hierarchy of a link set.
 * @param links  a link set
 * @return the hierarchy given to hr2d_linkset_create()
 */
HR2D_API const hr2d_hierarchy *hr2d_linkset_hierarchy(const hr2d_linkset *links);

/**
 * The reason of the last call that failed on this link set.
 * @param links  a link set
 * @return a sentence, owned by the link set and overwritten by the next failure; "" if no call
 *         failed
 */
HR2D_API const char *hr2d_linkset_message(const hr2d_linkset *links);

/**
 * The number L of stored links.
 * @param links  a link set
 * @return L; constant cost
 */
HR2D_API uint64_t hr2d_linkset_size(const hr2d_linkset *links);

/**
 * One link.
 * @param links  a link set
 * @param index  below hr2d_linkset_size()
 * @return the link; constant cost
 */
HR2D_API hr2d_link hr2d_linkset_get(const hr2d_linkset *links, uint64_t index);

/**
 * Copies links that follow each other: much faster than one call for each.
 * @param links  a link set
 * @param first  the number of the first one, at most hr2d_linkset_size()
 * @param count  how many are wanted
 * @param link   receives them, as hr2d_linkset_get() gives them
 * @return how many there are: `count`, or less at the end of the set
 *
 * Thread-safe as long as nothing changes the set. Cost O(count).
 */
HR2D_API size_t hr2d_linkset_read(const hr2d_linkset *links, uint64_t first, size_t count,
                                  hr2d_link *link);

/**
 * Tests whether links carry light only from `second` to `first`.
 *
 * They do so after a refinement with an oracle that is not symmetric, or with
 * hr2d_refine_options::ordered.
 *
 * @param links  a link set
 * @retval 1  links carry one direction
 * @retval 0  links carry both directions
 */
HR2D_API int hr2d_linkset_directed(const hr2d_linkset *links);

/**
 * The ε of the last refinement that filled the set.
 * @param links  a link set
 * @return ε; infinity before the first refinement
 */
HR2D_API double hr2d_linkset_epsilon(const hr2d_linkset *links);

/**
 * The oracle of a set.
 * @param links  a link set
 * @return the table, a copy that the set owns
 */
HR2D_API const hr2d_oracle *hr2d_linkset_oracle(const hr2d_linkset *links);

/**
 * The policy of a set.
 * @param links  a link set
 * @return the table, a copy that the set owns
 */
HR2D_API const hr2d_policy *hr2d_linkset_policy(const hr2d_linkset *links);

/**
 * The result and the work of the refinements that filled the set.
 * @param links  a link set
 * @return elements, leaves, levels, links, limited_links and partial_links as they are now; the
 *         other members as sums over all refinements
 */
HR2D_API hr2d_refine_counts hr2d_linkset_counts(const hr2d_linkset *links);

/**
 * The memory of the links.
 * @param links  a link set
 * @return bytes: 16 per link, or about 11 (hr2d_refine_options::packed), allocated for 4096
 *         links at a time, beyond 4 MiB in steps of 2 MiB or 3 %; plus 8p² + 1 per link after a
 *         solve at an order p > 1, or 4p² + 1 with blocks of floats, as hr2d_solve_to() may
 * make them; plus the links between clusters of hr2d_solve_to()
 */
HR2D_API uint64_t hr2d_linkset_bytes(const hr2d_linkset *links);

/**
 * Checks that every transport is accounted for exactly once (paper, section 2).
 *
 * - Each pair of leaves that see each other lies below exactly one link, per direction if the
 *   set is directed.
 * - No link joins elements that cannot see each other, up to roundings of midpoints.
 * - Every exchange area is the exchange area of its elements; in scenes with walls in the way,
 * to 4e-15 of the largest coordinate, as midpoints are rounded.
 *
 * @param links  a link set
 * @retval HR2D_OK      all of this holds
 * @retval HR2D_ENOMEM  an allocation failed
 * @retval HR2D_EINVAL  something does not hold; the message names the elements
 *
 * Exact: nothing is sampled. Cost O(n² + L·levels²), memory O(N + L).
 */
HR2D_API hr2d_status hr2d_linkset_validate(hr2d_linkset *links);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
