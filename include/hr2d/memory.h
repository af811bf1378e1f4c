/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file memory.h
 * @brief Allocator hooks.
 *
 * @defgroup memory Memory
 * The allocator hooks of a scene and of every object made from it.
 *
 * Three kinds of memory do not come from the hooks:
 * - jansson's, while a GeoJSON file is parsed. These allocations may fail as well.
 * - The system's, for the threads of a call that asks for more than one. If it has none for a
 *   thread, the call goes on with fewer threads.
 * - The work space of hr2d_study_fit_rows(), from malloc().
 * @{
 */
#ifndef HR2D_MEMORY_H
#define HR2D_MEMORY_H

#include <stddef.h>

/**
 * Allocator hooks. Without any, blocks come from malloc(); on Linux those of 2 MiB and more are
 * asked to be in large pages. hr2d_scene_create() copies them, and every object made from the
 * scene inherits them.
 *
 * The functions behave like malloc(), realloc() and free(), and the first two may fail. They
 * must be callable from every thread that uses such an object, and from the threads of a call
 * that asks for several.
 */
typedef struct hr2d_allocator {
  void *(*allocate)(void *ctx, size_t bytes);                /**< required */
  void *(*reallocate)(void *ctx, void *block, size_t bytes); /**< required */
  void (*release)(void *ctx, void *block);                   /**< required; accepts NULL */
  void *ctx;                                                 /**< passed to each function */
} hr2d_allocator;

/** @} */
#endif
