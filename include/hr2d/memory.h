/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file memory.h
 * @brief Where a scene, and all that is made from it, gets its memory.
 */
#ifndef HR2D_MEMORY_H
#define HR2D_MEMORY_H

#include <stddef.h>

/**
 * Allocator hooks, given to hr2d_scene_create() and inherited by every object
 * made from that scene.  Each function behaves as its C namesake and may fail.
 * The hooks must be callable from every thread that uses such an object.
 * What jansson allocates while a file is parsed does not come through here; it may fail as
 * well.  Nor does what OpenMP takes where more than one thread is asked for: its runtime ends
 * the program if it cannot have it.  With one thread it takes nothing, but for clang's when
 * it starts.
 */
typedef struct hr2d_allocator {
  void *(*allocate)(void *ctx, size_t bytes);                /**< required */
  void *(*reallocate)(void *ctx, void *block, size_t bytes); /**< required */
  void (*release)(void *ctx, void *block);                   /**< required; NULL is no-op */
  void *ctx;                                                 /**< passed through */
} hr2d_allocator;

#endif
