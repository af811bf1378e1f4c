/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hr2d_solve_to(): where temperatures couple the bands, they are found first. */
#include "accuracy/heat-solve.h"
#include "accuracy/solve-to.h"
#include "scene/frozen-temperatures.h"

hr2d_status hr2d_solve_to(const hr2d_scene *scene, const hr2d_target *target,
                          hr2d_solution **solution, hr2d_account *account) {
  if (solution) *solution = NULL;
  if (!scene || !solution) return HR2D_EINVAL;
  *solution = NULL;
  if (account) *account = (hr2d_account){0};
  if (!scene->committed) return HR2D_ESTATE;
  return hr2di_scene_is_unsettled(scene) ? hr2di_heat_solve(scene, target, solution, account)
                                         : hr2di_solve_to(scene, target, solution, account);
}
