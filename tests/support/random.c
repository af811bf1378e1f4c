/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/random.h"

#include <math.h>
#include <string.h>

uint64_t random_bits(randoms *r) {
  uint64_t z = r->state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

randoms randoms_stream(uint64_t seed, int k) {
  randoms r = {seed};
  r.state = random_bits(&r) + (uint64_t)k;
  r.state = random_bits(&r);
  return r;
}

double random_unit(randoms *r) {
  return (double)(random_bits(r) >> 11) * 0x1p-53;
}

double random_between(randoms *r, double low, double high) {
  return low + (high - low) * random_unit(r);
}

double random_power(randoms *r, double low, double high) {
  return pow(10, random_between(r, low, high));
}

int random_below(randoms *r, int n) {
  return (int)(random_unit(r) * n);
}

double random_finite(randoms *r) {
  for (;;) {
    const uint64_t bits = random_bits(r);
    double value;
    memcpy(&value, &bits, sizeof value);
    if (isfinite(value)) return value;
  }
}

double random_nudge(randoms *r, double x, int n) {
  int steps = random_below(r, 2 * n + 1) - n;
  for (; steps > 0; steps--) x = nextafter(x, INFINITY);
  for (; steps < 0; steps++) x = nextafter(x, -INFINITY);
  return x;
}

double test_random(unsigned long *state) {
  randoms r = {*state};
  const double drawn = random_unit(&r);
  *state = (unsigned long)r.state;
  return drawn;
}
