/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colour scale: the range of B, linear or logarithmic. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>

#include "output/complain.h"
#include "run/leaves.h"

/* If the average B lies this low on a linear scale, most of the scene would be black. */
#define TOO_LOW 0.2

/* B averaged over all patches. */
static double overall(const picture *p) {
  double sum = 0, length = 0;
  for (size_t k = 0; k < hr2d_scene_patches(p->run->scene); k++) {
    const double own = hr2d_scene_length(p->run->scene, k);
    sum += own * run_mean(p->run, (uint32_t)k);
    length += own;
  }
  return sum / length;
}

static void widen(picture *p, double value) {
  p->lo = fmin(p->lo, value);
  p->hi = fmax(p->hi, value);
}

/* A polynomial may have its extremes anywhere. */
static int widen_by_leaf(void *ctx, const piece *e) {
  picture *p = ctx;
  const unsigned order = p->run->account.order;
  const uint32_t patch = hr2d_hierarchy_elements(p->run->hierarchy)[e->element].patch;
  if (order == 1) widen(p, run_mean(p->run, e->element));
  for (unsigned k = 0; order > 1 && k <= 4 * order; k++)
    widen(p, run_mean_at(p->run, patch, leaves_at(e, k / (4. * order))));
  return 0;
}

int scale_choose(picture *p) {
  int status = 0;
  p->lo = INFINITY;
  p->hi = -INFINITY;
  for (size_t k = 0; !status && k < hr2d_scene_patches(p->run->scene); k++)
    status = leaves_walk(p->run->hierarchy, k, 0, widen_by_leaf, p);
  if (status) return status;
  p->logarithmic =
      p->hi > 3 * p->lo && p->lo > 0 && (overall(p) - p->lo) / (p->hi - p->lo) < TOO_LOW;
  if (p->hi - p->lo > 1e-9 * fabs(p->hi)) return EXIT_DONE;
  const double margin = p->hi > 0 ? 0.5 * p->hi : 1;
  p->lo = fmax(0, p->lo - margin);
  p->hi += margin;
  return EXIT_DONE;
}

double scale_position(const picture *p, double value) {
  if (p->logarithmic) return log(value / p->lo) / log(p->hi / p->lo);
  return (value - p->lo) / (p->hi - p->lo);
}
#endif
