/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file status.h
 * @brief What every fallible call returns.
 *
 * The library never aborts, exits, prints or keeps global state.  A call that
 * fails leaves its objects as they were.  A status says what kind of thing went
 * wrong; the object that was worked on keeps a sentence that says where
 * (hr2d_scene_message(), hr2d_linkset_message()).
 */
#ifndef HR2D_STATUS_H
#define HR2D_STATUS_H

#if defined HR2D_BUILDING && defined __GNUC__
#define HR2D_API __attribute__((visibility("default")))
#else
#define HR2D_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** The outcome of a call.  Success is 0; new values are only ever appended. */
typedef enum hr2d_status {
  HR2D_OK = 0,         /**< done */
  HR2D_STOPPED,        /**< a callback asked to stop; not a failure of the library */
  HR2D_ENOMEM,         /**< an allocation failed */
  HR2D_EINVAL,         /**< an argument or option has no meaning */
  HR2D_ESTATE,         /**< the object is not in the state the call needs */
  HR2D_ERANGE,         /**< beyond what a double can represent */
  HR2D_EIO,            /**< a file could not be read */
  HR2D_ESYNTAX,        /**< a file is not what it should be */
  HR2D_ESCENE,         /**< the scene is not valid */
  HR2D_EUNSUPPORTED,   /**< the scene calls for an effect this version lacks */
  HR2D_ECALLBACK,      /**< a callback failed or returned a value without meaning */
  HR2D_EMAX_ELEMENTS,  /**< the budget `max_elements` is spent */
  HR2D_EMAX_LINKS,     /**< the budget `max_links` is spent */
  HR2D_EMAX_BYTES,     /**< the budget `max_bytes` is spent */
  HR2D_ENO_SOLUTION,   /**< the radiosity equation of this scene has no solution */
  HR2D_ENOT_CONVERGED, /**< the iteration limit came before the tolerance */
  HR2D_EACCURACY       /**< the accuracy asked for was not reached; what was is returned */
} hr2d_status;

/**
 * A short English phrase for a status, without full stop.
 * @return a static string, never NULL, also for values outside the enumeration
 * Thread-safe.
 */
HR2D_API const char *hr2d_strerror(hr2d_status status);

#ifdef __cplusplus
}
#endif
#endif
