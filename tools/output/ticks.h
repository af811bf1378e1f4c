/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Round numbers along an axis. */
#ifndef HR2D_TOOLS_OUTPUT_TICKS_H
#define HR2D_TOOLS_OUTPUT_TICKS_H

#include <stddef.h>

typedef struct ticks {
  double value[40];
  int count;
  double step; /* 0 on a logarithmic axis */
} ticks;

/* The largest of 1, 2 and 5 times a power of ten that is at most x > 0. */
double ticks_round_below(double x);

/* About `wanted` ticks in [lo, hi]; on a logarithmic axis 0 < lo. */
void ticks_make(ticks *t, double lo, double hi, int logarithmic, int wanted);

/* Writes the number of tick k, with as many digits as distinguish it from its neighbours. */
void ticks_label(const ticks *t, int k, char *text, size_t size);

#endif
