/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Importance: how much the radiosity of each patch counts for the averages of some. */
#ifndef HR2D_SRC_ESTIMATE_IMPORTANCE_H
#define HR2D_SRC_ESTIMATE_IMPORTANCE_H

#include "estimate/graded-solve.h"

/* Whether the averages of a patch count for a target of hr2di_target_init(); O(log n). */
int hr2di_is_important(const hr2d_target *target, size_t patch);

/* The least average of H that counts and is larger than 0, relative to the largest of its band.
 */
double hr2di_least_irradiance(const hr2d_solution *solution, const hr2d_target *target);

/* Sets `lights` from a coarse solve: B of elements and ρψ, with ψ = Σ ψ_i/a_i over the
   important averages a_i of B and of H, which count as no less than the floor of the target.
   `survey` receives what the elements of that solve say of the scene; it is unchanged where
   they cannot be made.  Keeps what patches see in `beam_cache`, unless that is NULL.  Returns
   HR2D_OK, or a status with a reason in `message`.  Lights may be missing with HR2D_OK, if a
   budget does not suffice for them; they are to be cleared in any case. */
hr2d_status hr2di_importance(const hr2d_scene *scene, const hr2d_target *target,
                             hr2di_beam_cache *beam_cache, hr2di_primal_dual *lights,
                             hr2di_survey *survey, hr2di_message *message);
void hr2di_primal_dual_clear(hr2di_primal_dual *lights, const hr2d_scene *scene);

#endif
