/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Importance: what the radiosity of each patch does to the average of one. */
#ifndef HR2D_SRC_ACCURACY_IMPORTANCE_H
#define HR2D_SRC_ACCURACY_IMPORTANCE_H

#include "accuracy/graded-solve.h"

/* weight_k = ∫_k ψ B / B̄, the largest over the bands: a relative error ε of B on patch k that
   is not made good elsewhere changes the average B̄ of `patch` by no more than ε·weight_k of it.
   From a coarse solve; HR2D_OK, or a status with a reason in `message`. */
hr2d_status hr2di_importance(const hr2d_scene *scene, size_t patch, const hr2d_target *target,
                             double *weight, hr2di_message *message);

#endif
