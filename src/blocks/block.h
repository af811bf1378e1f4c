/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks: C_lm = ∫∫ G V φ_l(x) φ_m(y) dy dx over a pair of elements, a length; C_00 is their
   exchange area.  With gas G has the factor T(κr), see base/bickley.h.  Blocks of distant pairs
   are as accurate as the order needs, but for C_00; all others are exact to rounding, of
   doubles or of floats. */
#ifndef HR2D_SRC_BLOCKS_BLOCK_H
#define HR2D_SRC_BLOCKS_BLOCK_H

#include <hr2d/gas.h>
#include <hr2d/oracle.h>

#include "base/legendre.h"
#include "base/watch.h"
#include "blocks/lines.h"
#include "blocks/moments.h"
#include "visibility/pair-visibility.h"

/* A distant pair i = ab, j = cd, seen from x = a + s(b−a) and y = c + t(d−c). */
typedef struct hr2di_pair_frame {
  hr2d_point along_i, along_j; /* b − a, d − c */
  hr2d_point separation;       /* c − a */
  double length_i, length_j;
  double above_i[2]; /* how far c and d are in front of the line of i */
  double above_j[2]; /* how far a and b are in front of the line of j */
  double area;       /* exchange area */
} hr2di_pair_frame;

/* −ln of the error as a part of C_00, for doubles and for floats, of which it is 1/200 of a
   rounding. */
#define HR2DI_DOUBLE_DIGITS 34
#define HR2DI_SINGLE_DIGITS 22

/* Points that e^−κr takes more at most on distant elements: on the ellipse of 1.8 it grows by
   e^(0.75 κA), for which half a point per depth is enough. */
enum { HR2DI_GAS_POINTS = 2 };

/* Work space of one thread. */
typedef struct hr2di_integrator {
  const hr2d_hierarchy *hierarchy;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  size_t order;
  double digits; /* as above: of what is not distant */
  hr2di_basis basis;
  size_t points; /* of a rule for distant pairs, for each element, at most */
  double *phi;   /* φ_0 … at the points of rules of up to so many, one behind the other */
  double separation[HR2DI_RULE_POINTS]; /* the ellipse at which n points are enough, at n − 1 */
  hr2di_rule *rule;                     /* of n points at n − 1, once it is made */
  unsigned char made[HR2DI_RULE_POINTS], tabled[HR2DI_RULE_POINTS];
  hr2di_moments moments;
  hr2di_pair_visibility *visibility; /* NULL if the scene needs no occlusion */
  hr2di_line_class_list seen;        /* of the pair under way */
  hr2di_vertex *vertex;
  size_t vertex_capacity;
  hr2di_trapezoid *trapezoid;
  size_t trapezoid_capacity;
  uint64_t kernels; /* values of G, or of its integral over the lines of one direction */
  int has_gas;
  struct hr2di_gas_cells *cells; /* NULL: one gas is everywhere */
  double absorption; /* κ of the gas per unit of the scene; 0: there is none between a pair */
  hr2d_section section;
  double lost[2][HR2D_MAX_ORDER]; /* with gas, of the last pair: ∫∫ G V D φ_l(x) dy dx for the
                                     part D of the light that is absorbed, on i and on j */
} hr2di_integrator;

/* What patches see is kept in `beam_cache`, unless that is NULL.  Returns HR2D_OK or
   HR2D_ENOMEM. Call hr2di_integrator_clear() in either case. */
hr2d_status hr2di_integrator_init(hr2di_integrator *work, const hr2d_hierarchy *hierarchy,
                                  const hr2d_allocator *alloc, size_t order,
                                  hr2di_beam_cache *beam_cache, hr2di_watch *watch);

/* Takes so many points for each element of a distant pair, in the place of two more than the
   order.  With `fewer` that is where a pair is as near as it may be; others take as many as
   give the same error, which is no longer less the smaller the elements are.  HR2D_OK or
   HR2D_ENOMEM.
 */
hr2d_status hr2di_integrator_points(hr2di_integrator *work, size_t points, int fewer);
void hr2di_integrator_clear(hr2di_integrator *work);

/* Integrates the block of a pair: order × order numbers, row l for the first element.  `area`
   is the exchange area of its link: if walls change no bit of that, they count as none.
   `distant` receives 1 if one tensor rule was enough, else 0.  Returns HR2D_OK, HR2D_ENOMEM or
   the status of the watch. */
hr2d_status hr2di_block(hr2di_integrator *work, hr2d_pair pair, double area, double *block,
                        int *distant);

/* Sets up the frame of a pair, which has more digits than coordinates. */
void hr2di_pair_frame_init(hr2di_pair_frame *frame, const hr2d_hierarchy *hierarchy,
                           hr2d_pair pair);

/* Sets the block of a distant pair, which is 0 so far; `m` are the ellipses about i and j on
   which the other one is. */
void hr2di_block_distant(hr2di_integrator *work, const hr2di_pair_frame *f, const double m[2],
                         double *block);

/* The rule of n points. */
const hr2di_rule *hr2di_integrator_rule(hr2di_integrator *work, size_t points);

/* Adds the lines of one class to a block: those that have the vertices of the right chain on
   their right and those of the left chain on their left.  There are `rights` and then `lefts`
   of them, in the order from i to j.  The first line leads from the first vertex of the left
   chain to the last of the right one, the last line from the first of the right to the last of
   the left.  Returns HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_block_of_vertices(hr2di_integrator *work, const hr2di_line_frame *frame,
                                    const hr2di_vertex *vertex, size_t rights, size_t lefts,
                                    double *block);

/* Adds the lines of trapezoids, which may wait in work->moments. */
hr2d_status hr2di_block_add_lines(hr2di_integrator *work, const hr2di_trapezoid *trapezoid,
                                  size_t count, double *block);

static inline hr2d_point hr2di_block_along(hr2d_point from, hr2d_point direction, double part) {
  return (hr2d_point){from.x + part * direction.x, from.y + part * direction.y};
}

static inline double hr2di_block_mix(const double end[2], double part) {
  return end[0] + part * (end[1] - end[0]);
}

#endif
