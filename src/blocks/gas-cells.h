/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines through several gases.

   Where no border meets the hull of a pair, one gas is between its elements.  Elsewhere the
   lines of a trapezoid are divided along those through knots into cells, within which all lines
   cross the same borders one after the other: there the depth to each of them is linear in the
   offset and smooth in the direction, as that of one gas is.

   On a line with depths x_0 = 0 … x_n at the ends of its pieces, with D = 1 − T, gas of piece k
   takes D(x_k) − D(x_{k−1}) of what leaves i, and the gases of pieces k < l exchange the second
   difference
     D(x_{l−1} − x_k) − D(x_{l−1} − x_{k−1}) − D(x_l − x_k) + D(x_l − x_{k−1}), less 0.
   All are differences of D, which is known to its own digits. */
#ifndef HR2D_SRC_BLOCKS_GAS_CELLS_H
#define HR2D_SRC_BLOCKS_GAS_CELLS_H

#include "blocks/gas-lines.h"
#include "scene/regions.h"

/* A trapezoid that is not divided yet at the knots from `next` on. */
typedef struct hr2di_undivided {
  hr2di_trapezoid t;
  size_t next;
} hr2di_undivided;

typedef struct hr2di_gas_cells {
  const hr2di_regions *regions;
  hr2d_allocator alloc;
  size_t gases, order;
  double *absorption; /* κ of each gas per unit of the scene */
  int is_mixed;       /* borders are between the elements of the pair under way; */
  size_t gas;         /* else the gas that is, or HR2DI_NO_GAS */
  const hr2di_line_frame *frame;
  hr2d_point *knot; /* of the pair, */
  size_t knots, knot_capacity;
  hr2di_vertex *vertex; /* as the frame has them */
  size_t vertex_capacity;
  hr2di_undivided *waiting;
  size_t waiting_capacity;
  hr2di_gas_path path; /* of the lines of the cell under way; of the borders it crosses: */
  hr2d_point *along;   /* from end to end, */
  double *side[2];     /* and (their first end − z) × along, of z = low and of high */
  double *depth[2];    /* x_1 … x_n of a line, at low and at high */
  double *range[2];    /* of the depth of each piece over the directions */
  double *absorbed;    /* D of the depth from the start of piece k to the end of piece l */
  size_t absorbed_capacity;
  double *share; /* what gases take of the last pair, hr2di_gas_cells_shares() numbers: of each
                    gas `order` for i; the same for j; then between gases k < l at the place
                    l (l − 1)/2 + k */
} hr2di_gas_cells;

/* The numbers of all shares of a pair. */
static inline size_t hr2di_gas_cells_shares(size_t gases, size_t order) {
  return 2 * gases * order + gases * (gases - 1) / 2;
}

/* Makes room for the cells of a scene with regions.  HR2D_OK or HR2D_ENOMEM; call
   hr2di_gas_cells_clear() in any case. */
hr2d_status hr2di_gas_cells_init(hr2di_gas_cells *cells, const hr2d_scene *scene,
                                 const hr2d_allocator *alloc, size_t order);
void hr2di_gas_cells_clear(hr2di_gas_cells *cells);

/* Forgets the pair before, and its shares. */
void hr2di_gas_cells_forget(hr2di_gas_cells *cells);

/* Finds out which borders are between the elements of a pair, or which gas.  HR2D_OK,
 * HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_gas_cells_begin(hr2di_gas_cells *cells, hr2d_segment i, hr2d_segment j,
                                  hr2di_watch *watch);

/* Sets the frame of a mixed pair, which must stay.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_gas_cells_frame(hr2di_gas_cells *cells, const hr2di_line_frame *frame);

/* Gives what a pair in one gas has lost to that gas. */
void hr2di_gas_cells_take(hr2di_gas_cells *cells, double lost[2][HR2D_MAX_ORDER]);

/* Exchanges the shares of i and of j. */
void hr2di_gas_cells_swap(hr2di_gas_cells *cells);

/* Divides a trapezoid of a mixed pair; `add` is called with each cell, whose path is set.
   Returns the first status but HR2D_OK, or HR2D_ENOMEM. */
typedef hr2d_status (*hr2di_add_cell)(hr2di_integrator *work, const hr2di_trapezoid *cell,
                                      double area, double *block);
hr2d_status hr2di_gas_cells_divide(hr2di_integrator *work, const hr2di_trapezoid *whole,
                                   hr2di_add_cell add, double area, double *block);

/* The same as hr2di_gas_depth(), hr2di_gas_points() and hr2di_gas_add() for a cell.  The first
   sets the depths of a vertex, which the last one takes. */
void hr2di_gas_cells_depths(hr2di_gas_cells *cells, const hr2di_trapezoid *t, size_t vertex,
                            double f, double g, double length);
double hr2di_gas_cells_points(hr2di_gas_cells *cells, const hr2di_trapezoid *t);
void hr2di_gas_cells_add(hr2di_integrator *work, const hr2di_gas_lines *lines, double *block);

#endif
