/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file linkset.h
 * @brief Links: accepted pairs of elements with their exchange areas.
 *
 * A link set joins a hierarchy with an oracle and a policy.  It starts empty, is
 * filled by hr2d_refine() and read from then on.  One link serves both directions
 * of transport, because A_i F_ij = A_j F_ji, unless the set is directed.
 */
#ifndef HR2D_LINKSET_H
#define HR2D_LINKSET_H

#include <hr2d/hierarchy.h>
#include <hr2d/oracle.h>
#include <hr2d/policy.h>
#include <hr2d/status.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The links of a hierarchy under an oracle and a policy; opaque. */
typedef struct hr2d_linkset hr2d_linkset;

/** An accepted pair. */
typedef struct hr2d_link {
  hr2d_pair pair;       /**< the elements */
  double exchange_area; /**< AF, in scene lengths */
} hr2d_link;

/** What refinement made and what it took. */
typedef struct hr2d_refine_counts {
  uint64_t elements;         /**< N: all nodes of all trees, roots included */
  uint64_t leaves;           /**< elements without children */
  uint64_t links;            /**< L: accepted pairs */
  uint64_t limited_links;    /**< of these, how many only a recursion limit accepted */
  uint64_t oracle_calls;     /**< pairs the oracle was asked about */
  uint64_t facing_tests;     /**< pairs tested for facing each other below the roots */
  uint64_t visibility_tests; /**< walls, and boxes of walls, tested against a shaft */
  uint64_t exchange_areas;   /**< exchange areas computed */
  uint64_t partial_links;    /**< links whose exchange area was integrated around occluders */
  uint64_t blocked_pairs;    /**< pairs dropped because occluders hide them from each other */
  uint64_t dark_pairs;       /**< pairs of patches dropped because no light reaches them */
  unsigned levels;           /**< the deepest level */
} hr2d_refine_counts;

/**
 * Makes an empty link set.
 *
 * @param hierarchy   must outlive the link set
 * @param oracle      NULL for hr2d_oracle_size(); the table is copied
 * @param oracle_ctx  given to the oracle's functions
 * @param policy      NULL for hr2d_policy_original(); the table is copied
 * @param policy_ctx  given to the policy's functions
 * @param links       receives the link set; the caller destroys it
 * @return HR2D_OK, HR2D_ENOMEM, HR2D_EINVAL for a table without its required members
 *
 * On success the link set owns both contexts and hands each to its table's
 * `destroy` exactly once; on failure the caller keeps them.
 */
HR2D_API hr2d_status hr2d_linkset_create(hr2d_hierarchy *hierarchy, const hr2d_oracle *oracle,
                                         void *oracle_ctx, const hr2d_policy *policy,
                                         void *policy_ctx, hr2d_linkset **links);

/** Destroys a link set; NULL is allowed.  Solutions made from it must be gone. */
HR2D_API void hr2d_linkset_destroy(hr2d_linkset *links);

/** The hierarchy a link set stands on. */
HR2D_API const hr2d_hierarchy *hr2d_linkset_hierarchy(const hr2d_linkset *links);

/** What went wrong in the last call that failed on this link set; "" if none did. */
HR2D_API const char *hr2d_linkset_message(const hr2d_linkset *links);

/** L, the number of links stored.  Constant cost. */
HR2D_API uint64_t hr2d_linkset_size(const hr2d_linkset *links);

/** Link `index` < hr2d_linkset_size().  Constant cost. */
HR2D_API hr2d_link hr2d_linkset_get(const hr2d_linkset *links, uint64_t index);

/**
 * Whether links carry light only from `second` to `first`: after a refinement with
 * an oracle that is not symmetric, or with hr2d_refine_options::ordered.
 */
HR2D_API int hr2d_linkset_directed(const hr2d_linkset *links);

/** ε of the last refinement that filled the set; infinity before the first. */
HR2D_API double hr2d_linkset_epsilon(const hr2d_linkset *links);

/** What the refinements that filled the set made and took, summed up. */
HR2D_API hr2d_refine_counts hr2d_linkset_counts(const hr2d_linkset *links);

/**
 * Bytes held by the links: 16 each, in chunks of 4096; and once they were solved at an order p
 * above 1, 8p² + 1 each besides.
 */
HR2D_API uint64_t hr2d_linkset_bytes(const hr2d_linkset *links);

/**
 * Checks that every transport is accounted for exactly once (paper, section 2): each
 * pair of leaves that see each other lies below exactly one link, per direction if
 * the set is directed; no link joins what cannot see each other; and every exchange
 * area is that of its elements.
 *
 * @return HR2D_OK, HR2D_ENOMEM, or HR2D_EINVAL with a message that names the elements
 * Exact: nothing is sampled.  Cost O(n² + L·levels²), memory O(N + L).
 */
HR2D_API hr2d_status hr2d_linkset_validate(hr2d_linkset *links);

#ifdef __cplusplus
}
#endif
#endif
