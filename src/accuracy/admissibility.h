/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oracle and the policy of trees that were graded before: a pair is acceptable where the
   kernel is smooth on it, and elements are as they are. */
#ifndef HR2D_SRC_ACCURACY_ADMISSIBILITY_H
#define HR2D_SRC_ACCURACY_ADMISSIBILITY_H

#include <hr2d/oracle.h>
#include <hr2d/policy.h>

/* Context of the oracle; without one every patch has weight 1. */
typedef struct hr2di_admissibility {
  unsigned order;
  double target;
  const double *weight; /* per patch, see graded.h; NULL: 1 */
} hr2di_admissibility;

/* 0 for pairs that are distant, both ways, see each other's fronts wholly and have nothing in
   the way; and for what is too unimportant to ask for that; else 1. */
const hr2d_oracle *hr2di_admissibility_oracle(void);

/* Never divides a leaf: leaves are linked as they are. */
const hr2d_policy *hr2di_admissibility_fixed_leaves(void);

#endif
