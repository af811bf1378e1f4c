/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times grow by a factor from run to run; the next one is expected to grow by the same. */
#include "cost/pace.h"

#include <math.h>

pace pace_start(double share) {
  return (pace){.share = share, .growth = 4};
}

void pace_note(pace *p, double once, double spent) {
  if (p->last > 0) p->growth = fmin(16, fmax(2, once / p->last));
  p->last = once;
  p->spent += spent;
}

int pace_allows(const pace *p) {
  return p->spent + p->growth * p->last <= p->share;
}

int pace_repeats(double seconds) {
  return seconds < 0.01 ? 5 : seconds < 0.05 ? 3 : 1;
}
