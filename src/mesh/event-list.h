/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Events as they are found: more than once, and in any order of places. */
#ifndef HR2D_SRC_MESH_EVENT_LIST_H
#define HR2D_SRC_MESH_EVENT_LIST_H

#include <hr2d/share.h>

#include "mesh/events.h"

typedef struct hr2di_event_candidate {
  hr2di_event event;
  uint32_t via; /* the vertex that is looked past, or HR2DI_NO_VERTEX */
} hr2di_event_candidate;

typedef struct hr2di_event_list {
  hr2d_allocator alloc;
  hr2di_watch *watch;
  size_t max;  /* events that differ */
  int in_part; /* what is added is the part of one share */
  hr2di_event_candidate *found;
  size_t count, capacity;
} hr2di_event_list;

/* Adds one, unless it is within rounding of an end of its patch.  HR2D_OK, HR2D_ENOMEM, the
   status of the watch, or HR2D_EMAX_ELEMENTS: there are too many, or may be if it is a part. */
hr2d_status hr2di_event_list_add(hr2di_event_list *l, const hr2di_event_candidate *c);

/* Sorts by place, and keeps one of those alike.  HR2D_OK, the status of the watch, or
   HR2D_EMAX_ELEMENTS if there are more than `max`. */
hr2d_status hr2di_event_list_settle(hr2di_event_list *l);

/* Puts in the place of those from number `from` on the ones of all shares, in their order.
   `status` is that of this share.  Where a part was too long for a list, `again` becomes 1, and
   there are none: then each share finds all by itself.  HR2D_OK, HR2D_ENOMEM,
   HR2D_EMAX_ELEMENTS or the status of a share. */
hr2d_status hr2di_event_list_collect(hr2di_event_list *l, hr2d_share *share, hr2d_status status,
                                     size_t from, int *again);

#endif
