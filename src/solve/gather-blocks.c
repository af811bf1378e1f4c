/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The number of bands is a constant to the compiler where it is small, so that a row of the
   block is read once for all of them.  Sums are added in the order of hr2di_dot_strided(). */
#include "solve/gather-blocks.h"

#include "base/ordered-dot.h"
#include "solve/gather-one-way.h"

enum { FEW = 4 };

void hr2di_gather_block(const double *c, size_t stride, size_t order, size_t bands,
                        const double *from, double *to) {
  if (bands == 1) {
    hr2di_gather_rows(c, stride, order, from, to);
    return;
  }
  for (size_t l = 0; l < order; l++)
    for (size_t b = 0; b < bands; b++)
      to[l * bands + b] += hr2di_dot_strided(c + l * stride, from + b, bands, order);
}

void hr2di_gather_transposed(const double *c, size_t stride, size_t order, size_t bands,
                             const double *from, double *to) {
  if (bands == 1) {
    hr2di_gather_columns(c, stride, order, from, to);
    return;
  }
  for (size_t l = 0; l < order; l++)
    for (size_t m = 0; m < order; m++)
      for (size_t b = 0; b < bands; b++)
        to[m * bands + b] += c[l * stride + m] * from[l * bands + b];
}

/* One coefficient, both ways. */
static inline void add_entry(double entry, size_t bands, const double *restrict from,
                             const double *restrict here, double *restrict sum,
                             double *restrict to) {
  for (size_t b = 0; b < bands; b++) {
    sum[b] += entry * from[b];
    to[b] += entry * here[b];
  }
}

/* For FEW bands at most. */
static inline void add_both(const double *restrict c, size_t stride, size_t order, size_t bands,
                            const double *restrict up_i, const double *restrict up_j,
                            double *restrict down_i, double *restrict down_j) {
  for (size_t l = 0; l < order; l++) {
    const double *row = c + l * stride, *here = up_i + l * bands;
    double s[4][FEW] = {{0}}, rest[FEW] = {0};
    size_t m = 0;
    for (; m + 4 <= order; m += 4)
      for (size_t k = 0; k < 4; k++)
        add_entry(row[m + k], bands, up_j + (m + k) * bands, here, s[k],
                  down_j + (m + k) * bands);
    for (; m < order; m++)
      add_entry(row[m], bands, up_j + m * bands, here, rest, down_j + m * bands);
    for (size_t b = 0; b < bands; b++)
      down_i[l * bands + b] += hr2di_dot_four(s[0][b], s[1][b], s[2][b], s[3][b]) + rest[b];
  }
}

void hr2di_gather_both(const double *c, size_t stride, size_t order, size_t bands,
                       const double *up_i, const double *up_j, double *down_i, double *down_j) {
  switch (bands) {
  case 1:
    add_both(c, stride, order, 1, up_i, up_j, down_i, down_j);
    return;
  case 2:
    add_both(c, stride, order, 2, up_i, up_j, down_i, down_j);
    return;
  case 3:
    add_both(c, stride, order, 3, up_i, up_j, down_i, down_j);
    return;
  case FEW:
    add_both(c, stride, order, FEW, up_i, up_j, down_i, down_j);
    return;
  default:
    hr2di_gather_block(c, stride, order, bands, up_j, down_i);
    hr2di_gather_transposed(c, stride, order, bands, up_i, down_j);
  }
}
