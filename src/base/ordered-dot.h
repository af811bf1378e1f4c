/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scalar product in four partial sums side by side, which fit vectors of two or of four.  The
   order of all additions is written down.  If the compiler were free to split the sum, its bits
   would depend on the compiler, on the level of optimisation and on the processor. */
#ifndef HR2D_SRC_BASE_ORDERED_DOT_H
#define HR2D_SRC_BASE_ORDERED_DOT_H

#include <stddef.h>

#include "base/wide.h"

static inline double hr2di_dot_four(double s0, double s1, double s2, double s3) {
  return (s0 + s2) + (s1 + s3);
}

/* Σ a[k] b[k·stride] */
static inline double hr2di_dot_strided(const double *a, const double *b, size_t stride,
                                       size_t count) {
  double s0 = 0, s1 = 0, s2 = 0, s3 = 0, rest = 0;
  size_t k = 0;
  for (; k + 4 <= count; k += 4) {
    s0 += a[k] * b[k * stride];
    s1 += a[k + 1] * b[(k + 1) * stride];
    s2 += a[k + 2] * b[(k + 2) * stride];
    s3 += a[k + 3] * b[(k + 3) * stride];
  }
  for (; k < count; k++) rest += a[k] * b[k * stride];
  return hr2di_dot_four(s0, s1, s2, s3) + rest;
}

/* Four such products, for b and the three numbers behind it. */
HR2DI_PART void hr2di_dot_fours(const double *a, const double *b, size_t stride, size_t count,
                                hr2di_four *to) {
  hr2di_four s[4] = {{0}}, rest = {0};
  size_t k = 0;
  for (; k + 4 <= count; k += 4)
    for (size_t q = 0; q < 4; q++)
      s[q] += a[k + q] * *(const hr2di_four *)(b + (k + q) * stride);
  for (; k < count; k++) rest += a[k] * *(const hr2di_four *)(b + k * stride);
  *to = ((s[0] + s[2]) + (s[1] + s[3])) + rest;
}

#endif
