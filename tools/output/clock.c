/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The monotonic clock: setting the time of day does not disturb a measurement. */
#include "output/clock.h"

#include <time.h>

double clock_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
