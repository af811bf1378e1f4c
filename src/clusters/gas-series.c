/* SPDX-License-Identifier: GPL-3.0-or-later */
/* T is analytic in r but at r = 0, which is outside of the ellipse of m = (high + low)/(high −
   low): terms fall like those of an expansion.  1 − T grows at most like r, so that its largest
   value is no more than high/low times another. */
#include "clusters/gas-series.h"

#include <math.h>

#include "base/bickley.h"
#include "base/pi.h"
#include "clusters/expansion.h"

/* A tenth of what an expansion may be off. */
#define SPARE 0.1

static void find_range(hr2di_gas_series *s, const hr2d_point *x, size_t xs, const hr2d_point *y,
                       size_t ys) {
  double low = HUGE_VAL, high = 0;
  for (size_t i = 0; i < xs; i++)
    for (size_t j = 0; j < ys; j++) {
      const double dx = y[j].x - x[i].x, dy = y[j].y - x[i].y, square = dx * dx + dy * dy;
      low = square < low ? square : low;
      high = square > high ? square : high;
    }
  s->low = sqrt(low);
  s->high = sqrt(high);
}

static double value_at(const hr2di_cluster_gas *gas, double r) {
  const hr2di_passage pass = hr2di_passage_at(gas->section, gas->absorption * r);
  return gas->absorbed ? pass.absorbed : pass.arrives;
}

void hr2di_gas_series_init(hr2di_gas_series *s, const hr2di_cluster_gas *gas, double accuracy,
                           const hr2d_point *x, size_t xs, const hr2d_point *y, size_t ys) {
  double value[HR2DI_GAS_TERMS];
  find_range(s, x, xs, y, ys);
  const double middle = 0.5 * (s->high + s->low), half = 0.5 * (s->high - s->low);
  const double degree =
      half > 0 ? ceil(hr2di_expansion_degree(SPARE * accuracy, middle / half)) : 0;
  s->terms = (size_t)fmin(1 + degree, HR2DI_GAS_TERMS);
  const double turn = HR2DI_PI / (double)(2 * s->terms);
  for (size_t k = 0; k < s->terms; k++)
    value[k] = value_at(gas, middle + half * cos((double)(2 * k + 1) * turn));
  for (size_t n = 0; n < s->terms; n++) {
    double sum = 0;
    for (size_t k = 0; k < s->terms; k++)
      sum += value[k] * cos((double)(n * (2 * k + 1) % (4 * s->terms)) * turn);
    s->c[n] = (n > 0 ? 2 : 1) * sum / (double)s->terms;
  }
}
