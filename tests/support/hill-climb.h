/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Searches for the inputs on which the error of a function is largest: random inputs first,
   then climbs from several starts, in small and in wild steps. */
#ifndef HR2D_TESTS_SUPPORT_HILL_CLIMB_H
#define HR2D_TESTS_SUPPORT_HILL_CLIMB_H

#include <stddef.h>

#include "support/pair-classes.h"

enum { HILL_MOST = 24 };

typedef struct hill {
  const char *name;
  size_t count;  /* numbers of an input, at most HILL_MOST */
  size_t points; /* the first 2·points of them are the x and y of points */
  void (*draw)(const void *ctx, randoms *r, double *x);
  /* The error to be maximised; negative for an input to which the bound does not apply. */
  double (*error)(const void *ctx, const double *x);
  const void *ctx;
} hill;

typedef struct hill_effort {
  int draws;         /* random inputs */
  int climbs, steps; /* a climb starts from the best of a few random inputs */
} hill_effort;

typedef struct summit {
  double error;
  double x[HILL_MOST];
  long tried; /* inputs to which the bound applies */
} summit;

/* Point k of an input. */
static inline hr2d_point hill_point(const double *x, int k) {
  return (hr2d_point){x[2 * k], x[2 * k + 1]};
}

/* `stream` tells searches of one seed apart; draws and climbs are scaled by
   test_multiplier(). */
summit hill_climb(const hill *hill, hill_effort effort, int stream);

/* Prints the seed, the worst input as hexadecimal numbers, and its error, and asserts that
   that is within the bound, and that something was tried. */
void hill_assert(const hill *hill, const summit *top, double bound);

/* Both. */
void hill_hold(const hill *hill, hill_effort effort, int stream, double bound);

/* A negative control: asserts that the search finds an error of at least `min`.  The
   multiplier does not scale it, because fewer climbs may miss. */
void hill_exceed(const hill *hill, hill_effort effort, int stream, double min);

#endif
