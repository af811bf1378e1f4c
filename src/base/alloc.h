/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory through a scene's hooks; every size is checked for overflow. */
#ifndef HR2D_SRC_BASE_ALLOC_H
#define HR2D_SRC_BASE_ALLOC_H

#include <hr2d/memory.h>
#include <stddef.h>

/* Hooks that call malloc(), realloc() and free(); large blocks may have large pages. */
hr2d_allocator hr2di_alloc_default(void);

static inline int hr2di_alloc_has_hooks(const hr2d_allocator *alloc) {
  return alloc->allocate && alloc->reallocate && alloc->release;
}

/* Returns an array of `count` items of `size` bytes, or NULL if there is no memory or the size
   overflows.  `count` may be 0. */
void *hr2di_alloc(const hr2d_allocator *alloc, size_t count, size_t size);

/* As hr2di_alloc(), filled with zero bytes. */
void *hr2di_alloc_zero(const hr2d_allocator *alloc, size_t count, size_t size);

/* The rest of hr2di_alloc_reserve(). */
int hr2di_alloc_grow(const hr2d_allocator *alloc, void *array, size_t *capacity, size_t needed,
                     size_t size);

/* Makes room for `needed` items of `size` bytes in *array.  *capacity is its capacity in items,
   which grows by doubling.  Returns 0, or -1 with *array and *capacity unchanged. */
static inline int hr2di_alloc_reserve(const hr2d_allocator *alloc, void *array,
                                      size_t *capacity, size_t needed, size_t size) {
  return needed <= *capacity ? 0 : hr2di_alloc_grow(alloc, array, capacity, needed, size);
}

/* Gives an array another number of items.  Returns the array, or NULL: then it is what it was.
 */
void *hr2di_alloc_resize(const hr2d_allocator *alloc, void *block, size_t count, size_t size);

void hr2di_alloc_free(const hr2d_allocator *alloc, void *block);

#endif
