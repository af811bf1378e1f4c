/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temperatures of patches of given flux in several bands: where their search begins, and
   whether it ends above 0 K. */
#ifndef HR2D_SRC_SOLVE_HEAT_SCENE_H
#define HR2D_SRC_SOLVE_HEAT_SCENE_H

#include "solve/heat-balance.h"

/* Makes a scene of frozen temperatures with a guess of the temperatures: those of `start`, a
   solution on frozen temperatures of the same scene, or where that is NULL of a bright room.
   HR2D_OK, HR2D_ENOMEM, HR2D_ECALLBACK or the status of the callback. */
hr2d_status hr2di_heat_scene_create(const hr2d_scene *scene, const hr2d_solution *start,
                                    hr2d_progress_fn progress, void *progress_ctx,
                                    hr2d_scene **frozen);

/* A phrase for the failure of the former. */
const char *hr2di_heat_scene_failure(hr2d_status status);

/* Refuses patches that would have to be colder than 0 K by more than roundings.  HR2D_OK, or
   HR2D_ENO_SOLUTION with a message of the links that names the one that lacks most. */
hr2d_status hr2di_heat_scene_check(hr2di_heat_balance *balance);

#endif
