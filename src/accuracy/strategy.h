/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The resolution that a target needs. */
#ifndef HR2D_SRC_ACCURACY_STRATEGY_H
#define HR2D_SRC_ACCURACY_STRATEGY_H

#include "estimate/graded-solve.h"

/* Surveys the corners and ends of a scene, with threads as in options, and keeps what patches
   see in `beam_cache`, unless that is NULL.  Returns HR2D_OK, HR2D_ENOMEM or the status of the
   watch. */
hr2d_status hr2di_strategy_survey(const hr2d_scene *scene, hr2di_beam_cache *beam_cache,
                                  unsigned threads, hr2di_watch *watch, hr2di_survey *survey);

/* Whether lights of patches help: to choose events for a target of averages. */
int hr2di_strategy_wants_lights(const hr2d_scene *scene, const hr2d_target *target);

/* The same for a target that begins without, after its first solve. */
int hr2di_strategy_wants_lights_of(const hr2d_solution *solution, const hr2d_target *target,
                                   const hr2di_resolution *fineness);

/* A first guess at the resolution for an error in the norm of a target; with lights of patches,
   or NULL. */
hr2di_resolution hr2di_strategy_for(const hr2d_scene *scene, const hr2di_survey *survey,
                                    double error, const hr2d_target *target,
                                    const hr2di_primal_dual *lights);

/* What a solve may leave in its residual for an error of averages, the darkest of which are
   `contrast` times the brightest. */
double hr2di_strategy_tolerance(const hr2d_scene *scene, double contrast, double aim);

/* Raises the resolution, so that the error may fall by `factor`.  Returns 0, or -1 if it cannot
   be finer. */
int hr2di_strategy_raise(hr2di_resolution *fineness, const hr2di_survey *survey, double factor);

/* Makes links of clusters alone more accurate, which make `part` of an error that is to be
   `aim`.  Returns 0, or -1 if they cannot be. */
int hr2di_strategy_raise_clusters(hr2di_resolution *fineness, double part, double aim);

#endif
