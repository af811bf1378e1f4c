/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file share.h
 * @brief Several processes, or threads, that solve one scene together.
 *
 * @defgroup share Shares of a solve
 * Several processes, or threads, that solve one scene together.
 *
 * @warning Unstable interface: for user-written solvers and distributions. It may change in
 * any release, see doc/compatibility.md.
 *
 * Each has a share of the pairs of patches: it makes their links and the p × p blocks of
 * these, and gathers over them. Every share has all elements and the fields on them. Where a
 * number needs all links, the library calls hr2d_share::combine, which combines the values of
 * all shares. So the memory and the time for links and blocks are divided by the number of
 * shares:
 *
 *     hr2d_share share = {.struct_size = sizeof share, .number = me, .count = all,
 *                         .combine = combine, .ctx = …};
 *     hr2d_target target = HR2D_TARGET_INIT;
 *     target.share = &share;
 *     hr2d_solve_to(scene, &target, &solution, &account);
 *
 * All shares make the same calls on the same scene. hr2d_refine_options::share is for a
 * refinement: its links, and the solves on them, are then shared. hr2d_linkset_size() counts
 * the links of this share, hr2d_linkset_counts() those of all. Solutions are whole on every
 * share: averages, points and pictures need no other process.
 *
 * **Same bits.** Sums over shares round each term so that the sum does not depend on their
 * order. No digit of a solution depends on the number of shares. Without shares sums are
 * plain, and a solution differs by roundings. Elements, links and oracle calls are those of
 * one process, exactly.
 *
 * **Failures.** If a call fails on one share, it fails on all of them with the same status;
 * none waits for ever. Budgets of bytes, links and elements are those of each share. A budget
 * of time is that of the clock of share 0.
 *
 * Each share searches its part of the visibility events, and receives those of all shares.
 *
 * Each pair of patches belongs to the row of its earlier patch. With
 * hr2d_refine_options::share each share gets runs of whole rows. With a target rows are
 * counted first, and a long row is cut into ranges of the other patch of its pairs. Each share
 * that has a part of such a row traces the beams of its patch. Where few patches have many
 * links, several shares refine the same pairs, and each keeps its part of the links. All shares
 * get nearly the same number of links. hr2d_linkset_own_tests() returns the visibility tests of
 * this one. Every share has the links between clusters of patches (clusters.h), and all data of
 * the scene. A further refinement of a set may make other visibility tests than one process.
 * States hold the links of one share only: hr2dp_save_solution() of libhr2d-petsc keeps B
 * alone, and makes the links again.
 *
 * libhr2d-petsc has a `combine` for MPI. This one is for processes of one machine:
 *
 * @include together.c
 * @{
 */
#ifndef HR2D_SHARE_H
#define HR2D_SHARE_H

#include <hr2d/linkset.h>
#include <hr2d/oracle.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How the values of all shares are combined. */
typedef enum hr2d_combine {
  HR2D_COMBINE_SUM = 0, /**< their sum; it is exact, in any order of adding */
  HR2D_COMBINE_MOST     /**< the largest */
} hr2d_combine;

/**
 * Combines values of all shares: value k becomes the sum, or the largest, of the values k of
 * all.
 *
 * Shares call it in the same order, with the same `how` and `count`. A share that has failed
 * calls it once with its status, whatever the others call at that time: `how`, `value` and
 * `count` have no meaning then, and all shares get a status that is not HR2D_OK, the same on
 * each.
 * @param ctx     hr2d_share::ctx
 * @param status  of this share: HR2D_OK, or why it has failed
 * @param how     the way to combine the values
 * @param value   `count` values of this share; receives those of all
 * @param count   may be 0: then only the status matters
 * @return HR2D_OK if all shares gave it; else the status of one that did not, the same on all
 */
typedef hr2d_status (*hr2d_combine_fn)(void *ctx, hr2d_status status, hr2d_combine how,
                                       double *value, size_t count);

/**
 * One of the shares. It must outlive the link sets that are made with it; one call at a time
 * uses it.
 */
typedef struct hr2d_share {
  size_t struct_size;      /**< so that the struct can grow */
  unsigned number;         /**< from 0, below `count`; else calls return HR2D_EINVAL */
  unsigned count;          /**< of all shares */
  hr2d_combine_fn combine; /**< required; called with this struct's `ctx` */
  void *ctx;               /**< given to `combine` */
  hr2d_status failed;      /**< for the library alone; HR2D_OK at the start */
} hr2d_share;

/**
 * Selects pairs before any test of facing or visibility, and before the oracle. So the time of
 * a refinement is proportional to the pairs that are kept. This is for processes that share a
 * refinement, or if only some exchanges are of interest.
 * @param ctx      hr2d_refine_options::claim_ctx
 * @param batch    pairs of patches, or pairs that come from a subdivision
 * @param claimed  one per pair, all 1: set to 0, the pair is dropped, with all pairs below it
 * @return HR2D_OK to continue; any other value ends the refinement with this status
 */
typedef hr2d_status (*hr2d_claim_fn)(void *ctx, const hr2d_batch *batch,
                                     unsigned char *claimed);

/** The work of one row: of the pairs whose first element is of one patch. */
typedef struct hr2d_row_counts {
  uint64_t links;            /**< as hr2d_refine_counts::links */
  uint64_t visibility_tests; /**< as hr2d_refine_counts::visibility_tests */
} hr2d_row_counts;

/**
 * The tests of visibility that this process has made for the links of a set. With several
 * shares (share.h) hr2d_linkset_counts() has the tests of one process; where shares refine the
 * same rows, together they make more.
 * @param links  a link set
 * @return as hr2d_refine_counts::visibility_tests, of this share alone; constant cost
 */
HR2D_API uint64_t hr2d_linkset_own_tests(const hr2d_linkset *links);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
