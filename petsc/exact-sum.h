/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums whose result does not depend on the order of their terms, so that the number of ranks
   changes no bit.

   hr2dpi_sum is exact: a number in fixed point that has room for every double, in digits of 32
   bits kept in 64, so that carries can wait.  Sums of ranks are added by MPI_SUM of integers.

   A bin is for the many sums of a gather.  With σ = 1.5·2^m and |t| ≤ 2^(m−1), head = (t + σ) −
   σ is t rounded to a multiple of 2^(m−52): a function of t alone.  If Σ|t| ≤ 2^(m−1), sums of
   heads are exact in any order.  The rests t − head, of at most 2^(m−53), are rounded in the
   same way with σ·2^−24, for up to 2^28 terms.  So a sum of n terms is off by at most
   n·2^(m−77).  src/base/bin.h has the same for libhr2d: this library sees the public headers
   of that one alone, so that it can be built beside an installed libhr2d. */
#ifndef HR2D_PETSC_EXACT_SUM_H
#define HR2D_PETSC_EXACT_SUM_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Digit k has the weight 2^(32k − 1074).  The last one counts terms that are not finite. */
enum { HR2DPI_DIGITS = 70, HR2DPI_NOT_FINITE = HR2DPI_DIGITS - 1 };

typedef struct hr2dpi_sum {
  int64_t digit[HR2DPI_DIGITS];
} hr2dpi_sum;

static inline void hr2dpi_sum_add(hr2dpi_sum *sum, double term) {
  uint64_t bits;
  memcpy(&bits, &term, sizeof bits);
  const unsigned exponent = (bits >> 52) & 0x7ff;
  uint64_t mantissa = bits & 0xfffffffffffff;
  if (exponent == 0x7ff) {
    sum->digit[HR2DPI_NOT_FINITE]++;
    return;
  }
  if (exponent > 0) mantissa |= (uint64_t)1 << 52;
  const unsigned place = exponent > 0 ? exponent - 1 : 0;
  int64_t *digit = &sum->digit[place / 32];
  const uint64_t low = (mantissa & 0xffffffff) << place % 32;
  const uint64_t high = (mantissa >> 32 << place % 32) + (low >> 32);
  const int64_t sign = bits >> 63 ? -1 : 1;
  digit[0] += sign * (int64_t)(low & 0xffffffff);
  digit[1] += sign * (int64_t)(high & 0xffffffff);
  digit[2] += sign * (int64_t)(high >> 32);
}

/* Carries, so that digits of the sum are below 2^32 but the last, which has the sign. */
static inline void hr2dpi_sum_carry(hr2dpi_sum *sum) {
  for (int k = 0; k + 1 < HR2DPI_NOT_FINITE; k++) {
    const int64_t low = sum->digit[k] & 0xffffffff;
    sum->digit[k + 1] += (sum->digit[k] - low) / ((int64_t)1 << 32);
    sum->digit[k] = low;
  }
}

/* The sum, to a rounding; NaN if a term was not finite. */
static inline double hr2dpi_sum_total(const hr2dpi_sum *given) {
  hr2dpi_sum sum = *given;
  if (sum.digit[HR2DPI_NOT_FINITE]) return NAN;
  hr2dpi_sum_carry(&sum);
  const int negative = sum.digit[HR2DPI_NOT_FINITE - 1] < 0;
  if (negative) {
    for (int k = 0; k < HR2DPI_NOT_FINITE; k++) sum.digit[k] = -sum.digit[k];
    hr2dpi_sum_carry(&sum);
  }
  int top = HR2DPI_NOT_FINITE - 1;
  while (top > 0 && sum.digit[top] == 0) top--;
  double value = 0;
  for (int k = top > 3 ? top - 3 : 0; k <= top; k++)
    value = ldexp(value, -32) + (double)sum.digit[k];
  value = ldexp(value, 32 * top - 1074);
  return negative ? -value : value;
}

typedef struct hr2dpi_bin {
  double head, tail;
} hr2dpi_bin;

#define HR2DPI_TAIL 0x1p-24

/* Below this σ the rests would be denormal. */
#define HR2DPI_LEAST_SCALE 0x1.8p-900

/* σ for sums with Σ|t| ≤ size. */
static inline double hr2dpi_bin_scale(double size) {
  int exponent;
  (void)frexp(size, &exponent);
  return fmax(ldexp(1.5, exponent + 1), HR2DPI_LEAST_SCALE);
}

static inline void hr2dpi_bin_add(hr2dpi_bin *bin, double scale, double term) {
  const double head = (term + scale) - scale, rest = term - head;
  const double finer = scale * HR2DPI_TAIL;
  bin->head += head;
  bin->tail += (rest + finer) - finer;
}

static inline double hr2dpi_bin_total(hr2dpi_bin bin) {
  return bin.head + bin.tail;
}

#endif
