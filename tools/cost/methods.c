/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The methods in the order of `method`.  At the first ε whole patches are linked.  Ratios halve
   elements, or for the higher orders nearly so: at a given distance the estimate of size2 falls
   like A², the L¹ error and its bound like A³. */
#include <gsl/gsl_math.h>

#include "cost/cost.h"

static const cost_method methods[] = {
    {METHOD_SIZE, "epsilon", hr2d_oracle_size, 1, 16, 0.5, cost_single},
    {METHOD_SIZE2, "epsilon", hr2d_oracle_size2, 1, 256, 0.25, cost_single},
    {METHOD_BF, "epsilon", hr2d_oracle_bf, 1, 4, 0.5, cost_progressive},
    {METHOD_L1, "epsilon", hr2d_oracle_l1, 1, 0, 0.125, cost_single},
    {METHOD_L1_GRID, "epsilon", hr2d_oracle_l1_grid, 1, 0, 0.125, cost_single},
    {METHOD_BOUNDS, "epsilon", hr2d_oracle_bounds, 1, 0, 0.125, cost_single},
    {METHOD_MULTIGRID, "epsilon", hr2d_oracle_size, 1, 16, 0.5, cost_progressive},
    {METHOD_ORDER_2, "epsilon", hr2d_oracle_size, 2, 16, M_SQRT1_2, cost_single},
    {METHOD_ORDER_4, "epsilon", hr2d_oracle_size, 4, 16, M_SQRT1_2, cost_single},
    {METHOD_ORDER_8, "epsilon", hr2d_oracle_size, 8, 16, M_SQRT1_2, cost_single},
    {METHOD_ORDER_16, "epsilon", hr2d_oracle_size, 16, 16, M_SQRT1_2, cost_single},
    {METHOD_AUTO, "target", NULL, 0, 0.1, 0.1, cost_auto},
    {METHOD_AUTO_SOLVE, "target", NULL, 0, 0.1, 0.1, cost_auto},
    {METHOD_FACTORS, "length", NULL, 0, 1, 0.5, cost_factors}};

_Static_assert(sizeof methods / sizeof *methods == METHOD_COUNT, "a method is missing");

const cost_method *cost_method_at(size_t k) {
  return k < METHOD_COUNT ? &methods[k] : NULL;
}
