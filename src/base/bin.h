/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums whose bits do not depend on the order of their terms.

   With σ = 1.5·2^m and |t| ≤ 2^(m−1), head = (t + σ) − σ is t rounded to a multiple of
   2^(m−52): a function of t alone.  If Σ|t| ≤ 2^(m−1), sums of heads are exact in any order.
   The rests t − head, of at most 2^(m−53), are rounded in the same way with σ·2^−24, for up to
   2^28 terms. So a sum of n terms is off by at most n·2^(m−77). */
#ifndef HR2D_SRC_BASE_BIN_H
#define HR2D_SRC_BASE_BIN_H

#include <math.h>

typedef struct hr2di_bin {
  double head, tail;
} hr2di_bin;

#define HR2DI_BIN_TAIL 0x1p-24

/* Below this σ the rests would be denormal. */
#define HR2DI_BIN_LEAST 0x1.8p-900

/* σ for sums with Σ|t| ≤ size. */
static inline double hr2di_bin_scale(double size) {
  int exponent;
  (void)frexp(size, &exponent);
  return fmax(ldexp(1.5, exponent + 1), HR2DI_BIN_LEAST);
}

static inline void hr2di_bin_add(hr2di_bin *bin, double scale, double term) {
  const double head = (term + scale) - scale, rest = term - head;
  const double finer = scale * HR2DI_BIN_TAIL;
  bin->head += head;
  bin->tail += (rest + finer) - finer;
}

static inline double hr2di_bin_total(const hr2di_bin *bin) {
  return bin->head + bin->tail;
}

#endif
