/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file progress.h
 * @brief The callback that long calls ask whether to go on.
 *
 * @defgroup progress Progress and stops
 * The callback that long calls ask whether to go on.
 *
 * Every call that can take longer than some milliseconds asks a callback, so that a program can
 * show how far it is, and can end it at any time. The options of a call have a member
 * `progress`. All other calls, and calls whose `progress` is NULL, ask the callback of their
 * scene: hr2d_scene_set_progress().
 *
 * A call passes its phase, and the part of the phase that is done:
 * - "read": a scene file is read; part of its bytes
 * - "split": crossings are cut; 0
 * - "commit": patches are checked, walls and effects found; part of the steps
 * - "refine": pairs are subdivided and linked; part of the root pairs
 * - "law": constants of the law of N and L are integrated; part of the patches
 * - "coefficients": blocks of links are integrated, at an order above 1; part of the links
 * - "rows": row sums and form factors of the background are integrated; 0
 * - "solve": the equation is iterated; part of the digits to gain
 * - "gather": light is gathered at points; part of the points
 * - "field": light is gathered between the patches; part of the points
 * - "factors": exchange areas of all patches are integrated; part of them
 * - "validate": links are checked; part of the links
 * - "state": a state is read or written; 0
 * @{
 */
#ifndef HR2D_PROGRESS_H
#define HR2D_PROGRESS_H

#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The progress of a long call. */
typedef struct hr2d_progress {
  size_t struct_size; /**< sizeof (hr2d_progress) of the library */
  const char *phase;  /**< see the list above */
  uint64_t elements;  /**< N so far */
  uint64_t links;     /**< L so far */
  double fraction;    /**< part of the phase that is done, in [0,1] */
  double residual;    /**< relative residual during a solve, otherwise 0 */
} hr2d_progress;

/**
 * Receives the progress of a call.
 *
 * It is called from the thread of the caller, about once per millisecond of work. The library
 * looks at no clock: it counts work. So the number of calls does not depend on the machine or
 * its load as long as one thread works. Calls that end within a millisecond may not ask at all.
 * A callback should return within microseconds.
 *
 * This holds for every callback:
 * - It may call the library on other objects, and read the objects of the running call.
 * - A call that would change these objects returns HR2D_ESTATE. Such calls are a refinement or
 *   another order of their hierarchy, and a solve of links that are being refined or solved.
 * - It must not destroy these objects, and must not leave by longjmp() or an exception.
 *
 * @param ctx       the `progress_ctx` of the options
 * @param progress  valid during the call only
 * @return HR2D_OK to continue. Any other value stops the call. It is returned as it is, even if
 *         it is not a member of hr2d_status, and the objects are unchanged.
 */
typedef hr2d_status (*hr2d_progress_fn)(void *ctx, const hr2d_progress *progress);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
