/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file state.h
 * @brief Saves a stage of a long solve so that it can be resumed.
 *
 * @defgroup state State on disk
 * Saves a stage of a long solve so that it can be resumed.
 *
 * With falling ε (multigridding) each refinement starts from the links of the previous one, and
 * each solve from the previous B. After a stage, a function of the caller writes the state to a
 * file or to another place. It can be read in another process. Refining and solving from there
 * gives the same bits as a run without interruption.
 *
 * The format is the same on all machines. It begins with a line that names it, and ends with a
 * hash of all bytes. Integers and doubles have the least significant byte first. The state has
 * 4 bytes for each division of an element, 16 for each link, and 16 for each coefficient of B.
 * @{
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
 * @param ctx    the `ctx` of hr2d_state_write()
 * @param bytes  valid during the call only
 * @param size   number of bytes
 * @return HR2D_OK to continue; any other value ends the call with this status
 */
typedef hr2d_status (*hr2d_write_fn)(void *ctx, const void *bytes, size_t size);

/**
 * Provides the next bytes of a state.
 * @param ctx    the `ctx` of hr2d_state_read()
 * @param bytes  receives exactly `size` bytes
 * @param size   number of bytes
 * @return HR2D_OK; HR2D_ESYNTAX if there are not enough bytes; any other value ends the call
 *         with this status
 */
typedef hr2d_status (*hr2d_read_fn)(void *ctx, void *bytes, size_t size);

/**
 * Writes a solution with its links and elements.
 * @param solution  a solution of hr2d_solve(); unchanged
 * @param write     receives up to 4096 bytes at a time
 * @param ctx       given to `write`
 * @retval HR2D_OK            success
 * @retval HR2D_EUNSUPPORTED  a solution of hr2d_solve_to(): its stages do not build on each
 *                            other; or in several bands the emissivity of a patch of given flux
 *                            depends on T
 * @retval other              the status of `write`
 *
 * Allocates nothing. Cost O(N·p·bands + L).
 */
HR2D_API hr2d_status hr2d_state_write(const hr2d_solution *solution, hr2d_write_fn write,
                                      void *ctx);

/**
 * Reads a state into an empty link set.
 *
 * From then on the set, its hierarchy and the solution are, bit for bit, as they were when the
 * state was written. hr2d_linkset_epsilon() gives the ε that was reached.
 *
 * @param links     an empty set, on a hierarchy without divisions; on failure both are
 *                  unchanged. Its oracle and policy must have the names of the written ones.
 *                  The scene must be the same, except for the names of patches
 * @param read      asked for up to 4096 bytes at a time, and for no byte after the state
 * @param ctx       given to `read`
 * @param solution  receives the solution; the caller destroys it
 * @retval HR2D_OK       success
 * @retval HR2D_ENOMEM   an allocation failed
 * @retval HR2D_EINVAL   the state belongs to another scene, oracle or policy
 * @retval HR2D_ESTATE   `links` or its hierarchy is not empty
 * @retval HR2D_ESYNTAX  this is not a state, or it is damaged
 * @retval other         the status of `read`
 *
 * hr2d_linkset_message() says more. The hash detects damage of any kind. A forged state cannot
 * cause anything worse than wrong values: all sizes and indices are checked.
 * hr2d_linkset_validate() checks the links. Memory: as for the objects themselves, and never
 * more than a small multiple of the bytes that were read.
 */
HR2D_API hr2d_status hr2d_state_read(hr2d_linkset *links, hr2d_read_fn read, void *ctx,
                                     hr2d_solution **solution);

/**
 * Writes a committed scene, for other processes that share its work, or for later use without
 * its file: patches with their names, the background, the suns, mirrors and the period, and
 * the effects that are forced. Patches are written as they were given (hr2d_scene_segment()).
 * @param scene  a committed scene; unchanged
 * @param write  receives up to 4096 bytes at a time
 * @param ctx    given to `write`
 * @retval HR2D_OK      success
 * @retval HR2D_ESTATE  the scene is not committed
 * @retval HR2D_EUNSUPPORTED  a patch of given flux has an emissivity that depends on T
 * @retval other        the status of `write`, or of hr2d_scene_set_progress()
 *
 * Allocates nothing. Some 60 bytes per patch and 8 per value of E and ρ that patches do not
 * share. The bytes are the same on all machines.
 */
HR2D_API hr2d_status hr2d_state_write_scene(const hr2d_scene *scene, hr2d_write_fn write,
                                            void *ctx);

/**
 * Reads a scene of hr2d_state_write_scene(), and commits it. Every result on it has the bits
 * of the scene that was written.
 * @param scene  an empty scene; on failure it is empty again
 * @param read   asked for up to 4096 bytes at a time, and for no byte after the scene
 * @param ctx    given to `read`
 * @retval HR2D_OK       success
 * @retval HR2D_ENOMEM   an allocation failed
 * @retval HR2D_ESTATE   the scene is committed, or has patches, a background, a sun, a mirror
 * or a period
 * @retval HR2D_ESYNTAX  this is not a scene, or it is damaged
 * @retval HR2D_ESCENE   a forged scene that hr2d_scene_add() or hr2d_scene_commit() refuses
 * @retval other         the status of `read`, or of hr2d_scene_set_progress()
 *
 * hr2d_scene_message() says more. Memory: never more than a small multiple of the bytes that
 * were read; with mirrors or a period, of these for each of hr2d_scene_images(). Cost: that of
 * hr2d_scene_commit().
 */
HR2D_API hr2d_status hr2d_state_read_scene(hr2d_scene *scene, hr2d_read_fn read, void *ctx);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
