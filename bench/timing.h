/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Medians of measured times. */
#ifndef HR2D_BENCH_TIMING_H
#define HR2D_BENCH_TIMING_H

#include <stdlib.h>

#include "support/order.h"

/* The median of an odd number of values; sorts them. */
static inline double median_of(double *value, int count) {
  qsort(value, (size_t)count, sizeof *value, order_doubles);
  return value[count / 2];
}

#endif
