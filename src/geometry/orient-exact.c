/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orientations of any three finite points, in fixed point.

   (b−a)×(c−a) = a×b + b×c + c×a is a sum of six products of doubles.  Each product is an
   integer below 2^106 times 2^k with k from −2148 to 1942, so that all of them are integers of
   4200 bits in units of 2^-2148. */
#include "geometry/orient-exact.h"

#include <stdint.h>

enum { LOWEST = -2148, PART = 27, LIMBS = 134 };

/* Σ limb[k]·2^(32k + LOWEST), each limb with room for carries. */
typedef struct fixed {
  int64_t limb[LIMBS];
} fixed;

/* Adds sign·v·2^(LOWEST + place); v below 2^54. */
static void add_part(fixed *f, uint64_t v, int place, int sign) {
  const int at = place / 32, shift = place % 32;
  const uint64_t low = (v & UINT32_MAX) << shift, high = (v >> 32) << shift;
  f->limb[at] += sign * (int64_t)(low & UINT32_MAX);
  f->limb[at + 1] += sign * (int64_t)((low >> 32) + (high & UINT32_MAX));
  f->limb[at + 2] += sign * (int64_t)(high >> 32);
}

/* x = ±digits·2^e */
static uint64_t digits_of(double x, int *e) {
  const double m = frexp(fabs(x), e);
  *e -= 53;
  if (*e >= -1074) return (uint64_t)ldexp(m, 53);
  *e = -1074;
  return (uint64_t)ldexp(fabs(x), 1074);
}

static void add_product(fixed *f, double x, double y, int sign) {
  const uint64_t mask = ((uint64_t)1 << PART) - 1;
  int ex, ey;
  if (x == 0 || y == 0) return;
  const uint64_t p = digits_of(x, &ex), q = digits_of(y, &ey);
  const int place = ex + ey - LOWEST;
  if ((x < 0) != (y < 0)) sign = -sign;
  add_part(f, (p & mask) * (q & mask), place, sign);
  add_part(f, (p >> PART) * (q & mask), place + PART, sign);
  add_part(f, (p & mask) * (q >> PART), place + PART, sign);
  add_part(f, (p >> PART) * (q >> PART), place + 2 * PART, sign);
}

/* Brings all limbs but the last into [0, 2^32); returns the sign of the last. */
static int carry(fixed *f) {
  const int64_t base = (int64_t)1 << 32;
  for (int k = 0; k + 1 < LIMBS; k++) {
    int64_t rest = f->limb[k] % base;
    if (rest < 0) rest += base;
    f->limb[k + 1] += (f->limb[k] - rest) / base;
    f->limb[k] = rest;
  }
  return f->limb[LIMBS - 1] < 0 ? -1 : 1;
}

/* The top three limbs have at least 65 significant bits: the relative error is 2^-53 for
   rounding and 2^-64 for the other limbs. */
static hr2di_scaled value_of(fixed *f) {
  const int sign = carry(f);
  if (sign < 0) {
    for (int k = 0; k < LIMBS; k++) f->limb[k] = -f->limb[k];
    carry(f);
  }
  int top = LIMBS - 1;
  while (top > 2 && f->limb[top] == 0) top--;
  const double head = (double)(f->limb[top] * ((int64_t)1 << 20) + (f->limb[top - 1] >> 12));
  const double tail =
      (double)((f->limb[top - 1] & 0xfff) * ((int64_t)1 << 32) + f->limb[top - 2]);
  return hr2di_scaled_of(sign * (head + tail * 0x1p-44), LOWEST + 32 * top - 20);
}

hr2di_scaled hr2di_orient_exact(hr2d_point a, hr2d_point b, hr2d_point c) {
  fixed f = {{0}};
  add_product(&f, a.x, b.y, 1);
  add_product(&f, a.y, b.x, -1);
  add_product(&f, b.x, c.y, 1);
  add_product(&f, b.y, c.x, -1);
  add_product(&f, c.x, a.y, 1);
  add_product(&f, c.y, a.x, -1);
  return value_of(&f);
}
