/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines between two elements, by direction.

   G dy dx = ½ dp dθ, where p is the offset of a line and θ its direction.  In a direction e the
   visible lines lie between two vertices, and the places s on i and t on j where they meet the
   elements are affine in p.  Where vertices change is an event.  Between two events the lines
   make a trapezoid. */
#ifndef HR2D_SRC_BLOCKS_LINES_H
#define HR2D_SRC_BLOCKS_LINES_H

#include <hr2d/oracle.h>

#include "geometry/determinant.h"
#include "geometry/orient-incident.h"
#include "hierarchy/hierarchy-impl.h"

/* A pair i = ab, j = cd, with u = b − a and v = d − c as parts of the vectors of their patches,
   which have more digits than coordinates of small elements.  Vectors lead from the corner of
   patches that have a common end, with the relative accuracy of fractions of the patches; else
   from a common end of the elements, or from that end of the patch of i that is nearer to i. */
typedef struct hr2di_line_frame {
  hr2d_segment i, j;
  hr2d_point origin;
  hr2di_vector a, b, c, d, u, v;
  int has_gas; /* trapezoids get `above`; not set at first */
} hr2di_line_frame;

void hr2di_line_frame_init(hr2di_line_frame *frame, const hr2d_hierarchy *hierarchy,
                           hr2d_pair pair);

/* A point that bounds lines.  On the line of i it is at a + s u, on that of j at c + t v. */
typedef struct hr2di_vertex {
  hr2di_vector at; /* from the origin of the frame */
  unsigned on;     /* HR2DI_ON_…: the lines on which it lies */
  double s, t;
} hr2di_vertex;

hr2di_vertex hr2di_line_vertex(const hr2di_line_frame *frame, hr2di_incident_point point);

/* The ends b and c that all clear lines have on their right, and a and d on their left, each
   clipped at the other's horizon.  Returns 0 if no line is left. */
int hr2di_line_ends(const hr2di_line_frame *frame, hr2di_vertex right[2], hr2di_vertex left[2]);

/* Where the lines of a trapezoid meet an element.  The outermost ones meet it at start/across
   and (start + gap)/across, as fractions of the element, of which `fixed` ones do not depend on
   e. */
typedef struct hr2di_meeting {
  double across[2]; /* u × e, or e × v */
  double start[2];
  unsigned fixed;  /* 1: the place at the start; 2: that at the end */
  double place[2]; /* these places */
} hr2di_meeting;

/* The lines between two directions that have the vertex `low` on their left and `high` on their
   right.  Each pair of numbers is linear in e, so that it is known in between.  None is
   negative. */
typedef struct hr2di_trapezoid {
  hr2di_vector e[2];
  double turn;         /* e[0] × e[1] */
  double gap[2];       /* (high − low) × e */
  hr2di_meeting on[2]; /* on i, from low to high, and on j, from high to low */
  double area;         /* half the measure of the lines, rounded */
  double above[2][2]; /* with gas: u × (z − a) and v × (z − c), of z = low and of high, */
  const hr2di_vertex *bound[2]; /* which are these */
} hr2di_trapezoid;

/* Sets how far a vertex is in front of the lines of i and of j, but for |u| and |v|; negative
   behind them. */
void hr2di_line_above(const hr2di_line_frame *frame, const hr2di_vertex *z, double above[2]);

/* The number of trapezoids of these chains is at most that of their vertices. */
size_t hr2di_line_trapezoids(const hr2di_line_frame *frame, const hr2di_vertex *right,
                             size_t rights, const hr2di_vertex *left, size_t lefts,
                             hr2di_trapezoid *trapezoid);

/* Divides at the direction weight[0] e[0] + weight[1] e[1]; both weights are positive. */
void hr2di_trapezoid_divide(const hr2di_trapezoid *whole, const double weight[2],
                            hr2di_trapezoid part[2]);

#endif
