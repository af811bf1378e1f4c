/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers m·2^e whose exponent e is an int: only the final double can under- or overflow, no
   number on the way to it.  m is 0 or |m| is in [½,1). */
#ifndef HR2D_SRC_BASE_SCALED_DOUBLE_H
#define HR2D_SRC_BASE_SCALED_DOUBLE_H

#include <math.h>

typedef struct hr2di_scaled {
  double m;
  int e;
} hr2di_scaled;

static inline hr2di_scaled hr2di_scaled_of(double m, int e) {
  int shift = 0;
  m = frexp(m, &shift);
  return (hr2di_scaled){m, m == 0 ? 0 : e + shift};
}

static inline double hr2di_scaled_value(hr2di_scaled x) {
  return ldexp(x.m, x.e);
}

static inline hr2di_scaled hr2di_scaled_neg(hr2di_scaled x) {
  return (hr2di_scaled){-x.m, x.e};
}

static inline hr2di_scaled hr2di_scaled_mul(hr2di_scaled x, hr2di_scaled y) {
  return hr2di_scaled_of(x.m * y.m, x.e + y.e);
}

static inline hr2di_scaled hr2di_scaled_div(hr2di_scaled x, hr2di_scaled y) {
  return hr2di_scaled_of(x.m / y.m, x.e - y.e);
}

static inline hr2di_scaled hr2di_scaled_add(hr2di_scaled x, hr2di_scaled y) {
  if (x.m == 0) return y;
  if (y.m == 0) return x;
  const int e = x.e > y.e ? x.e : y.e;
  return hr2di_scaled_of(ldexp(x.m, x.e - e) + ldexp(y.m, y.e - e), e);
}

static inline hr2di_scaled hr2di_scaled_sub(hr2di_scaled x, hr2di_scaled y) {
  return hr2di_scaled_add(x, hr2di_scaled_neg(y));
}

#endif
