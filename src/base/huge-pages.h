/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Large arrays in few pages: the system takes longer to hand out a page than a beam takes to
   cross a room. */
#ifndef HR2D_SRC_BASE_HUGE_PAGES_H
#define HR2D_SRC_BASE_HUGE_PAGES_H

#include <stddef.h>

/* Asks the system for huge pages where a block of malloc(), or NULL, is large enough.  It may
   refuse. */
void hr2di_huge_pages_ask(void *block, size_t bytes);

#endif
