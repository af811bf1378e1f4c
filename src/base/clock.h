/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wall time that only moves forward. */
#ifndef HR2D_SRC_BASE_CLOCK_H
#define HR2D_SRC_BASE_CLOCK_H

#include <time.h>

static inline double hr2di_clock_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
