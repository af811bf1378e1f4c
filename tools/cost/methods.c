/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The methods.  First ε are so coarse that whole patches are linked; ratios halve elements, or
   for the higher orders nearly so: with a given distance the estimate of size2 falls like A²
   and the L¹ error like A³. */
#include <gsl/gsl_math.h>
#include <string.h>

#include "cost/cost.h"

static const cost_method methods[] = {
    {"size", "epsilon", hr2d_oracle_size, 1, 16, 0.5, cost_single},
    {"size2", "epsilon", hr2d_oracle_size2, 1, 256, 0.25, cost_single},
    {"bf", "epsilon", hr2d_oracle_bf, 1, 4, 0.5, cost_progressive},
    {"l1", "epsilon", hr2d_oracle_l1, 1, 0, 0.125, cost_single},
    {"l1-grid", "epsilon", hr2d_oracle_l1_grid, 1, 0, 0.125, cost_single},
    {"multigrid", "epsilon", hr2d_oracle_size, 1, 16, 0.5, cost_progressive},
    {"order-2", "epsilon", hr2d_oracle_size, 2, 16, M_SQRT1_2, cost_single},
    {"order-4", "epsilon", hr2d_oracle_size, 4, 16, M_SQRT1_2, cost_single},
    {"order-8", "epsilon", hr2d_oracle_size, 8, 16, M_SQRT1_2, cost_single},
    {"order-16", "epsilon", hr2d_oracle_size, 16, 16, M_SQRT1_2, cost_single},
    {"auto", "target", NULL, 0, 0.1, 0.1, cost_auto},
    {"auto-solve", "target", NULL, 0, 0.1, 0.1, cost_auto},
    {"dense", "length", NULL, 0, 1, 0.5, cost_dense}};

const cost_method *cost_method_find(const char *text, size_t size) {
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++)
    if (strlen(methods[k].name) == size && !strncmp(methods[k].name, text, size))
      return &methods[k];
  return NULL;
}

const cost_method *cost_method_at(size_t k) {
  return k < sizeof methods / sizeof *methods ? &methods[k] : NULL;
}
