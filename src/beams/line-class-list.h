/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of line classes between parts of two segments, which hold their own points. */
#ifndef HR2D_SRC_BEAMS_LINE_CLASS_LIST_H
#define HR2D_SRC_BEAMS_LINE_CLASS_LIST_H

#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stdint.h>

#include "beams/line-class.h"

/* What two segments may see of each other. */
typedef enum hr2di_visibility_class {
  HR2DI_CLEAR,   /* nothing in the way */
  HR2DI_PARTIAL, /* something, but not everywhere */
  HR2DI_BLOCKED  /* nothing passes */
} hr2di_visibility_class;

/* What one segment sees of another, both having their fronts on the left. */
typedef struct hr2di_stored_line_class {
  hr2d_segment near, far;
  size_t first; /* of hr2di_line_class_list::point: those of the left chain, then the right
                   one's */
  uint32_t lefts, rights;
  unsigned ends;
} hr2di_stored_line_class;

typedef struct hr2di_line_class_list {
  hr2d_allocator alloc;
  hr2di_stored_line_class *line_class;
  size_t count, capacity;
  hr2d_point *point;
  size_t points, point_capacity;
  uint64_t max_bytes; /* it may grow to so many; 0: no limit */
} hr2di_line_class_list;

/* A call that makes a list grow returns HR2D_OK, HR2D_ENOMEM, or HR2D_EMAX_BYTES at its limit.
 */

void hr2di_line_class_list_clear(hr2di_line_class_list *list);

/* The bytes that a list holds. */
uint64_t hr2di_line_class_list_bytes(const hr2di_line_class_list *list);

/* Removes all line classes but the first `count`; all, if they were sorted. */
void hr2di_line_class_list_cut(hr2di_line_class_list *list, size_t count);

/* Line class k; its chains are lost when the list grows. */
hr2di_line_class hr2di_line_class_list_at(const hr2di_line_class_list *list, size_t k);

/* Appends a line class between two segments. */
hr2d_status hr2di_line_class_list_add(hr2di_line_class_list *list, const hr2di_line_class *s,
                                      hr2d_segment near, hr2d_segment far);

/* Appends line classes [first, last) of another list. */
hr2d_status hr2di_line_class_list_copy(hr2di_line_class_list *list,
                                       const hr2di_line_class_list *from, size_t first,
                                       size_t last);

/* Appends what is left of line classes [first, last) of another list between a part `near` of
   the segment of their near ends and a part `far` of that of their far ones.  Appends to
   `whole` the line classes of which something is left, as they are; it may be NULL, but is none
   of the other lists. */
hr2d_status hr2di_line_class_list_restrict(hr2di_line_class_list *list,
                                           const hr2di_line_class_list *from, size_t first,
                                           size_t last, hr2d_segment near, hr2d_segment far,
                                           hr2di_line_class_list *whole);

/* Looks at the last line class, number k, from its other segment. */
void hr2di_line_class_list_turn(hr2di_line_class_list *list, size_t k);

/* Puts the line classes in an order that does not depend on how they were found. */
void hr2di_line_class_list_sort(hr2di_line_class_list *list);

/* Half the measure of all lines of line classes [first, last): the exchange area. */
double hr2di_line_class_list_area(const hr2di_line_class_list *list, size_t first, size_t last);

#endif
