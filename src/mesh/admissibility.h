/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Admissibility: the oracle and the policy for trees that are graded already.  A pair is
   acceptable if the kernel is smooth on it; leaves are not divided. */
#ifndef HR2D_SRC_MESH_ADMISSIBILITY_H
#define HR2D_SRC_MESH_ADMISSIBILITY_H

#include <hr2d/oracle.h>
#include <hr2d/policy.h>

/* Its estimate is 0 for pairs that are distant both ways, face each other fully and have no
   walls in the way, and that gas lets be linked; else 1.  Its context is the hierarchy, or
   NULL: there is no gas. */
const hr2d_oracle *hr2di_admissibility_oracle(void);

/* Never divides a leaf: pairs of leaves are linked. */
const hr2d_policy *hr2di_admissibility_fixed_leaves(void);

#endif
