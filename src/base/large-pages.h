/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Large blocks in large pages: in small ones every 4 KiB costs a page fault, which took 40 % of
   a refinement that stores its links. */
#ifndef HR2D_SRC_BASE_LARGE_PAGES_H
#define HR2D_SRC_BASE_LARGE_PAGES_H

#include <stddef.h>

enum { HR2DI_LARGE_PAGE = 1 << 21 };

/* As malloc() and realloc(), for free().  From HR2DI_LARGE_PAGE on, large pages are asked for;
   the system may have none. */
void *hr2di_large_pages_malloc(size_t bytes);
void *hr2di_large_pages_realloc(void *block, size_t bytes);

#endif
