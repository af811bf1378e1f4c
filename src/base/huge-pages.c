/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linux takes advice for ranges of addresses.  Only pages that lie in a block as a whole are
   asked for, so that nobody else's memory is touched. */
#ifdef __linux__
#define _DEFAULT_SOURCE
#endif

#include "base/huge-pages.h"

#include <stdint.h>

#ifdef __linux__
#include <sys/mman.h>
#endif

#ifdef MADV_HUGEPAGE

#define HUGE_PAGE ((uintptr_t)1 << 21)

void hr2di_huge_pages_ask(void *block, size_t bytes) {
  if (!block || bytes < HUGE_PAGE) return;
  const uintptr_t from = (uintptr_t)block, to = from + bytes;
  const uintptr_t first = (from + HUGE_PAGE - 1) & ~(HUGE_PAGE - 1);
  const uintptr_t last = to & ~(HUGE_PAGE - 1);
  if (last > first) (void)madvise((void *)first, last - first, MADV_HUGEPAGE);
}

#else

void hr2di_huge_pages_ask(void *block, size_t bytes) {
  (void)block;
  (void)bytes;
}

#endif
