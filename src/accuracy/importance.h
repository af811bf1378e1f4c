/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Importance: how much the radiosity of each patch counts for the average of one patch. */
#ifndef HR2D_SRC_ACCURACY_IMPORTANCE_H
#define HR2D_SRC_ACCURACY_IMPORTANCE_H

#include "accuracy/graded-solve.h"

/* weight_k = ∫_k ψ B / B̄, the largest over the bands: a relative error ε of B on patch k that
   is not compensated elsewhere changes the average B̄ of `patch` by at most ε·weight_k of it.
   The weights are from a coarse solve.  Returns HR2D_OK, or a status with a reason in
   `message`. */
hr2d_status hr2di_importance(const hr2d_scene *scene, size_t patch, const hr2d_target *target,
                             double *weight, hr2di_message *message);

#endif
