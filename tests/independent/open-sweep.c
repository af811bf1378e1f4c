/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "independent/open-sweep.h"

#include <check.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

#define HALF 3.14159265358979323846264338327950288L

static spot end_of(const sweep_patches *p, size_t k, int end, spot x) {
  return (spot){p->at[k][2 * end] - x.x, p->at[k][2 * end + 1] - x.y};
}

static int by_size(const void *left, const void *right) {
  const real l = *(const real *)left, r = *(const real *)right;
  return (l > r) - (l < r);
}

static int is_twin(const double *a, const double *b) {
  return a[0] == b[2] && a[1] == b[3] && a[2] == b[0] && a[3] == b[1];
}

/* A patch that shows its back, unless another one has its front there. */
static size_t behind(const sweep_patches *p, size_t patch) {
  for (size_t k = 0; k < p->count; k++)
    if (is_twin(p->at[patch], p->at[k])) return k;
  return SWEEP_BACK;
}

/* The nearest patch in a direction. */
static size_t nearest(const sweep_patches *p, spot x, real angle) {
  const spot ray = {cosl(angle), sinl(angle)};
  real min = HUGE_VALL;
  size_t seen = SWEEP_SKY;
  for (size_t k = 0; k < p->count; k++) {
    const spot a = end_of(p, k, 0, x), b = end_of(p, k, 1, x), d = {b.x - a.x, b.y - a.y};
    if ((sweep_cross(ray, a) > 0) == (sweep_cross(ray, b) > 0)) continue;
    const real far = sweep_cross(a, d) / sweep_cross(ray, d);
    if (!(far > 0 && far < min)) continue;
    min = far;
    seen = sweep_cross(a, b) > 0 ? k : behind(p, k);
  }
  return seen;
}

size_t open_sweep(const sweep_patches *p, spot x, sweep_span *span) {
  real *angle = malloc((2 * p->count + 2) * sizeof *angle);
  size_t angles = 0, spans = 0;
  ck_assert_ptr_nonnull(angle);
  angle[angles++] = -HALF;
  angle[angles++] = HALF;
  for (size_t k = 0; k < p->count; k++)
    for (int end = 0; end < 2; end++) {
      const spot at = end_of(p, k, end, x);
      angle[angles++] = atan2l(at.y, at.x);
    }
  qsort(angle, angles, sizeof *angle, by_size);
  for (size_t k = 1; k < angles; k++) {
    const real low = angle[k - 1], high = angle[k];
    if (!(high - low > 8 * LDBL_EPSILON)) continue;
    span[spans++] = (sweep_span){low, high, nearest(p, x, low + (high - low) / 2)};
  }
  free(angle);
  return spans;
}

real open_sweep_place(const sweep_patches *p, size_t patch, spot x, real angle) {
  const spot ray = {cosl(angle), sinl(angle)};
  const real a = sweep_cross(ray, end_of(p, patch, 0, x)),
             b = sweep_cross(ray, end_of(p, patch, 1, x));
  return a / (a - b);
}

real open_sweep_clearance(const sweep_patches *p, spot x) {
  real min = HUGE_VALL;
  for (size_t k = 0; k < p->count; k++) {
    const spot a = end_of(p, k, 0, x), b = end_of(p, k, 1, x), d = {b.x - a.x, b.y - a.y};
    const real t = fminl(fmaxl(-(a.x * d.x + a.y * d.y) / (d.x * d.x + d.y * d.y), 0), 1);
    min = fminl(min, hypotl(a.x + t * d.x, a.y + t * d.y));
  }
  return min;
}
