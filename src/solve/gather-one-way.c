/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums stay in registers, four side by side; each has its terms in the order of the plain loop,
   and rows that of hr2di_dot_strided(). */
#include "solve/gather-one-way.h"

#include "base/ordered-dot.h"
#include "base/wide.h"

HR2DI_PART void rows_loop(const double *restrict c, size_t order, const double *restrict from,
                          double *restrict to) {
  for (size_t l = 0; l < order; l++) {
    const double *row = c + l * order;
    double s[4] = {0}, rest = 0;
    size_t m = 0;
    for (; m + 4 <= order; m += 4)
      for (size_t k = 0; k < 4; k++) s[k] += row[m + k] * from[m + k];
    for (; m < order; m++) rest += row[m] * from[m];
    to[l] += hr2di_dot_four(s[0], s[1], s[2], s[3]) + rest;
  }
}
HR2DI_WIDE(rows,
           (const double *restrict c, size_t order, const double *restrict from,
            double *restrict to),
           (c, order, from, to))

/* `count` columns, a constant to the compiler. */
HR2DI_PART void columns(const double *restrict c, size_t order, size_t count,
                        const double *restrict from, double *restrict to) {
  double s[8];
  for (size_t k = 0; k < count; k++) s[k] = to[k];
  for (size_t l = 0; l < order; l++)
    for (size_t k = 0; k < count; k++) s[k] += c[l * order + k] * from[l];
  for (size_t k = 0; k < count; k++) to[k] = s[k];
}

HR2DI_PART void all_columns_loop(const double *restrict c, size_t order,
                                 const double *restrict from, double *restrict to) {
  size_t m = 0;
  for (; m + 8 <= order; m += 8) columns(c + m, order, 8, from, to + m);
  for (; m + 4 <= order; m += 4) columns(c + m, order, 4, from, to + m);
  for (; m < order; m++) columns(c + m, order, 1, from, to + m);
}
HR2DI_WIDE(all_columns,
           (const double *restrict c, size_t order, const double *restrict from,
            double *restrict to),
           (c, order, from, to))

void hr2di_gather_rows(const double *c, size_t order, const double *from, double *to) {
  rows(c, order, from, to);
}

void hr2di_gather_columns(const double *c, size_t order, const double *from, double *to) {
  all_columns(c, order, from, to);
}
