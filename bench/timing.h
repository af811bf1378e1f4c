/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wall time and medians for the benchmarks. */
#ifndef HR2D_BENCH_TIMING_H
#define HR2D_BENCH_TIMING_H

#include <stdlib.h>
#include <time.h>

static inline double seconds_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline int timing_compare(const void *left, const void *right) {
  const double l = *(const double *)left, r = *(const double *)right;
  return (l > r) - (l < r);
}

/* The median of an odd number of values; sorts them. */
static inline double median_of(double *value, int count) {
  qsort(value, (size_t)count, sizeof *value, timing_compare);
  return value[count / 2];
}

#endif
