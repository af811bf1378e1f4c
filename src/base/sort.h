/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sorts arrays of any length, with a watch. */
#ifndef HR2D_SRC_BASE_SORT_H
#define HR2D_SRC_BASE_SORT_H

#include "base/watch.h"

enum { HR2DI_SORT_BYTES = 128 };

/* Sorts as qsort() does, items of at most HR2DI_SORT_BYTES.  `compare` returns 0 for no two
   items, or for items that are the same in every bit, so that the result does not depend on the
   method.  Returns HR2D_OK; or the status of the watch, with the items in some order. */
hr2d_status hr2di_sort(void *items, size_t count, size_t size,
                       int (*compare)(const void *, const void *), hr2di_watch *watch);

#endif
