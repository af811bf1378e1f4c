/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss rules of blocks, made when they are asked for first, and how many points distant pairs
   need. */
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "blocks/block.h"
#include "geometry/bernstein-ellipse.h"

/* A kernel that is analytic inside the ellipse ρ has Legendre coefficients like ρ^−k, and a
   rule of n points takes those from 2n − l on for the one of degree l: with order p it errs by
   ρ^−(2n − p + 1).  Pairs that are farther apart than they must be need fewer points for that,
   and one more: G is singular on the ellipse, so that its coefficients are some times ρ^−k. */
static void set_apart(hr2di_integrator *w) {
  const double m = HR2DI_ELLIPSE_DISTANT, order = (double)w->order;
  const double digits = (2 * (double)w->points - order + 1) * log(m + sqrt(m * m - 1));
  for (size_t n = 1; n < w->points; n++) {
    const double rate = 2 * (double)(n - 1) - order + 1;
    w->separation[n - 1] = rate > 0 ? cosh(digits / rate) : HUGE_VAL;
  }
}

hr2d_status hr2di_integrator_points(hr2di_integrator *w, size_t points, int fewer) {
  hr2di_alloc_free(&w->alloc, w->phi);
  const size_t most = points + (w->has_gas ? HR2DI_GAS_POINTS : 0);
  w->points = points;
  w->phi = hr2di_alloc(&w->alloc, most * (most + 1) / 2, w->order * sizeof *w->phi);
  memset(w->tabled, 0, sizeof w->tabled);
  for (size_t n = 0; n + 1 < points; n++) w->separation[n] = HUGE_VAL;
  w->separation[points - 1] = 0;
  if (fewer) set_apart(w);
  return w->phi ? HR2D_OK : HR2D_ENOMEM;
}

const hr2di_rule *hr2di_integrator_rule(hr2di_integrator *w, size_t points) {
  hr2di_rule *rule = &w->rule[points - 1];
  if (!w->made[points - 1]) hr2di_rule_init(rule, points);
  w->made[points - 1] = 1;
  return rule;
}
