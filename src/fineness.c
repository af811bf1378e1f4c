/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With ellipses of at least m about the elements, ρ* = m + √(m²−1), averages converge like
   ρ*^−2p but for what links between elements that are not leaves drop, and radiosity after a
   gather at a rate between that and ρ*^−p: 1.85 and 1.5 are cautious. */
#include "fineness.h"

#include <math.h>

#include "scene-impl.h"

/* So that B at single points is good to the error of averages, too, away from corners. */
#define SPARE 0.25

static double digits_per_order(const hr2di_survey *survey, hr2d_norm norm) {
  const double m = survey->ellipse, rate = log(m + sqrt(m * m - 1));
  return norm == HR2D_NORM_SUP ? 1.5 * rate : 1.85 * rate;
}

hr2d_status hr2di_survey_scene(const hr2d_scene *scene, hr2di_survey *survey) {
  const hr2di_grading grading = {.target = 0.1, .order = 2};
  hr2d_hierarchy *h = NULL;
  hr2d_status status = hr2d_hierarchy_create(scene, &h);
  if (!status) status = hr2di_grade(h, &grading, survey);
  hr2d_hierarchy_destroy(h);
  return status;
}

/* In narrow corners with much reflection light goes to and fro often, and errors with it: γ² is
   what that asks for in excess, from measurements at 10° to 150° and ρ up to 0.999. */
hr2di_fineness hr2di_fineness_for(const hr2d_scene *scene, const hr2di_survey *survey,
                                  double aim, hr2d_norm norm) {
  const double error = SPARE * aim * fmax(survey->exponent * survey->exponent, 1e-3);
  const double order = ceil(log(1 / error) / digits_per_order(survey, norm));
  const double kink = norm == HR2D_NORM_SUP ? aim * aim : aim;
  const int hidden = scene->effect[HR2D_EFFECT_OCCLUSION].called_for ||
                     scene->effect[HR2D_EFFECT_FACING].called_for;
  return (hr2di_fineness){.order = (unsigned)fmin(fmax(order, 2), HR2D_MAX_ORDER - 2),
                          .target = fmin(error, 1),
                          .norm = norm,
                          .hidden = hidden,
                          .generations = hidden ? hr2di_generations_for(kink) : 0};
}

int hr2di_fineness_raise(hr2di_fineness *f, const hr2di_survey *survey, double factor) {
  const double gamma = survey->exponent;
  const double slope = f->norm == HR2D_NORM_SUP ? fmax(gamma, 0.05) : 1 + 2 * gamma;
  if (f->order + 2 >= HR2D_MAX_ORDER) return -1;
  const double more = fmax(ceil(log(factor) / digits_per_order(survey, f->norm)), 1);
  f->order = (unsigned)fmin(f->order + more, HR2D_MAX_ORDER - 2);
  f->deeper += (unsigned)fmax(ceil(log2(factor) / slope), 1);
  if (f->generations < 2 && f->hidden) f->generations++;
  return 0;
}
