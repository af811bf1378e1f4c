/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "independent/point-sweep.h"

#include <check.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

#define QUARTER 1.57079632679489661923132169163975144L

spot sweep_place(const sweep_patches *p, size_t patch, real t) {
  const double *at = p->at[patch];
  const real dx = (real)at[2] - at[0], dy = (real)at[3] - at[1];
  if (t > 0.5L) return (spot){at[2] - (1 - t) * dx, at[3] - (1 - t) * dy};
  return (spot){at[0] + t * dx, at[1] + t * dy};
}

sweep_frame sweep_frame_at(const sweep_patches *p, size_t patch, real t) {
  const double *at = p->at[patch];
  const real dx = (real)at[2] - at[0], dy = (real)at[3] - at[1], length = hypotl(dx, dy);
  return (sweep_frame){patch, sweep_place(p, patch, t), {dx / length, dy / length}};
}

spot sweep_local(const sweep_frame *f, spot place) {
  const real x = place.x - f->origin.x, y = place.y - f->origin.y;
  return (spot){x * f->along.x + y * f->along.y, f->along.x * y - f->along.y * x};
}

real sweep_angle(spot local) {
  return atan2l(local.x, local.y);
}

real sweep_cross(spot p, spot q) {
  return p.x * q.y - p.y * q.x;
}

/* A patch, as far as it is in front of the point. */
typedef struct shade {
  size_t patch;
  spot a, b; /* local */
  real low, high;
} shade;

static real largest(const sweep_patches *p) {
  real max = 0;
  for (size_t k = 0; k < p->count; k++)
    for (int c = 0; c < 4; c++) max = fmaxl(max, fabsl((real)p->at[k][c]));
  return max;
}

/* The direction of a, or of the point where ab meets the horizon. */
static real direction(spot a, spot b) {
  if (a.y > 0) return sweep_angle(a);
  const real at = a.x + (b.x - a.x) * (0 - a.y) / (b.y - a.y);
  return at > 0 ? QUARTER : -QUARTER;
}

/* Heights below the rounding of coordinates are 0: patches along one line, and the wall that
   begins where the patch ends. */
static int make_shade(const sweep_patches *p, const sweep_frame *f, size_t k, real rounding,
                      shade *s) {
  *s = (shade){k, sweep_local(f, sweep_place(p, k, 0)), sweep_local(f, sweep_place(p, k, 1)), 0,
               0};
  if (fabsl(s->a.y) <= rounding) s->a.y = 0;
  if (fabsl(s->b.y) <= rounding) s->b.y = 0;
  if (s->a.y <= 0 && s->b.y <= 0) return 0;
  const real one = direction(s->a, s->b), other = direction(s->b, s->a);
  s->low = fminl(one, other);
  s->high = fmaxl(one, other);
  return 1;
}

static int by_size(const void *left, const void *right) {
  const real l = *(const real *)left, r = *(const real *)right;
  return (l > r) - (l < r);
}

static size_t twin_of(const sweep_patches *p, size_t patch) {
  const double *a = p->at[patch];
  for (size_t k = 0; k < p->count; k++) {
    const double *b = p->at[k];
    if (a[0] == b[2] && a[1] == b[3] && a[2] == b[0] && a[3] == b[1]) return k;
  }
  return SWEEP_BACK;
}

/* The nearest patch in a direction. */
static size_t nearest(const sweep_patches *p, const shade *s, size_t count, real angle) {
  const spot ray = {sinl(angle), cosl(angle)};
  real min = HUGE_VALL;
  size_t seen = SWEEP_SKY;
  for (size_t k = 0; k < count; k++) {
    if (!(s[k].low < angle && angle < s[k].high)) continue;
    const spot d = {s[k].b.x - s[k].a.x, s[k].b.y - s[k].a.y};
    const real facing = sweep_cross(s[k].a, s[k].b);
    const real far = facing / sweep_cross(ray, d);
    if (!(far < min)) continue;
    min = far;
    seen = facing > 0 ? s[k].patch : twin_of(p, s[k].patch);
  }
  return seen;
}

size_t sweep_all(const sweep_patches *p, const sweep_frame *f, sweep_span *span) {
  const real rounding = 16 * LDBL_EPSILON * largest(p);
  shade *s = malloc(p->count * sizeof *s);
  real *angle = malloc((2 * p->count + 2) * sizeof *angle);
  ck_assert(s != NULL && angle != NULL);
  size_t shades = 0, angles = 0, spans = 0;
  angle[angles++] = -QUARTER;
  angle[angles++] = QUARTER;
  for (size_t k = 0; k < p->count; k++)
    if (k != f->patch && make_shade(p, f, k, rounding, &s[shades])) {
      angle[angles++] = s[shades].low;
      angle[angles++] = s[shades++].high;
    }
  qsort(angle, angles, sizeof *angle, by_size);
  for (size_t k = 1; k < angles; k++) {
    const real low = angle[k - 1], high = angle[k];
    if (!(high - low > 4 * LDBL_EPSILON)) continue;
    span[spans++] = (sweep_span){low, high, nearest(p, s, shades, low + (high - low) / 2)};
  }
  free(s);
  free(angle);
  return spans;
}

static real height(spot a, spot b, spot p) {
  return ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / hypotl(b.x - a.x, b.y - a.y);
}

/* Whether a patch crosses the line from x to y by more than a rounding. */
static int is_hidden(const sweep_patches *p, spot x, spot y, real rounding) {
  for (size_t k = 0; k < p->count; k++) {
    const spot a = sweep_place(p, k, 0), b = sweep_place(p, k, 1);
    const real xa = height(x, y, a), xb = height(x, y, b);
    const real ax = height(a, b, x), ay = height(a, b, y);
    if (fminl(xa, xb) < -rounding && fmaxl(xa, xb) > rounding && fminl(ax, ay) < -rounding &&
        fmaxl(ax, ay) > rounding)
      return 1;
  }
  return 0;
}

/* Where the line through v and w meets a patch, if it sees both. */
static int meets(const sweep_patches *p, size_t patch, spot v, spot w, real *t) {
  const spot a = sweep_place(p, patch, 0), b = sweep_place(p, patch, 1);
  const real rounding = 1e-15L * largest(p);
  const real hv = height(a, b, v), hw = height(a, b, w);
  if (!(hv > rounding) || !(hw > rounding) || fabsl(hv - hw) <= rounding) return 0;
  const real part = hv / (hv - hw);
  const spot x = {v.x + part * (w.x - v.x), v.y + part * (w.y - v.y)};
  const real length = hypotl(b.x - a.x, b.y - a.y);
  *t = ((x.x - a.x) * (b.x - a.x) + (x.y - a.y) * (b.y - a.y)) / (length * length);
  if (!(*t > 1e-9L && *t < 1 - 1e-9L)) return 0;
  return !is_hidden(p, x, hv > hw ? v : w, rounding);
}

real *sweep_events(const sweep_patches *p, size_t patch, size_t *count) {
  size_t capacity = 16, found = 2, kept = 1;
  real *at = malloc(capacity * sizeof *at);
  ck_assert_ptr_nonnull(at);
  at[0] = 0, at[1] = 1;
  for (size_t v = 0; v < 2 * p->count; v++)
    for (size_t w = 0; w < v; w++) {
      const spot pv = sweep_place(p, v / 2, v % 2), pw = sweep_place(p, w / 2, w % 2);
      real t;
      if (!meets(p, patch, pv, pw, &t)) continue;
      if (found == capacity) at = realloc(at, (capacity *= 2) * sizeof *at);
      ck_assert_ptr_nonnull(at);
      at[found++] = t;
    }
  /* An end of another patch that stands on this one. */
  for (size_t v = 0; v < 2 * p->count; v++) {
    const spot a = sweep_place(p, patch, 0), b = sweep_place(p, patch, 1);
    const spot pv = sweep_place(p, v / 2, v % 2);
    const real length = hypotl(b.x - a.x, b.y - a.y);
    const real t =
        ((pv.x - a.x) * (b.x - a.x) + (pv.y - a.y) * (b.y - a.y)) / (length * length);
    if (fabsl(height(a, b, pv)) > 1e-15L * largest(p) || !(t > 1e-9L && t < 1 - 1e-9L))
      continue;
    if (found == capacity) at = realloc(at, (capacity *= 2) * sizeof *at);
    ck_assert_ptr_nonnull(at);
    at[found++] = t;
  }
  qsort(at, found, sizeof *at, by_size);
  for (size_t k = 1; k < found; k++)
    if (at[k] - at[kept - 1] > 1e-12L) at[kept++] = at[k];
  at[kept - 1] = 1;
  *count = kept;
  return at;
}

static real distance(spot a, spot b, spot p) {
  const spot d = {b.x - a.x, b.y - a.y}, e = {p.x - a.x, p.y - a.y};
  const real at = (e.x * d.x + e.y * d.y) / (d.x * d.x + d.y * d.y);
  const real inside = fminl(fmaxl(at, 0), 1);
  return hypotl(e.x - inside * d.x, e.y - inside * d.y);
}

/* Two segments that do not cross are nearest at an end of one of them. */
real sweep_clearance(const sweep_patches *p, size_t patch, real from, real to) {
  const spot a = sweep_place(p, patch, from), b = sweep_place(p, patch, to);
  const real touching = 1e-15L * largest(p);
  real min = HUGE_VALL;
  for (size_t k = 0; k < p->count; k++) {
    const spot c = sweep_place(p, k, 0), d = sweep_place(p, k, 1);
    const real far[] = {distance(a, b, c), distance(a, b, d), distance(c, d, a),
                        distance(c, d, b)};
    for (int q = 0; q < 4; q++)
      if (far[q] > touching && (q < 2 || k != patch)) min = fminl(min, far[q]);
  }
  return min;
}
