/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads bytes as choices and numbers; ends a run whose invariant does not hold. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

_Noreturn void fuzz_fail(const char *file, int line, const char *condition, const char *text) {
  fprintf(stderr, "%s:%d: does not hold: %s%s%s\n", file, line, condition, *text ? ": " : "",
          text);
  abort();
}

unsigned fuzz_byte(fuzz_input *in) {
  return in->at < in->end ? *in->at++ : 0;
}

unsigned fuzz_below(fuzz_input *in, unsigned n) {
  return fuzz_byte(in) % n;
}

uint64_t fuzz_word(fuzz_input *in) {
  uint64_t word = 0;
  for (int k = 0; k < 8; k++) word |= (uint64_t)fuzz_byte(in) << (8 * k);
  return word;
}

double fuzz_raw(fuzz_input *in) {
  const uint64_t word = fuzz_word(in);
  double value;
  memcpy(&value, &word, sizeof value);
  return value;
}

double fuzz_finite(fuzz_input *in) {
  const double value = fuzz_raw(in);
  return isfinite(value) ? value : 0;
}

double fuzz_unit(fuzz_input *in) {
  const unsigned b = fuzz_byte(in);
  switch (b & 7) {
  case 0:
    return 0;
  case 1:
    return 1;
  case 2:
    return 1 - ldexp(1, -(int)(b >> 3) - 1);
  case 3:
    return ldexp(1, -(int)(b >> 3) - 1);
  default:
    return (b >> 3) / 31.0;
  }
}

uint64_t fuzz_hash(uint64_t x) {
  uint64_t z = x + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

uint64_t fuzz_hash_bytes(const uint8_t *data, size_t size) {
  uint64_t hash = size;
  for (size_t k = 0; k < size; k++) hash = fuzz_hash(hash ^ data[k]);
  return hash;
}
