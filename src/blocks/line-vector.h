/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums and multiples of vectors with twice the digits of doubles: their relative error is below
   2^-100 of the larger operand. */
#ifndef HR2D_SRC_BLOCKS_LINE_VECTOR_H
#define HR2D_SRC_BLOCKS_LINE_VECTOR_H

#include <stdint.h>
#include <string.h>

#include "geometry/determinant.h"

/* The sum of x and a tail, again as a double and its tail. */
static inline void hr2di_vector_settle(double *x, double *tail) {
  const double sum = *x + *tail;
  *tail = *tail - (sum - *x);
  *x = sum;
}

static inline hr2di_vector hr2di_vector_minus(const hr2di_vector *p, const hr2di_vector *q) {
  hr2di_vector v = {.x = p->x - q->x, .y = p->y - q->y};
  v.tx = hr2di_tail_of_difference(p->x, q->x, v.x) + (p->tx - q->tx);
  v.ty = hr2di_tail_of_difference(p->y, q->y, v.y) + (p->ty - q->ty);
  hr2di_vector_settle(&v.x, &v.tx);
  hr2di_vector_settle(&v.y, &v.ty);
  return v;
}

static inline hr2di_vector hr2di_vector_reversed(const hr2di_vector *p) {
  return (hr2di_vector){-p->x, -p->y, -p->tx, -p->ty, 0};
}

static inline hr2di_vector hr2di_vector_plus(const hr2di_vector *p, const hr2di_vector *q) {
  const hr2di_vector reversed = hr2di_vector_reversed(q);
  return hr2di_vector_minus(p, &reversed);
}

static inline hr2di_vector hr2di_vector_times(const hr2di_vector *p, double factor) {
  hr2di_vector v = {.x = factor * p->x, .y = factor * p->y};
  v.tx = hr2di_tail_of_product(factor, p->x, v.x) + factor * p->tx;
  v.ty = hr2di_tail_of_product(factor, p->y, v.y) + factor * p->ty;
  hr2di_vector_settle(&v.x, &v.tx);
  hr2di_vector_settle(&v.y, &v.ty);
  return v;
}

/* The same for a power of two: exact where nothing under- or overflows. */
static inline hr2di_vector hr2di_vector_scaled(const hr2di_vector *p, double power) {
  return (hr2di_vector){power * p->x, power * p->y, power * p->tx, power * p->ty, 0};
}

/* A power of two that brings the larger component into [1,2), so that no product underflows; 0
   for a vector that is 0.  The exponents of doubles are their bits 52 to 62, plus 1023. */
static inline double hr2di_vector_scale(const hr2di_vector *p) {
  const double x = fabs(p->x), y = fabs(p->y), size = x > y ? x : y;
  uint64_t bits;
  double scale;
  if (!(size > 0x1p-1000 && size < 0x1p+1000)) return size > 0;
  memcpy(&bits, &size, sizeof bits);
  bits = (2046 - (bits >> 52)) << 52;
  memcpy(&scale, &bits, sizeof scale);
  return scale;
}

/* p × q to 4·2^-53, in plain doubles where few digits cancel. */
static inline double hr2di_vector_cross(const hr2di_vector *p, const hr2di_vector *q) {
  const double a = p->x * q->y, b = p->y * q->x, plain = a - b;
  int sure = 1;
  if (fabs(plain) >= 0.5 * (fabs(a) + fabs(b))) return plain;
  const double corrected = hr2di_det_corrected(p, q, &sure);
  return sure ? corrected : hr2di_det(p, q);
}

#endif
