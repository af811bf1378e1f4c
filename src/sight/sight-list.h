/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of sights between parts of two segments, which hold their own points. */
#ifndef HR2D_SRC_SIGHT_SIGHT_LIST_H
#define HR2D_SRC_SIGHT_SIGHT_LIST_H

#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stdint.h>

#include "sight/sight.h"

/* What two segments may see of each other. */
typedef enum hr2di_visibility_class {
  HR2DI_CLEAR,   /* nothing in the way */
  HR2DI_PARTIAL, /* something, but not everywhere */
  HR2DI_BLOCKED  /* nothing passes */
} hr2di_visibility_class;

/* What one segment sees of another, both having their fronts on the left. */
typedef struct hr2di_kept_sight {
  hr2d_segment near, far;
  size_t first; /* of hr2di_sight_list::point: those of the left chain, then the right one's */
  uint32_t lefts, rights;
  unsigned ends;
} hr2di_kept_sight;

typedef struct hr2di_sight_list {
  hr2d_allocator alloc;
  hr2di_kept_sight *sight;
  size_t count, capacity;
  hr2d_point *point;
  size_t points, point_capacity;
  uint64_t most_bytes; /* it may grow to so many; 0: no limit */
} hr2di_sight_list;

/* A call that makes a list grow returns HR2D_OK, HR2D_ENOMEM, or HR2D_EMAX_BYTES at its limit.
 */

void hr2di_sight_list_clear(hr2di_sight_list *list);

/* The bytes that a list holds. */
uint64_t hr2di_sight_list_bytes(const hr2di_sight_list *list);

/* Removes all sights but the first `count`; all, if they were sorted. */
void hr2di_sight_list_cut(hr2di_sight_list *list, size_t count);

/* Sight k; its chains are lost when the list grows. */
hr2di_sight hr2di_sight_list_at(const hr2di_sight_list *list, size_t k);

/* Appends a sight between two segments. */
hr2d_status hr2di_sight_list_add(hr2di_sight_list *list, const hr2di_sight *s,
                                 hr2d_segment near, hr2d_segment far);

/* Appends sights [first, last) of another list. */
hr2d_status hr2di_sight_list_copy(hr2di_sight_list *list, const hr2di_sight_list *from,
                                  size_t first, size_t last);

/* Appends what is left of sights [first, last) of another list between a part `near` of the
   segment of their near ends and a part `far` of that of their far ones.  Appends to `whole`
   the sights of which something is left, as they are; it may be NULL, but is none of the other
   lists. */
hr2d_status hr2di_sight_list_restrict(hr2di_sight_list *list, const hr2di_sight_list *from,
                                      size_t first, size_t last, hr2d_segment near,
                                      hr2d_segment far, hr2di_sight_list *whole);

/* Looks at the last sight, number k, from its other segment. */
void hr2di_sight_list_turn(hr2di_sight_list *list, size_t k);

/* Puts the sights in an order that does not depend on how they were found. */
void hr2di_sight_list_sort(hr2di_sight_list *list);

/* Half the measure of all lines of sights [first, last): the exchange area. */
double hr2di_sight_list_area(const hr2di_sight_list *list, size_t first, size_t last);

#endif
