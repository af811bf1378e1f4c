/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moments over the lines of one direction through several gases.

   Rules run over pieces of the offsets on which D of no depth between two borders is farther
   from a polynomial than D of one gas is on a piece of gas-lines.c: on each piece the depths of
   all gases that are not dark change by no more than SPAN together, and none that may become 0
   by more than to three times its least. */
#include <math.h>

#include "base/alloc.h"
#include "base/bickley.h"
#include "blocks/gas-cells.h"

#define SPAN      3.
#define SPAN_MORE 0.35
#define SHALLOW   0.01

/* The depth of a piece at a part of the way from low to high. */
static double piece_at(const hr2di_gas_cells *c, size_t piece, double at) {
  double end[2];
  for (size_t v = 0; v < 2; v++)
    end[v] = c->depth[v][piece] - (piece ? c->depth[v][piece - 1] : 0);
  return end[0] + at * (end[1] - end[0]);
}

/* How far a depth may change that begins at y and grows, or falls. */
static double change_from(hr2d_section section, double y, int grows) {
  if (grows) {
    const double by_fall = SPAN + SPAN_MORE * y;
    return section == HR2D_SECTION_FLAT ? by_fall : fmin(by_fall, fmax(2 * y, SHALLOW));
  }
  if (y > 2 * HR2DI_GAS_DARK) return y - HR2DI_GAS_DARK;
  const double by_fall = (y - SPAN) / (1 + SPAN_MORE);
  const double by_zero = section == HR2D_SECTION_FLAT || y <= SHALLOW ? 0 : y / 3;
  return y - fmax(by_fall, by_zero);
}

/* The end of a piece of the offsets that begins at `from`. */
static double end_of_piece(const hr2di_gas_cells *c, hr2d_section section, double from) {
  enum { MOST_PIECES = 4096 };
  double part = 1 - from, sum = 0;
  for (size_t k = 0; k < c->path.pieces; k++) {
    const double y = piece_at(c, k, from), slope = piece_at(c, k, 1) - piece_at(c, k, 0);
    if (slope == 0 || (slope > 0 && y > HR2DI_GAS_DARK)) continue;
    part = fmin(part, change_from(section, y, slope > 0) / fabs(slope));
    if (y < HR2DI_GAS_DARK) sum += fabs(slope);
  }
  if (sum > 0) part = fmin(part, 2 * SPAN / sum);
  return from + fmax(part, 1. / MOST_PIECES) >= 1 ? 1 : from + fmax(part, 1. / MOST_PIECES);
}

/* The largest number of points beyond the order that the depth of a gas asks for. */
static size_t points_on(const hr2di_integrator *w, double from, double to) {
  const hr2di_gas_cells *c = w->cells;
  size_t most = 3;
  for (size_t k = 0; k < c->path.pieces; k++) {
    const double y[] = {piece_at(c, k, from), piece_at(c, k, to)};
    const double least = fmin(y[0], y[1]);
    if (least > HR2DI_GAS_DARK) continue;
    const size_t points = hr2di_gas_points_beyond(w, least, fmax(y[0], y[1]));
    if (points > most) most = points;
  }
  return w->order + most + 1;
}

static double *absorbed_at(hr2di_gas_cells *c, size_t from, size_t to) {
  return &c->absorbed[from * (c->path.pieces + 1) + to];
}

/* D between all borders of a line. */
static void set_absorbed(hr2di_integrator *w, double at) {
  hr2di_gas_cells *c = w->cells;
  const size_t n = c->path.pieces;
  for (size_t k = 0; k <= n; k++) {
    double depth = 0;
    *absorbed_at(c, k, k) = 0;
    for (size_t l = k; l < n; l++) {
      depth += piece_at(c, l, at);
      *absorbed_at(c, k, l + 1) = hr2di_passage_at(w->section, depth).absorbed;
    }
  }
  w->kernels += n * (n + 1) / 2;
}

static void add_moments(const double *phi, size_t order, double value, double *sum) {
  for (size_t m = 0; m < order; m++) sum[m] += value * phi[m];
}

/* What the gas of a piece takes of the light of both elements, and exchanges with others. */
static void add_piece(hr2di_gas_cells *c, size_t k, double weight, const double *on_i,
                      const double *on_j) {
  const size_t n = c->path.pieces, gas = c->path.gas[k];
  double *of_i = c->share + gas * c->order, *of_j = of_i + c->gases * c->order;
  double *between = c->share + 2 * c->gases * c->order;
  const double from_i = *absorbed_at(c, 0, k + 1) - *absorbed_at(c, 0, k);
  const double from_j = *absorbed_at(c, k, n) - *absorbed_at(c, k + 1, n);
  add_moments(on_i, c->order, weight * from_i, of_i);
  add_moments(on_j, c->order, weight * from_j, of_j);
  for (size_t l = k + 1; l < n; l++) {
    const size_t other = c->path.gas[l];
    if (other == gas || other == HR2DI_NO_GAS) continue;
    const double both = (*absorbed_at(c, k + 1, l + 1) - *absorbed_at(c, k + 1, l)) -
                        (*absorbed_at(c, k, l + 1) - *absorbed_at(c, k, l));
    const size_t high = gas > other ? gas : other, low = gas > other ? other : gas;
    between[high * (high - 1) / 2 + low] += weight * both;
  }
}

static void add_line(hr2di_integrator *w, const hr2di_gas_lines *lines, double at,
                     double weight, double *block) {
  hr2di_gas_cells *c = w->cells;
  const size_t order = w->order, n = c->path.pieces;
  double on_i[HR2D_MAX_ORDER], on_j[HR2D_MAX_ORDER];
  const double sigma = 2 * at - 1;
  hr2di_basis_at(&w->basis, lines->centre[0] + sigma * lines->half[0], on_i);
  hr2di_basis_at(&w->basis, lines->centre[1] - sigma * lines->half[1], on_j);
  set_absorbed(w, at);
  double depth = 0;
  for (size_t k = 0; k < n; k++) depth += piece_at(c, k, at);
  const hr2di_passage pass = hr2di_passage_at(w->section, depth);
  add_moments(on_i, order, weight * pass.absorbed, w->lost[0]);
  add_moments(on_j, order, weight * pass.absorbed, w->lost[1]);
  for (size_t k = 0; k < order; k++)
    add_moments(on_j, order, weight * pass.arrives * on_i[k], block + k * order);
  for (size_t k = 0; k < n; k++)
    if (c->path.gas[k] != HR2DI_NO_GAS) add_piece(c, k, weight, on_i, on_j);
}

void hr2di_gas_cells_add(hr2di_integrator *w, const hr2di_gas_lines *lines, double *block) {
  hr2di_gas_cells *c = w->cells;
  for (double from = 0; from < 1;) {
    const double to = end_of_piece(c, w->section, from);
    const hr2di_rule *rule = hr2di_integrator_rule(w, points_on(w, from, to));
    for (size_t q = 0; q < rule->points; q++)
      add_line(w, lines, from + (to - from) * (0.5 + 0.5 * rule->at[q]),
               (to - from) * rule->weight[q] * lines->weight, block);
    from = to;
  }
}
