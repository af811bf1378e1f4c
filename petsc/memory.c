/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "hr2dp-impl.h"

void *hr2dpi_alloc(const hr2dp *p, size_t count, size_t size) {
  if (count == 0) count = 1;
  if (size > 0 && count > SIZE_MAX / size) return NULL;
  return p->alloc.allocate(p->alloc.ctx, count * size);
}

void *hr2dpi_alloc_zero(const hr2dp *p, size_t count, size_t size) {
  void *block = hr2dpi_alloc(p, count, size);
  if (block) memset(block, 0, count * size);
  return block;
}

void hr2dpi_free(const hr2dp *p, void *block) {
  if (block) p->alloc.release(p->alloc.ctx, block);
}
