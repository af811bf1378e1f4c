/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random numbers (SplitMix64): a case is its kind and its seed, on any machine. */
#ifndef HR2D_TESTS_ADVERSARY_RANDOM_H
#define HR2D_TESTS_ADVERSARY_RANDOM_H

#include <stdint.h>

typedef struct adv_random {
  uint64_t state;
} adv_random;

static inline uint64_t adv_next(adv_random *r) {
  uint64_t z = r->state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/* The numbers of a seed and a name. */
static inline adv_random adv_seed(uint64_t seed, const char *name) {
  adv_random r = {seed};
  for (; *name; name++) r.state = adv_next(&r) ^ (unsigned char)*name;
  return r;
}

/* A number in [low, high). */
static inline double adv_real(adv_random *r, double low, double high) {
  return low + (high - low) * ((double)(adv_next(r) >> 11) * 0x1p-53);
}

/* An integer from low to high, both included. */
static inline int adv_int(adv_random *r, int low, int high) {
  return low + (int)(adv_next(r) % (uint64_t)(high - low + 1));
}

static inline int adv_chance(adv_random *r, double probability) {
  return adv_real(r, 0, 1) < probability;
}

#endif
