/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file status.h
 * @brief The status that a call returns.
 *
 * @defgroup status Status
 * Every call that can fail returns an hr2d_status.
 *
 * The status gives the kind of the error. The object of the call keeps a sentence with the
 * place and the reason: hr2d_scene_message(), hr2d_linkset_message().
 *
 * A call that fails leaves its objects unchanged. The library never aborts, exits or prints,
 * and it has no global state.
 *
 * **Wrong arguments.** Where an object, an array or a function that a call needs is NULL, an
 * index is of nothing, or a `struct_size` is too small, the call returns HR2D_EINVAL. A call
 * without a status returns NaN for a number, NULL for a pointer, 0 for a count or a flag, and
 * #HR2D_NO_ELEMENT for an element. Pointers that are not NULL must point to objects of their
 * type: this and the lengths of arrays are not checked.
 *
 * **Texts** are UTF-8 without a zero byte. hr2d_scene_add() and the readers of files and states
 * refuse a name that is not. Names may hold control characters; in messages these, and those
 * that turn the direction of a text, are question marks. A message has at most 511 bytes, and
 * is cut at a whole character.
 * @{
 */
#ifndef HR2D_STATUS_H
#define HR2D_STATUS_H

/** Marks an exported function. */
#if defined HR2D_BUILDING && defined __GNUC__
#define HR2D_API __attribute__((visibility("default")))
#else
#define HR2D_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** The outcome of a call. Success is 0. New values are only added at the end. */
typedef enum hr2d_status {
  HR2D_OK = 0,         /**< success */
  HR2D_STOPPED,        /**< a callback asked to stop; this is no failure of the library */
  HR2D_ENOMEM,         /**< an allocation failed */
  HR2D_EINVAL,         /**< an argument or option is not valid */
  HR2D_ESTATE,         /**< the object is not in the state that the call needs */
  HR2D_ERANGE,         /**< doubles cannot represent a value */
  HR2D_EIO,            /**< a file could not be read */
  HR2D_ESYNTAX,        /**< a file does not have the expected format */
  HR2D_ESCENE,         /**< the scene is not valid */
  HR2D_EUNSUPPORTED,   /**< this version does not support an effect or an object */
  HR2D_ECALLBACK,      /**< a callback failed or returned an invalid value */
  HR2D_EMAX_ELEMENTS,  /**< the budget `max_elements` is exhausted */
  HR2D_EMAX_LINKS,     /**< the budget `max_links` is exhausted */
  HR2D_EMAX_BYTES,     /**< the budget `max_bytes` is exhausted */
  HR2D_ENO_SOLUTION,   /**< the radiosity equation of this scene has no solution */
  HR2D_ENOT_CONVERGED, /**< the iteration ended before it reached the tolerance */
  HR2D_EACCURACY       /**< the target error was not reached; the best result is returned */
} hr2d_status;

/**
 * Describes a status by a short English phrase without a full stop.
 * @param status  any value, also outside of the enumeration
 * @return a static string, never NULL
 *
 * Thread-safe.
 */
HR2D_API const char *hr2d_strerror(hr2d_status status);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
