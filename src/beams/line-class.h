/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A line class: what one segment sees of another past the same vertices, as a class of lines.

   Segment i runs from a to b and segment j from c to d, each with its front on the left, so
   that a line from i to j has a and d on its left, b and c on its right.  The lines of a line
   class are those that have all points of one chain on their left and all points of another on
   their right.  Each chain runs from near i to near j and bulges towards the other.  It has
   only the points that a line of the class can touch, so that the first and last points are the
   contacts of the two inner common tangents:

     left[0] → right[rights − 1]    the line that leans most to the right
     right[0] → left[lefts − 1]     the line that leans most to the left */
#ifndef HR2D_SRC_BEAMS_LINE_CLASS_H
#define HR2D_SRC_BEAMS_LINE_CLASS_H

#include <hr2d/geometry.h>
#include <stddef.h>

/* The ends of the two segments. */
typedef enum hr2di_line_class_end {
  HR2DI_LINE_CLASS_A = 1,
  HR2DI_LINE_CLASS_B = 2,
  HR2DI_LINE_CLASS_C = 4,
  HR2DI_LINE_CLASS_D = 8
} hr2di_line_class_end;

typedef struct hr2di_line_class {
  const hr2d_point *left, *right;
  size_t lefts, rights; /* at least 1 */
  unsigned ends;        /* those that end a chain: left[0] is a, the last of `left` d, … */
} hr2di_line_class;

/* The exchange area of a line class: half the measure of its lines, to some roundings of
 * itself. */
double hr2di_line_class_area(const hr2di_line_class *s);

/* Whether a chain of so many points has only ends of the segments: `first` at its start and
   `last` at its end. */
static inline int hr2di_line_class_chain_clear(size_t points, unsigned first, unsigned last) {
  return points == 1 ? (first | last) != 0 : points == 2 && first && last;
}

/* Whether the chains have no points but ends of i and j: nothing but their horizons bounds the
   view, and the line class has all lines from i to j. */
static inline int hr2di_line_class_clear(const hr2di_line_class *s) {
  return hr2di_line_class_chain_clear(s->lefts, s->ends & HR2DI_LINE_CLASS_A,
                                      s->ends & HR2DI_LINE_CLASS_D) &&
         hr2di_line_class_chain_clear(s->rights, s->ends & HR2DI_LINE_CLASS_B,
                                      s->ends & HR2DI_LINE_CLASS_C);
}

/* Moves one end of segment i or j to x, a point of that segment, and returns whether any line
   is left.  If so, `child` receives the line class of these lines.  Its points are in `room`,
   which must hold one point more than the line class has; or, if nothing changes, they are
   those of the line class itself.

   The sign for a point x that was rounded costs the roundings of x, if no end of the line class
   lies as near to the inside of the segment as that. */
int hr2di_line_class_restrict(const hr2di_line_class *s, hr2di_line_class_end end, hr2d_point x,
                              hr2d_point *room, hr2di_line_class *child);

/* The same lines, looked at from j. */
void hr2di_line_class_turn(const hr2di_line_class *s, hr2d_point *room,
                           hr2di_line_class *turned);

#endif
