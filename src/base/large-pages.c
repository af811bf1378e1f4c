/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linux takes advice for ranges of addresses.  Only pages that lie within a block are asked
   for, so that not a byte more is used, and nobody else's memory is touched. */
#ifdef HR2D_MADVISE
#define _DEFAULT_SOURCE /* madvise() */
#endif

#include "base/large-pages.h"

#include <stdint.h>
#include <stdlib.h>

#ifdef HR2D_MADVISE
#include <sys/mman.h>

static void advise(void *block, size_t bytes) {
  const uintptr_t rest = HR2DI_LARGE_PAGE - 1, first = (uintptr_t)block;
  const uintptr_t from = (first + rest) & ~rest, to = (first + bytes) & ~rest;
  if (block && from < to) (void)madvise((void *)from, to - from, MADV_HUGEPAGE);
}

void *hr2di_large_pages_malloc(size_t bytes) {
  void *block;
  if (bytes < HR2DI_LARGE_PAGE) return malloc(bytes);
  if (posix_memalign(&block, HR2DI_LARGE_PAGE, bytes)) return NULL;
  advise(block, bytes);
  return block;
}

void *hr2di_large_pages_realloc(void *block, size_t bytes) {
  void *moved = realloc(block, bytes);
  advise(moved, bytes);
  return moved;
}
#else
void *hr2di_large_pages_malloc(size_t bytes) {
  return malloc(bytes);
}

void *hr2di_large_pages_realloc(void *block, size_t bytes) {
  return realloc(block, bytes);
}
#endif
