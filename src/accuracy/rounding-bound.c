/* SPDX-License-Identifier: GPL-3.0-or-later */
/* (I − ρK)⁻¹ = Σ(ρK)^k maps nothing positive to anything negative, so it carries a bound of
   roundings as it does light.  Roundings of the level of a closed component are no more than
   that. */
#include "accuracy/rounding-bound.h"

#include <float.h>
#include <math.h>

#include "accuracy/coordinate-rounding.h"

hr2d_status hr2di_rounding_bound(hr2di_estimator *e, int reflects) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  hr2di_estimator_set_most(e, e->kept);
  hr2d_status status = hr2di_coordinates_add(t, e->most, e->off);
  for (size_t k = 0; k < eq->field && !status; k++) {
    const size_t leaf = k / t->width, m = k % t->width;
    const double b =
        m < t->bands ? HR2DI_ESTIMATOR_ROUNDING * hr2di_estimator_most(e, e->rest, leaf, m) : 0;
    eq->source[k] =
        m < t->bands ? hr2di_estimator_rho(e, leaf, m) * e->off[leaf * t->bands + m] + b : 0;
    eq->radiosity[k] = eq->source[k]; /* where nothing reflects */
  }
  if (!status && reflects) status = hr2di_estimator_solve(e, 1e-3);
  for (size_t k = 0; k < eq->field && !status; k++) e->error[k] = eq->radiosity[k];
  if (status) return status;
  hr2di_estimator_averages(e, e->error, e->rounding[0]);
  hr2di_equation_gather(eq, e->error);
  for (size_t leaf = 0; leaf < t->leaves && !hr2di_estimator_stopped(e); leaf++)
    for (size_t b = 0; b < t->bands; b++) {
      const double h = hr2di_estimator_most(e, eq->irradiance, leaf, b) +
                       HR2DI_ESTIMATOR_ROUNDING * e->largest[1][b];
      e->stray[1][b] = fmax(e->stray[1][b], h);
      e->stray[0][b] = fmax(e->stray[0][b], hr2di_estimator_rho(e, leaf, b) * h);
      eq->irradiance[leaf * t->width + b] += e->off[leaf * t->bands + b];
    }
  hr2di_estimator_averages(e, eq->irradiance, e->rounding[1]);
  return HR2D_OK;
}
