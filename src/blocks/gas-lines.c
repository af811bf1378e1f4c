/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Of one coefficient the mean of T over offsets is a divided difference of Ki₄.  Of more, rules
   run over offsets on pieces on which T is nearly a polynomial: T has x³ ln x at the depth
   x = 0, which chords reach at a corner, and falls like e^−x. */
#include "blocks/gas-lines.h"

#include <math.h>

#include "base/bickley.h"

/* Depths up to this lie in the first piece: x³ ln x is a rounding of T there. */
#define SHALLOW  0.01
#define NO_DEPTH 1e-4 /* it is one of D as well */

/* The depths that a piece spans at most, where it begins at the least depth, and so much more
   for each unit of depth that it begins behind that: its part is less. */
#define SPAN      3.
#define SPAN_MORE 0.35

double hr2di_gas_depth(const hr2di_integrator *w, const hr2di_trapezoid *t, size_t vertex,
                       double f, double g, double length) {
  double chord = 0;
  for (size_t side = 0; side < 2; side++) {
    const double above = t->above[vertex][side];
    const double across = f * t->on[side].across[0] + g * t->on[side].across[1];
    if (above > 0) chord += above / across;
  }
  return w->absorption * (length * chord);
}

/* T e^−x/T(0) and its derivatives grow like e^√: a rule needs the root of the range of depths
   more, as measured.  What little arrives behind dark gas need not divide it.  Ends of the
   directions may be poles of both terms: it looks inside. */
double hr2di_gas_points(const hr2di_integrator *w, const hr2di_trapezoid *t) {
  static const double part[] = {0.02, 0.25, 0.5, 0.75, 0.98};
  enum { LOOKS = 5, MOST_POINTS = 32, TOO_DARK = 300 };
  double range = 0, all = 0;
  for (size_t vertex = 0; vertex < 2; vertex++) {
    double least = HUGE_VAL, most = 0;
    for (size_t k = 0; k < LOOKS; k++) {
      const double f = 1 - part[k], g = part[k];
      const double x = f * t->e[0].x + g * t->e[1].x, y = f * t->e[0].y + g * t->e[1].y;
      const double depth = hr2di_gas_depth(w, t, vertex, f, g, sqrt(x * x + y * y));
      least = fmin(least, depth);
      most = fmax(most, depth);
    }
    all = fmax(all, fmin(most - least, TOO_DARK));
    if (least < HR2DI_GAS_DARK) range = fmax(range, most - least);
  }
  return range > MOST_POINTS ? HUGE_VAL : sqrt(all);
}

/* A part of the lines of one direction: parts `from` to `to` of the way from the end where
   the gas is least deep, which is σ = start. */
typedef struct piece {
  double start, from, to;
  double depth[2]; /* there */
  size_t points;
} piece;

/* Adds a piece; `dark` ones are absorbed. */
static void add_piece(hr2di_integrator *w, const hr2di_gas_lines *l, const piece *p, int dark,
                      double *block) {
  const hr2di_rule *rule = hr2di_integrator_rule(w, p->points);
  const size_t order = w->order;
  const double part = (p->to - p->from) * l->weight;
  for (size_t q = 0; q < p->points; q++) {
    const double t = 0.5 + 0.5 * rule->at[q];
    const double sigma = p->start * (1 - 2 * (p->from + t * (p->to - p->from)));
    const double depth = p->depth[0] + t * (p->depth[1] - p->depth[0]);
    const hr2di_passage pass =
        dark ? (hr2di_passage){0, 1} : hr2di_passage_at(w->section, depth);
    const double arrives = part * rule->weight[q] * pass.arrives;
    const double lost = part * rule->weight[q] * pass.absorbed;
    double on_i[HR2D_MAX_ORDER], on_j[HR2D_MAX_ORDER];
    hr2di_basis_at(&w->basis, l->centre[0] + sigma * l->half[0], on_i);
    hr2di_basis_at(&w->basis, l->centre[1] - sigma * l->half[1], on_j);
    for (size_t m = 0; m < order; m++) w->lost[0][m] += lost * on_i[m];
    for (size_t m = 0; m < order; m++) w->lost[1][m] += lost * on_j[m];
    for (size_t k = 0; k < order && !dark; k++) {
      const double row = arrives * on_i[k];
      for (size_t m = 0; m < order; m++) block[k * order + m] += row * on_j[m];
    }
  }
  w->kernels += p->points;
}

/* The depths that a piece spans which begins at `depth`, with `least` the least of all. */
static double span_from(const hr2di_integrator *w, double depth, double least) {
  const double by_fall = SPAN + SPAN_MORE * (depth - least);
  return w->section == HR2D_SECTION_FLAT ? by_fall : fmin(by_fall, fmax(2 * depth, SHALLOW));
}

/* Points beyond the order, which products of two polynomials take: for e^−x over a span, and
   for the singularity at 0 on the ellipse around depths from `least` to `most`.  On the first
   piece x³ ln x leaves n⁻⁸/10 of SHALLOW³ with n points. */
size_t hr2di_gas_points_beyond(const hr2di_integrator *w, double least, double most) {
  enum { FIRST_POINTS = 10 };
  static const double span[] = {0.02, 0.15, 0.5, 1.2, 2};
  size_t by_span = 3;
  while (by_span < 8 && most - least > span[by_span - 3]) by_span++;
  if (w->section == HR2D_SECTION_FLAT || most < NO_DEPTH || most < 1.2 * least) return by_span;
  size_t by_zero = most < 1.5 * least ? 5 : most < 2 * least ? 6 : 8;
  if (most <= SHALLOW) by_zero = w->order < FIRST_POINTS ? FIRST_POINTS - w->order : 0;
  return by_zero > by_span ? by_zero : by_span;
}

/* Order 1. */
static void add_mean(hr2di_integrator *w, const hr2di_gas_lines *l, double *block) {
  const hr2di_passage pass = hr2di_passage_mean(w->section, l->depth[0], l->depth[1]);
  block[0] += l->weight * pass.arrives;
  w->lost[0][0] += l->weight * pass.absorbed;
  w->lost[1][0] += l->weight * pass.absorbed;
  w->kernels++;
}

/* From the end where the gas is least deep to the other one. */
void hr2di_gas_add(hr2di_integrator *w, const hr2di_gas_lines *l, double *block) {
  if (w->order == 1) {
    add_mean(w, l, block);
    return;
  }
  const int swap = l->depth[1] < l->depth[0];
  const double least = l->depth[swap], whole = l->depth[!swap] - least;
  const double start = swap ? 1 : -1;
  for (double at = 0; at < 1;) {
    const double depth = least + at * whole;
    const int dark = depth - least > HR2DI_GAS_DARK;
    const double span = span_from(w, depth, least), left = (1 - at) * whole;
    const double to = dark || left <= span ? 1 : at + span / whole;
    const double end = least + to * whole;
    const size_t points =
        dark ? w->order / 2 + 1 : w->order + hr2di_gas_points_beyond(w, depth, end);
    const piece p = {start, at, to, {depth, end}, points};
    add_piece(w, l, &p, dark, block);
    at = to;
  }
}
