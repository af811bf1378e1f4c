/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's approximation of the L¹ error (section 4): G is sampled at 1024
   midpoints on each patch.

   An element on level k has 1024/2^k samples, one per cell.  On level 10 it has a single cell,
   and its centre is the sample.  An element smaller than a cell has its centre as sample, too,
   since G is constant on a cell of the grid.  A pair of such elements has no error, so patches
   of the same length are never subdivided below level 10. */
#include "oracle/l1-grid.h"

#include <math.h>

enum { SAMPLES = 1024, LEVELS = 10 };

/* The samples of an element: their places relative to some origin, and their distances in front
   of the other element. */
typedef struct samples {
  int count;
  double x[SAMPLES], y[SAMPLES], before[SAMPLES];
} samples;

static int samples_of(const hr2d_batch *batch, uint32_t element) {
  const unsigned level = hr2d_element_level(batch->hierarchy, element);
  return level < LEVELS ? SAMPLES >> level : 1;
}

uint64_t hr2di_l1_grid_samples(const hr2d_batch *batch, hr2d_pair pair) {
  return (uint64_t)samples_of(batch, pair.first) * (uint64_t)samples_of(batch, pair.second);
}

/* `scale` keeps r² in range. */
static void place(const hr2d_element *e, const hr2d_element *other, hr2d_point origin,
                  double scale, samples *s) {
  const double ux = (e->b.x - e->a.x) * scale, uy = (e->b.y - e->a.y) * scale;
  const double x = (e->centre.x - origin.x) * scale, y = (e->centre.y - origin.y) * scale;
  const double vx = (other->b.x - other->a.x) * scale, vy = (other->b.y - other->a.y) * scale;
  const double length = hypot(vx, vy), nx = -vy / length, ny = vx / length;
  const double ox = (other->centre.x - origin.x) * scale;
  const double oy = (other->centre.y - origin.y) * scale;
  for (int k = 0; k < s->count; k++) {
    const double t = (k + 0.5) / s->count - 0.5;
    s->x[k] = x + t * ux;
    s->y[k] = y + t * uy;
    s->before[k] = fmax((s->x[k] - ox) * nx + (s->y[k] - oy) * ny, 0);
  }
}

static inline double kernel(double dx, double dy, double hx, double hy) {
  const double r2 = dx * dx + dy * dy;
  return r2 > 0 ? 0.5 * hx * hy / (r2 * sqrt(r2)) : 0;
}

/* Whether i comes first in the sum.  This does not depend on the order of the arguments or on
   the numbers of the elements. */
static int comes_first(const hr2d_element *i, const hr2d_element *j) {
  if (i->length != j->length) return i->length > j->length;
  if (i->centre.x != j->centre.x) return i->centre.x < j->centre.x;
  return i->centre.y < j->centre.y;
}

double hr2di_l1_grid(const hr2d_batch *batch, hr2d_pair pair, double enough) {
  const int first = comes_first(&batch->elements[pair.first], &batch->elements[pair.second]);
  const uint32_t at_i = first ? pair.first : pair.second;
  const uint32_t at_j = first ? pair.second : pair.first;
  const hr2d_element *i = &batch->elements[at_i], *j = &batch->elements[at_j];
  samples x = {.count = samples_of(batch, at_i)}, y = {.count = samples_of(batch, at_j)};
  if (x.count == 1 && y.count == 1) return 0;
  samples cx = {.count = 1}, cy = {.count = 1};
  const double dx = j->centre.x - i->centre.x, dy = j->centre.y - i->centre.y;
  int exponent;
  frexp(fabs(dx) + fabs(dy) + i->length + j->length, &exponent);
  const double scale = ldexp(1, -exponent);
  place(i, j, i->centre, scale, &x);
  place(j, i, i->centre, scale, &y);
  place(i, j, i->centre, scale, &cx);
  place(j, i, i->centre, scale, &cy);
  const double centre =
      kernel(cx.x[0] - cy.x[0], cx.y[0] - cy.y[0], cx.before[0], cy.before[0]);
  /* in units of 2^exponent */
  const double cell = (i->length * scale / x.count) * (j->length * scale / y.count);
  const double max = enough * scale / cell;
  double sum = 0;
  for (int l = 0; l < y.count && sum <= max; l++) {
    double row = 0;
    for (int k = 0; k < x.count; k++)
      row += fabs(centre - kernel(x.x[k] - y.x[l], x.y[k] - y.y[l], x.before[k], y.before[l]));
    sum += row;
  }
  return sum * cell / scale;
}
