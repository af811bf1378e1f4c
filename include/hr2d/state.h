/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file state.h
 * @brief A stage of a long solve, kept to be gone on from.
 *
 * With falling ε (multigridding) each refinement goes on from the links of the last and each
 * solve from its B.  What has been reached is written after a stage, to a file or wherever the
 * caller's function puts it, and read back in another process: refining and solving from there
 * gives the same bits as if nothing had happened in between.
 *
 * The format is the same on all machines: whole numbers and doubles with the least significant
 * byte first, behind a line that names it, with a hash of it all behind.  It holds 4 bytes for
 * each division of an element, 16 for each link, and 16 for each coefficient of B.
 */
#ifndef HR2D_STATE_H
#define HR2D_STATE_H

#include <hr2d/linkset.h>
#include <hr2d/solve.h>
#include <hr2d/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Takes the next bytes of a state.
 * @return HR2D_OK to go on; anything else ends the call with that status
 */
typedef hr2d_status (*hr2d_write_fn)(void *ctx, const void *bytes, size_t size);

/**
 * Brings the next bytes of a state: `size` of them, no less.
 * @return HR2D_OK, HR2D_ESYNTAX where there are no more, or what else is to end the call
 */
typedef hr2d_status (*hr2d_read_fn)(void *ctx, void *bytes, size_t size);

/**
 * Writes a solution with its links and elements.
 *
 * @param solution  of hr2d_solve(); unchanged
 * @param write     gets up to 4096 bytes at a time
 * @return HR2D_OK, HR2D_EUNSUPPORTED for a solution of hr2d_solve_to(), whose stages do not go
 *         on from each other, or the status of `write`
 * Allocates nothing.  Cost O((N·p·bands) + L).
 */
HR2D_API hr2d_status hr2d_state_write(const hr2d_solution *solution, hr2d_write_fn write,
                                      void *ctx);

/**
 * Reads a state into an empty link set: from then on it, its hierarchy and the solution are
 * bit for bit as they were when it was written.  hr2d_linkset_epsilon() tells how far it had
 * come.
 *
 * @param links     empty, on a hierarchy without divisions, with the oracle and policy of the
 *                  one that was written, on the same scene, whose names alone may differ; on
 *                  failure it and its hierarchy are as before
 * @param read      asked for up to 4096 bytes at a time, and for none behind the state
 * @param solution  receives the solution; the caller destroys it
 * @return HR2D_OK; HR2D_ESTATE if `links` is not empty; HR2D_EINVAL for a state of another
 *         scene, oracle or policy; HR2D_ESYNTAX for what is no state, or a damaged one;
 *         HR2D_ENOMEM, or the status of `read`; a message says more
 *
 * Damage of any kind is found by the hash; of a state that was made up the numbers are checked
 * so far that nothing worse than wrong values can come of it, and hr2d_linkset_validate()
 * checks the links.  Memory as for the objects themselves, never more than a small multiple of
 * the bytes that were read.
 */
HR2D_API hr2d_status hr2d_state_read(hr2d_linkset *links, hr2d_read_fn read, void *ctx,
                                     hr2d_solution **solution);

#ifdef __cplusplus
}
#endif
#endif
