/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps of 1, 2 or 5 times a power of ten. */
#include "output/ticks.h"

#include <math.h>
#include <stdio.h>

enum { MOST = sizeof((ticks *)0)->value / sizeof(double) };

double ticks_round_below(double x) {
  const double power = pow(10, floor(log10(x)));
  const double lead = x / power * (1 + 1e-12);
  return power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
}

static void add(ticks *t, double x) {
  if (t->count < MOST) t->value[t->count++] = x;
}

static void make_linear(ticks *t, double lo, double hi, int wanted) {
  double step = ticks_round_below((hi - lo) / wanted);
  if ((hi - lo) / step > 1.6 * wanted) step = ticks_round_below(2.6 * step);
  t->step = step;
  const double slack = 1e-9 * (hi - lo);
  for (double k = ceil((lo - slack) / step); k * step <= hi + slack && t->count < MOST; k++)
    add(t, k * step == 0 ? 0 : k * step);
}

/* 1, 2 and 5 in each decade, or only powers of ten if there are many decades. */
static void make_logarithmic(ticks *t, double lo, double hi, int wanted) {
  const double decades = log10(hi / lo);
  const int sparse = 3 * decades > 1.6 * wanted;
  const double stride = fmax(1, ceil(decades / wanted));
  for (double e = floor(log10(lo)); e <= ceil(log10(hi)); e += sparse ? stride : 1)
    for (int lead = 1; lead <= 5; lead += lead == 1 ? 1 : 3) {
      const double x = lead * pow(10, e);
      if (x >= lo * (1 - 1e-9) && x <= hi * (1 + 1e-9) && (lead == 1 || !sparse)) add(t, x);
    }
}

void ticks_make(ticks *t, double lo, double hi, int logarithmic, int wanted) {
  *t = (ticks){.count = 0};
  if (logarithmic)
    make_logarithmic(t, lo, hi, wanted);
  else
    make_linear(t, lo, hi, wanted);
}

void ticks_label(const ticks *t, int k, char *text, size_t size) {
  if (!(t->step > 0)) {
    snprintf(text, size, "%g", t->value[k]);
    return;
  }
  const double max = fmax(fabs(t->value[0]), fabs(t->value[t->count - 1]));
  const int last = (int)floor(log10(t->step) + 1e-9);
  const int first = max > 0 ? (int)floor(log10(max) + 1e-9) : last;
  if (first >= 6 || last < -6)
    snprintf(text, size, "%.*e", first > last ? first - last : 0, t->value[k]);
  else
    snprintf(text, size, "%.*f", last < 0 ? -last : 0, t->value[k]);
}
