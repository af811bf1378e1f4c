/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A row of the block is read once for up to four bands, which lie side by side in vectors; of
   one band four coefficients do.  Sums are added in the order of hr2di_dot_strided(). */
#include "solve/gather-blocks.h"

#include <hr2d/hierarchy.h>

#include "base/ordered-dot.h"
#include "base/wide.h"
#include "solve/gather-one-way.h"

enum { UNROLLED_BANDS = 4 };

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

/* One band. */
HR2DI_PART void add_band(const double *restrict c, size_t order, const double *restrict up_i,
                         const double *restrict up_j, double *restrict down_i,
                         double *restrict down_j) {
  for (size_t l = 0; l < order; l++, c += order) {
    hr2di_four s = {0};
    double rest = 0;
    size_t m = 0;
    for (; m + 4 <= order; m += 4) {
      const hr2di_four entry = *(const hr2di_four *)(c + m);
      s += entry * *(const hr2di_four *)(up_j + m);
      *(hr2di_four *)(down_j + m) += entry * up_i[l];
    }
    for (; m < order; m++) {
      rest += c[m] * up_j[m];
      down_j[m] += c[m] * up_i[l];
    }
    down_i[l] += hr2di_dot_four(s[0], s[1], s[2], s[3]) + rest;
  }
}

HR2DI_PART void store(const hr2di_four *from, size_t bands, double *to) {
  for (size_t b = 0; b < bands; b++) to[b] = (*from)[b];
}

/* Two rows or one of a block of 2 to 4 bands, with the sums of hr2di_dot_four() for each.  What
   is read behind the values of a coefficient, perhaps of the other element, is left alone. */
HR2DI_PART void add_rows(const double *restrict c, size_t order, size_t bands, size_t rows,
                         const double *restrict up_i, const double *restrict up_j,
                         double *down_i, hr2di_four *restrict sum) {
  hr2di_four here[2], s[2][4] = {{{0}}}, rest[2] = {{0}};
  const double *from = up_j;
  size_t m = 0;
  for (size_t r = 0; r < rows; r++) here[r] = *(const hr2di_four *)(up_i + r * bands);
  for (; m + 4 <= order; m += 4)
    for (size_t q = 0; q < 4; q++, from += bands)
      for (size_t r = 0; r < rows; r++) {
        s[r][q] += c[r * order + m + q] * *(const hr2di_four *)from;
        sum[m + q] += c[r * order + m + q] * here[r];
      }
  for (; m < order; m++, from += bands)
    for (size_t r = 0; r < rows; r++) {
      rest[r] += c[r * order + m] * *(const hr2di_four *)from;
      sum[m] += c[r * order + m] * here[r];
    }
  for (size_t r = 0; r < rows; r++) {
    hr2di_four to = *(const hr2di_four *)(down_i + r * bands);
    to += ((s[r][0] + s[r][2]) + (s[r][1] + s[r][3])) + rest[r];
    store(&to, bands, down_i + r * bands);
  }
}

HR2DI_PART void add_bands(const double *restrict c, size_t order, size_t bands,
                          const double *restrict up_i, const double *restrict up_j,
                          double *down_i, double *down_j) {
  hr2di_four sum[HR2D_MAX_ORDER];
  size_t l = 0;
  for (size_t m = 0; m < order; m++) sum[m] = *(const hr2di_four *)(down_j + m * bands);
  for (; l + 2 <= order; l += 2)
    add_rows(c + l * order, order, bands, 2, up_i + l * bands, up_j, down_i + l * bands, sum);
  if (l < order)
    add_rows(c + l * order, order, bands, 1, up_i + l * bands, up_j, down_i + l * bands, sum);
  for (size_t m = 0; m < order; m++) store(&sum[m], bands, down_j + m * bands);
}

HR2DI_PART void few_loop(const double *c, size_t order, size_t bands, const double *up_i,
                         const double *up_j, double *down_i, double *down_j) {
  switch (bands) {
  case 1:
    add_band(c, order, up_i, up_j, down_i, down_j);
    return;
  case 2:
    add_bands(c, order, 2, up_i, up_j, down_i, down_j);
    return;
  case 3:
    add_bands(c, order, 3, up_i, up_j, down_i, down_j);
    return;
  default:
    add_bands(c, order, UNROLLED_BANDS, up_i, up_j, down_i, down_j);
  }
}
HR2DI_WIDE(few,
           (const double *c, size_t order, size_t bands, const double *up_i, const double *up_j,
            double *down_i, double *down_j),
           (c, order, bands, up_i, up_j, down_i, down_j))

void hr2di_gather_both(const double *c, size_t order, size_t bands, const double *up_i,
                       const double *up_j, double *down_i, double *down_j) {
  if (bands <= UNROLLED_BANDS) {
    few(c, order, bands, up_i, up_j, down_i, down_j);
    return;
  }
  hr2di_gather_block(c, order, bands, up_j, down_i);
  hr2di_gather_transposed(c, order, bands, up_i, down_j);
}
