/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps try what makes formulas of the plane lose digits: neighbours by ulps, other
   exponents, equal numbers, points that lie nearly on a line with two others. */
#include "support/hill-climb.h"

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/support.h"

/* Puts a point near the line through two others: on it, at their middle, or at one of them. */
static void align(size_t points, randoms *r, double *x) {
  const int n = (int)points;
  double *p = x + 2 * random_below(r, n);
  const double *q = x + 2 * random_below(r, n), *s = x + 2 * random_below(r, n);
  static const double places[] = {0, 0.5, -1, 2};
  const int k = random_below(r, 8);
  const double t = k < 4 ? places[k] : random_between(r, -2, 3);
  const double px = q[0] + t * (s[0] - q[0]), py = q[1] + t * (s[1] - q[1]);
  p[0] = px;
  p[1] = py;
}

static void change_one(const hill *h, randoms *r, double *x) {
  const int n = (int)h->count;
  double *at = &x[random_below(r, n)];
  const double other = x[random_below(r, n)];
  switch (random_below(r, 8)) {
  case 0:
    *at = other;
    break;
  case 1:
    *at = ldexp(*at, random_below(r, 9) - 4);
    break;
  case 2:
    *at = ldexp(*at, random_below(r, 201) - 100);
    break;
  case 3:
    *at += (*at - other) * random_power(r, -16, -0.5);
    break;
  case 4:
    *at += *at * random_power(r, -16, -0.5);
    break;
  default:
    *at = random_nudge(r, *at, 4);
  }
}

static void move(const hill *h, randoms *r, double *x) {
  for (int moves = 1 + random_below(r, 3); moves > 0; moves--) {
    double y[HILL_MOST];
    int finite = 1;
    memcpy(y, x, sizeof y);
    if (h->points > 2 && random_below(r, 8) == 0)
      align(h->points, r, y);
    else
      change_one(h, r, y);
    for (size_t k = 0; k < h->count; k++) finite &= isfinite(y[k]) != 0;
    if (finite) memcpy(x, y, sizeof y);
  }
}

static double look(const hill *h, const double *x, summit *top) {
  const double error = h->error(h->ctx, x);
  ck_assert(!isnan(error));
  if (error < 0) return error;
  top->tried++;
  if (error >= top->error) {
    top->error = error;
    memcpy(top->x, x, sizeof top->x);
  }
  return error;
}

static void climb(const hill *h, randoms *r, int steps, summit *top) {
  enum { STARTS = 8 };
  double x[HILL_MOST] = {0}, y[HILL_MOST] = {0}, best = -INFINITY;
  for (int k = 0; k < STARTS; k++) {
    h->draw(h->ctx, r, y);
    const double error = look(h, y, top);
    if (error <= best) continue;
    best = error;
    memcpy(x, y, sizeof x);
  }
  for (int k = 0; k < steps; k++) {
    memcpy(y, x, sizeof y);
    move(h, r, y);
    const double error = look(h, y, top);
    if (error < best) continue;
    best = error;
    memcpy(x, y, sizeof x);
  }
}

/* Without the multiplier. */
static summit search(const hill *h, hill_effort effort, int stream) {
  summit top = {0};
  ck_assert_uint_le(h->count, HILL_MOST);
  ck_assert_uint_le(2 * h->points, h->count);
  randoms r = randoms_stream(test_seed(), 7000 + stream);
  for (int k = 0; k < effort.draws; k++) {
    double x[HILL_MOST] = {0};
    h->draw(h->ctx, &r, x);
    look(h, x, &top);
  }
  for (int k = 0; k < effort.climbs; k++) climb(h, &r, effort.steps, &top);
  return top;
}

summit hill_climb(const hill *h, hill_effort effort, int stream) {
  effort.draws = test_count(effort.draws);
  if (effort.climbs) effort.climbs = test_count(effort.climbs);
  return search(h, effort, stream);
}

void hill_assert(const hill *h, const summit *top, double bound) {
  printf("%s: worst of %ld inputs (seed %lu): error %.3g at", h->name, top->tried, test_seed(),
         top->error);
  for (size_t k = 0; k < h->count; k++) printf(" %a", top->x[k]);
  printf("\n");
  fflush(stdout);
  ck_assert_int_gt(top->tried, 0);
  ck_assert_msg(top->error <= bound, "%s: %g is above %g", h->name, top->error, bound);
}

void hill_hold(const hill *h, hill_effort effort, int stream, double bound) {
  const summit top = hill_climb(h, effort, stream);
  hill_assert(h, &top, bound);
}

void hill_exceed(const hill *h, hill_effort effort, int stream, double min) {
  const summit top = search(h, effort, stream);
  ck_assert_msg(top.error >= min, "%s: %g is below %g", h->name, top.error, min);
}
