/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Classes of segment pairs that are hard on an exchange area. */
#ifndef HR2D_TESTS_SUPPORT_PAIR_CLASSES_H
#define HR2D_TESTS_SUPPORT_PAIR_CLASSES_H

#include <hr2d/geometry.h>
#include <stdint.h>

typedef struct pair {
  hr2d_segment i, j;
} pair;

/* The state of a random generator (splitmix64). */
typedef struct randoms {
  uint64_t state;
} randoms;

typedef struct pair_class {
  const char *name;
  pair (*draw)(randoms *r);
  int share; /* pairs relative to the other classes */
} pair_class;

extern const pair_class pair_classes[];
extern const int pair_class_count;

/* A fresh generator for stream k of the seed. */
randoms randoms_stream(uint64_t seed, int k);

uint64_t random_bits(randoms *r);
double random_unit(randoms *r); /* [0,1) */
double random_between(randoms *r, double low, double high);
double random_power(randoms *r, double low, double high); /* 10^low to 10^high */
int random_below(randoms *r, int n);

/* x moved by up to n units in its last place. */
double random_nudge(randoms *r, double x, int n);

/* A pair of a class; most often turned so that the segments see each other. */
pair draw_pair(const pair_class *class, randoms *r);

#endif
