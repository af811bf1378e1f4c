/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random numbers, the same on every machine (SplitMix64). */
#ifndef HR2D_TESTS_SUPPORT_RANDOM_H
#define HR2D_TESTS_SUPPORT_RANDOM_H

#include <stdint.h>

/* The state of a generator. */
typedef struct randoms {
  uint64_t state;
} randoms;

/* A fresh generator for stream k of the seed. */
randoms randoms_stream(uint64_t seed, int k);

uint64_t random_bits(randoms *r);
double random_unit(randoms *r); /* [0,1) */
double random_between(randoms *r, double low, double high);
double random_power(randoms *r, double low, double high); /* 10^low to 10^high */
int random_below(randoms *r, int n);

/* Any finite double, drawn by its bits: of any size, also subnormal. */
double random_finite(randoms *r);

/* x moved by up to n units in its last place. */
double random_nudge(randoms *r, double x, int n);

/* A number in [0,1) from a state that begins as test_seed(). */
double test_random(unsigned long *state);

#endif
