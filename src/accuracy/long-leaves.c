/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A kink inside an element of length h makes an error of about h³ (see kinks.c).  Two halves of
   an element make a quarter of that, so that the sum over all leaves falls most where the
   longest ones are halved. */
#include "accuracy/long-leaves.h"

#include <math.h>

#include "scene/scene-impl.h"

/* What may be left of the sum; to halve all leaves leaves a quarter. */
#define LEFT 0.125

/* Lengths are tried in steps of a third of a halving. */
#define STEP 0.79370052598409974 /* 2^−⅓ */

static int divides(const hr2d_scene *scene, const hr2d_element *e) {
  double rho = 0;
  for (size_t b = 0; b < scene->bands; b++)
    rho = fmax(rho, hr2d_scene_reflectance(scene, e->patch, b));
  return !e->child && rho > 0 && e->patch < hr2di_scene_cell(scene) &&
         hr2di_scene_lit(scene, e->patch);
}

/* The sum of h³ if no leaf is longer than `longest`. */
static double sum_parts(const hr2d_hierarchy *h, double longest, hr2di_watch *watch) {
  double sum = 0;
  for (size_t k = 0; k < h->elements && !hr2di_watch_work(watch, 1); k++) {
    if (!divides(h->scene, &h->element[k])) continue;
    double length = h->element[k].length, count = 1;
    for (; length > longest; count *= 2) length *= 0.5;
    sum += count * length * length * length;
  }
  return sum;
}

static double find_longest(const hr2d_hierarchy *h) {
  double max = 0;
  for (size_t k = 0; k < h->elements; k++)
    if (divides(h->scene, &h->element[k])) max = fmax(max, h->element[k].length);
  return max;
}

hr2d_status hr2di_long_leaves_halve(hr2d_hierarchy *h, unsigned times, uint64_t max_elements,
                                    hr2di_watch *watch) {
  double longest = find_longest(h);
  const double enough = sum_parts(h, longest, watch) * pow(LEFT, times);
  while (!hr2di_watch_status(watch) && sum_parts(h, longest, watch) > enough) longest *= STEP;
  for (uint32_t k = 0; k < h->elements; k++) {
    if (hr2di_watch_work(watch, 1)) return hr2di_watch_status(watch);
    if (!divides(h->scene, &h->element[k]) || h->element[k].length <= longest) continue;
    if (!hr2di_element_divisible(h, k)) continue;
    if (max_elements && h->elements + 2 > max_elements) return HR2D_EMAX_ELEMENTS;
    const hr2d_status status = hr2di_hierarchy_reserve(h);
    if (status) return status;
    hr2di_element_halve(h, k);
  }
  return HR2D_OK;
}
