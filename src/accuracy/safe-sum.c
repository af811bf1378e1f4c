/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "accuracy/safe-sum.h"

#include <math.h>

#include "accuracy/importance.h"

/* Averages sum up what residuals do everywhere, with signs, and may be small by chance. With
   the importance Z of all averages together, Z = s + KρZ, the sum Σ A |⟨r,Z⟩| over leaves has
   no signs. For averages of B, s is 1/(A B̄) on each patch; Y = ρZ is the radiosity of a source
   ρs. For those of H, s is K of 1/(A H̄); Y = 1/(A H̄) + ρZ is the radiosity of a source 1/(A H̄),
   and Z is KY. */
hr2d_status hr2di_safe_sum(hr2di_estimator *e, int irradiance) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  double min = HUGE_VAL, max = 0;
  for (size_t k = 0; k < eq->field; k++) eq->source[k] = 0;
  for (size_t leaf = 0; leaf < t->leaves; leaf++)
    for (size_t b = 0; b < t->bands; b++) {
      const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
      const double least = hr2di_estimator_least(e, irradiance, patch, b);
      if (!(least > 0)) continue;
      min = fmin(min, least);
      max = fmax(max, least);
      if (hr2di_is_important(e->target, patch))
        eq->source[leaf * t->width + b] = (irradiance ? 1 : hr2di_estimator_rho(e, leaf, b)) /
                                          least / t->hierarchy->element[patch].length;
    }
  /* The norm of a solve has the largest ones: dark patches. */
  const hr2d_status status =
      hr2di_estimator_solve(e, max > 0 ? fmax(1e-4 * min / max, 1e-14) : 1);
  if (status) return status;
  for (size_t leaf = 0; leaf < t->leaves && !hr2di_estimator_stopped(e); leaf++)
    for (size_t b = 0; b < t->bands; b++) {
      const double rho = hr2di_estimator_rho(e, leaf, b);
      double sum = 0;
      for (size_t l = 0; l < t->order; l++) {
        const size_t k = leaf * t->width + l * t->bands + b;
        const double z = ldexp(eq->irradiance[k], e->exponent_of[b]);
        const double s =
            irradiance || !(rho > 0) ? 0 : ldexp(eq->source[k], e->exponent_of[b]) / rho;
        sum += (z + s) * e->residual[k];
      }
      e->safe[irradiance * t->bands + b] += fabs(sum) * eq->weight[leaf * t->order];
    }
  return HR2D_OK;
}
