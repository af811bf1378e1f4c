/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times, and their medians. */
#ifndef HR2D_BENCH_TIMING_H
#define HR2D_BENCH_TIMING_H

#include <stdlib.h>
#include <time.h>

#include "support/order.h"

/* Seconds of all threads of this process: what other programs do meanwhile matters little. */
static inline double cpu_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The median of an odd number of values; sorts them. */
static inline double median_of(double *value, int count) {
  qsort(value, (size_t)count, sizeof *value, order_doubles);
  return value[count / 2];
}

#endif
