/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "clusters/point-exchange.h"

#include <math.h>

#include "base/ordered-dot.h"
#include "base/wide.h"
#include "clusters/clusters-impl.h"

/* T between a point and all points of a cluster: xx, xy, yy. */
typedef struct row {
  double xx[HR2DI_CLUSTER_POINTS], xy[HR2DI_CLUSTER_POINTS], yy[HR2DI_CLUSTER_POINTS];
} row;

HR2DI_PART void fill_row_loop(row *restrict t, hr2d_point x, const hr2d_point *restrict y,
                              size_t count) {
  for (size_t k = 0; k < count; k++) {
    const double dx = y[k].x - x.x, dy = y[k].y - x.y;
    const double square = dx * dx + dy * dy, s = -0.5 / (square * sqrt(square));
    t->xx[k] = s * dx * dx;
    t->xy[k] = s * dx * dy;
    t->yy[k] = s * dy * dy;
  }
}
HR2DI_WIDE(fill_row,
           (row *restrict t, hr2d_point x, const hr2d_point *restrict y, size_t count),
           (t, x, y, count))

/* The part of a row that gas leaves or takes: Clenshaw's sum of the series, for all points of
   the row at a time. */
HR2DI_PART void dim_row_loop(row *restrict t, hr2d_point x, const hr2d_point *restrict y,
                             size_t count, const hr2di_gas_series *restrict gas) {
  double at[HR2DI_CLUSTER_POINTS], sum[2][HR2DI_CLUSTER_POINTS];
  const double middle = 0.5 * (gas->high + gas->low), half = 0.5 * (gas->high - gas->low);
  const double scale = half > 0 ? 1 / half : 0;
  double *last = sum[0], *before = sum[1];
  for (size_t k = 0; k < count; k++) {
    const double dx = y[k].x - x.x, dy = y[k].y - x.y;
    at[k] = (sqrt(dx * dx + dy * dy) - middle) * scale;
    sum[0][k] = sum[1][k] = 0;
  }
  for (size_t n = gas->terms; n-- > 1;) {
    for (size_t k = 0; k < count; k++) before[k] = gas->c[n] + 2 * at[k] * last[k] - before[k];
    double *swap = last;
    last = before;
    before = swap;
  }
  for (size_t k = 0; k < count; k++) {
    const double part = gas->c[0] + at[k] * last[k] - before[k];
    t->xx[k] *= part;
    t->xy[k] *= part;
    t->yy[k] *= part;
  }
}
HR2DI_WIDE(dim_row,
           (row *restrict t, hr2d_point x, const hr2d_point *restrict y, size_t count,
            const hr2di_gas_series *restrict gas),
           (t, x, y, count, gas))

static uint64_t units_of(size_t points, size_t bands, const hr2di_gas_series *gas,
                         size_t each) {
  return 1 + points * (1 + bands + (gas ? gas->terms / 4 : 0)) / each;
}

/* One band of a row, both ways.  Sums are four side by side. */
HR2DI_PART void exchange_row_loop(const row *restrict t, size_t count, const double sent[2],
                                  const double *restrict sent_x, const double *restrict sent_y,
                                  double received[2], double *restrict received_x,
                                  double *restrict received_y) {
  double x[4] = {0}, y[4] = {0};
  size_t k = 0;
  for (; k + 4 <= count; k += 4)
    for (size_t l = 0; l < 4; l++) {
      received_x[k + l] += t->xx[k + l] * sent[0] + t->xy[k + l] * sent[1];
      received_y[k + l] += t->xy[k + l] * sent[0] + t->yy[k + l] * sent[1];
      x[l] += t->xx[k + l] * sent_x[k + l] + t->xy[k + l] * sent_y[k + l];
      y[l] += t->xy[k + l] * sent_x[k + l] + t->yy[k + l] * sent_y[k + l];
    }
  for (; k < count; k++) {
    received_x[k] += t->xx[k] * sent[0] + t->xy[k] * sent[1];
    received_y[k] += t->xy[k] * sent[0] + t->yy[k] * sent[1];
    x[0] += t->xx[k] * sent_x[k] + t->xy[k] * sent_y[k];
    y[0] += t->xy[k] * sent_x[k] + t->yy[k] * sent_y[k];
  }
  received[0] += hr2di_dot_four(x[0], x[1], x[2], x[3]);
  received[1] += hr2di_dot_four(y[0], y[1], y[2], y[3]);
}
HR2DI_WIDE(exchange_row,
           (const row *restrict t, size_t count, const double sent[2],
            const double *restrict sent_x, const double *restrict sent_y, double received[2],
            double *restrict received_x, double *restrict received_y),
           (t, count, sent, sent_x, sent_y, received, received_x, received_y))

void hr2di_points_exchange(const hr2di_points *i, const hr2di_points *j, size_t bands,
                           const hr2di_gas_series *gas, hr2di_watch *watch) {
  const size_t m = i->count, n = j->count;
  row t;
  for (size_t k = 0; k < m; k++) {
    if (hr2di_watch_work(watch, units_of(n, bands, gas, 16))) return;
    fill_row(&t, i->point[k], j->point, n);
    if (gas) dim_row(&t, i->point[k], j->point, n, gas);
    for (size_t band = 0; band < bands; band++) {
      const size_t x = band, y = bands + band;
      const double sent[] = {i->sent[x * m + k], i->sent[y * m + k]};
      double received[2] = {0, 0};
      exchange_row(&t, n, sent, j->sent + x * n, j->sent + y * n, received, j->received + x * n,
                   j->received + y * n);
      i->received[x * m + k] += received[0];
      i->received[y * m + k] += received[1];
    }
  }
}

void hr2di_points_receive(const hr2di_points *i, const hr2di_points *j, size_t bands,
                          const hr2di_gas_series *gas, hr2di_watch *watch) {
  const size_t m = i->count, n = j->count;
  row t;
  for (size_t k = 0; k < m; k++) {
    if (hr2di_watch_work(watch, units_of(n, bands, gas, 32))) return;
    fill_row(&t, i->point[k], j->point, n);
    if (gas) dim_row(&t, i->point[k], j->point, n, gas);
    for (size_t band = 0; band < bands; band++) {
      const double *sent_x = j->sent + band * n, *sent_y = j->sent + (bands + band) * n;
      double x = 0, y = 0;
      for (size_t q = 0; q < n; q++) {
        x += t.xx[q] * sent_x[q] + t.xy[q] * sent_y[q];
        y += t.xy[q] * sent_x[q] + t.yy[q] * sent_y[q];
      }
      i->received[band * m + k] += x;
      i->received[(bands + band) * m + k] += y;
    }
  }
}
