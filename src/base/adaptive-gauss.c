/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/adaptive-gauss.h"

#include <math.h>

enum { START = 4 /* panels */ };

typedef struct panel {
  double from, to, sum;
  int depth;
} panel;

typedef struct integral {
  const hr2di_rule *rule;
  hr2di_integrand f;
  const void *ctx;
} integral;

/* A mean of f, times the length; *size gets that of |f|. */
static panel panel_of(const integral *all, double from, double to, int depth, double *size) {
  panel p = {from, to, 0, depth};
  const double half = 0.5 * (to - from);
  for (size_t q = 0; q < all->rule->points; q++) {
    const double value =
        all->rule->weight[q] * all->f(all->ctx, from + half * (1 + all->rule->at[q]));
    p.sum += 2 * half * value;
    if (size) *size += fabs(2 * half * value);
  }
  return p;
}

/* From left to right, so that the order of the sum is the same every time. */
static double halve(const integral *all, panel whole, double most) {
  panel stack[HR2DI_ADAPTIVE_DEPTH + 2];
  int count = 0;
  double sum = 0;
  stack[count++] = whole;
  while (count > 0) {
    const panel p = stack[--count];
    const double middle = 0.5 * (p.from + p.to);
    const panel left = panel_of(all, p.from, middle, p.depth + 1, NULL),
                right = panel_of(all, middle, p.to, p.depth + 1, NULL);
    if (!(fabs(left.sum + right.sum - p.sum) > most) || left.depth >= HR2DI_ADAPTIVE_DEPTH) {
      sum += left.sum + right.sum;
      continue;
    }
    stack[count++] = right;
    stack[count++] = left;
  }
  return sum;
}

double hr2di_adaptive_gauss(const hr2di_rule *rule, hr2di_integrand f, const void *ctx,
                            double from, double to, double tolerance) {
  const integral all = {rule, f, ctx};
  panel start[START];
  double size = 0, sum = 0;
  for (int k = 0; k < START; k++)
    start[k] = panel_of(&all, from + (to - from) * k / START,
                        from + (to - from) * (k + 1) / START, 0, &size);
  for (int k = 0; k < START; k++) sum += halve(&all, start[k], tolerance * size);
  return sum;
}
