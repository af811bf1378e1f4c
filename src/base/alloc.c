/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory through a scene's hooks; every size is checked for overflow. */
#include "base/alloc.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/large-pages.h"

static void *default_allocate(void *ctx, size_t bytes) {
  (void)ctx;
  return hr2di_large_pages_malloc(bytes);
}

static void *default_reallocate(void *ctx, void *block, size_t bytes) {
  (void)ctx;
  return hr2di_large_pages_realloc(block, bytes);
}

static void default_release(void *ctx, void *block) {
  (void)ctx;
  free(block);
}

hr2d_allocator hr2di_alloc_default(void) {
  return (hr2d_allocator){default_allocate, default_reallocate, default_release, NULL};
}

/* No object may exceed PTRDIFF_MAX: pointers into it could not be subtracted. */
static int fits(size_t count, size_t size) {
  return size == 0 || count <= PTRDIFF_MAX / size;
}

void *hr2di_alloc(const hr2d_allocator *alloc, size_t count, size_t size) {
  if (!fits(count, size)) return NULL;
  const size_t bytes = count * size;
  /* malloc(0) may return NULL, which would read as failure. */
  return alloc->allocate(alloc->ctx, bytes ? bytes : 1);
}

void *hr2di_alloc_zero(const hr2d_allocator *alloc, size_t count, size_t size) {
  void *block = hr2di_alloc(alloc, count, size);
  if (block) memset(block, 0, count * size);
  return block;
}

int hr2di_alloc_grow(const hr2d_allocator *alloc, void *array, size_t *capacity, size_t needed,
                     size_t size) {
  if (!fits(needed, size)) return -1;
  size_t grown = *capacity < 8 ? 8 : *capacity;
  while (grown < needed && fits(grown, 2 * size)) grown *= 2;
  if (grown < needed || !fits(grown, size)) grown = needed;

  /* `array` is the address of a pointer of any type: memcpy reads it without aliasing. */
  void *block;
  memcpy(&block, array, sizeof block);
  block = alloc->reallocate(alloc->ctx, block, grown * size);
  if (!block) return -1;
  memcpy(array, &block, sizeof block);
  *capacity = grown;
  return 0;
}

void *hr2di_alloc_resize(const hr2d_allocator *alloc, void *block, size_t count, size_t size) {
  if (!fits(count, size)) return NULL;
  return alloc->reallocate(alloc->ctx, block, count * size > 0 ? count * size : 1);
}

void hr2di_alloc_free(const hr2d_allocator *alloc, void *block) {
  if (block) alloc->release(alloc->ctx, block);
}
