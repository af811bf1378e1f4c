/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The methods in the order of `method`.  At the first ε whole patches are linked.  Ratios halve
   elements, or for the higher orders nearly so: at a given distance the estimate of size2 falls
   like A², the L¹ error and its bound like A³. */
#include <gsl/gsl_math.h>
#include <math.h>

#include "cost/cost.h"

static const cost_method methods[] = {
    {METHOD_SIZE, "epsilon", hr2d_oracle_size, 1, 16, 0.5, .run = cost_single},
    {METHOD_SIZE2, "epsilon", hr2d_oracle_size2, 1, 256, 0.25, .run = cost_single},
    {METHOD_BF, "epsilon", hr2d_oracle_bf, 1, 4, 0.5, .run = cost_progressive},
    {METHOD_L1, "epsilon", hr2d_oracle_l1, 1, 0, 0.125, .run = cost_single},
    {METHOD_L1_GRID, "epsilon", hr2d_oracle_l1_grid, 1, 0, 0.125, .run = cost_single},
    {METHOD_BOUNDS, "epsilon", hr2d_oracle_bounds, 1, 0, 0.125, .run = cost_single},
    {METHOD_MULTIGRID, "epsilon", hr2d_oracle_size, 1, 16, 0.5, .run = cost_progressive},
    {METHOD_ORDER_2, "epsilon", hr2d_oracle_size, 2, 16, M_SQRT1_2, .run = cost_single},
    {METHOD_ORDER_4, "epsilon", hr2d_oracle_size, 4, 16, M_SQRT1_2, .run = cost_single},
    {METHOD_ORDER_8, "epsilon", hr2d_oracle_size, 8, 16, M_SQRT1_2, .run = cost_single},
    {METHOD_ORDER_16, "epsilon", hr2d_oracle_size, 16, 16, M_SQRT1_2, .run = cost_single},
    {METHOD_AUTO, "target", NULL, 0, 0.1, 0.1, .run = cost_auto},
    {METHOD_AUTO_SOLVE, "target", NULL, 0, 0.1, 0.1, .run = cost_auto},
    {METHOD_FACTORS, "length", NULL, 0, 1, 0.5, .run = cost_factors}};

_Static_assert(sizeof methods / sizeof *methods == METHOD_COUNT, "a method is missing");

/* With three ε while elements are halved: the errors of a single one may be those of a phase.
   100,000 links of each make some four digits, at higher orders all. */
static void add_variants(cost *c) {
  static const method oracles[] = {METHOD_SIZE, METHOD_SIZE2, METHOD_BF, METHOD_L1,
                                   METHOD_BOUNDS};
  static const unsigned orders[] = {1, 2, 4};
  enum { ORACLES = sizeof oracles / sizeof *oracles, ORDERS = 3 };
  _Static_assert(4 * ORACLES * ORDERS <= COST_MOST_METHODS, "there is room for all");
  for (int k = 0; k < 4 * ORACLES * ORDERS; k++) {
    cost_method *m = &c->methods[c->method_count++];
    *m = methods[oracles[k / (4 * ORDERS)]];
    m->policy = k / (2 * ORDERS) % 2 ? hr2d_policy_modified : hr2d_policy_original;
    m->order = orders[k / 2 % ORDERS];
    m->is_open = k % 2;
    m->ratio = cbrt(m->ratio);
    m->most_links = 100000;
  }
}

void cost_choose_methods(cost *c) {
  if (c->options->exponents) {
    add_variants(c);
    return;
  }
  for (size_t k = 0; k < METHOD_COUNT; k++)
    if (c->options->methods >> k & 1) c->methods[c->method_count++] = methods[k];
}

const char *cost_method_variant(const cost_method *m) {
  if (!m->oracle) return "";
  return m->policy ? m->policy()->name : hr2d_policy_original()->name;
}

const char *cost_method_closure(const cost *c, const cost_method *m) {
  if (!m->oracle) return "";
  return m->is_open || c->options->no_closure ? "off" : "on";
}
