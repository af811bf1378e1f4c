/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The number of bands is a constant to the compiler where it is small, so that a row of the
   block is read once for all of them.  Sums are added in the order of hr2di_dot_strided(). */
#include "solve/gather-blocks.h"

#include "base/ordered-dot.h"
#include "base/wide.h"
#include "solve/gather-one-way.h"

enum { FEW = 4 };

void hr2di_gather_block(const double *c, size_t order, size_t bands, const double *from,
                        double *to) {
  if (bands == 1) {
    hr2di_gather_rows(c, order, from, to);
    return;
  }
  for (size_t l = 0; l < order; l++)
    for (size_t b = 0; b < bands; b++)
      to[l * bands + b] += hr2di_dot_strided(c + l * order, from + b, bands, order);
}

void hr2di_gather_transposed(const double *c, size_t order, size_t bands, const double *from,
                             double *to) {
  if (bands == 1) {
    hr2di_gather_columns(c, order, from, to);
    return;
  }
  for (size_t l = 0; l < order; l++)
    for (size_t m = 0; m < order; m++)
      for (size_t b = 0; b < bands; b++)
        to[m * bands + b] += c[l * order + m] * from[l * bands + b];
}

/* Four coefficients with `bands` values each are one array, which fills wide vectors. */
HR2DI_PART void add_both(const double *restrict c, size_t order, size_t bands,
                         const double *restrict up_i, const double *restrict up_j,
                         double *restrict down_i, double *restrict down_j) {
  for (size_t l = 0; l < order; l++) {
    const double *row = c + l * order;
    double s[4 * FEW] = {0}, rest[FEW] = {0}, here[4 * FEW], entry[4 * FEW];
    for (size_t q = 0; q < 4 * bands; q++) here[q] = up_i[l * bands + q % bands];
    size_t m = 0;
    for (; m + 4 <= order; m += 4) {
      const double *from = up_j + m * bands;
      double *to = down_j + m * bands;
      for (size_t q = 0; q < 4 * bands; q++) entry[q] = row[m + q / bands];
      for (size_t q = 0; q < 4 * bands; q++) s[q] += entry[q] * from[q];
      for (size_t q = 0; q < 4 * bands; q++) to[q] += entry[q] * here[q];
    }
    for (; m < order; m++)
      for (size_t b = 0; b < bands; b++) {
        rest[b] += row[m] * up_j[m * bands + b];
        down_j[m * bands + b] += row[m] * here[b];
      }
    for (size_t b = 0; b < bands; b++)
      down_i[l * bands + b] +=
          hr2di_dot_four(s[b], s[bands + b], s[2 * bands + b], s[3 * bands + b]) + rest[b];
  }
}

HR2DI_PART void few_loop(const double *c, size_t order, size_t bands, const double *up_i,
                         const double *up_j, double *down_i, double *down_j) {
  switch (bands) {
  case 1:
    add_both(c, order, 1, up_i, up_j, down_i, down_j);
    return;
  case 2:
    add_both(c, order, 2, up_i, up_j, down_i, down_j);
    return;
  case 3:
    add_both(c, order, 3, up_i, up_j, down_i, down_j);
    return;
  default:
    add_both(c, order, FEW, up_i, up_j, down_i, down_j);
  }
}
HR2DI_WIDE(few,
           (const double *c, size_t order, size_t bands, const double *up_i, const double *up_j,
            double *down_i, double *down_j),
           (c, order, bands, up_i, up_j, down_i, down_j))

void hr2di_gather_both(const double *c, size_t order, size_t bands, const double *up_i,
                       const double *up_j, double *down_i, double *down_j) {
  if (bands <= FEW) {
    few(c, order, bands, up_i, up_j, down_i, down_j);
    return;
  }
  hr2di_gather_block(c, order, bands, up_j, down_i);
  hr2di_gather_transposed(c, order, bands, up_i, down_j);
}
