/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/first-guess.h"

#include <math.h>

#include "base/neumaier-sum.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/gas-light.h"

/* y = (B − E)/√ρ of a guess of B; less √ρ c in balanced components. */
static void start_from(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  for (size_t k = 0; k < s->field; k++)
    if (s->root_rho[k] > 0) s->y[k] = (s->radiosity[k] - s->source[k]) / s->root_rho[k];
  hr2di_equation_balance(s);
  for (size_t k = 0; k < t->leaves && s->balance.count > 0; k++)
    for (size_t b = 0; b < t->bands; b++) {
      const size_t at = k * t->width + b;
      s->y[at] -= s->root_rho[at] * hr2di_balance_at(&s->balance, t, k, b);
    }
  hr2di_equation_set_panes_unknown(s, s->radiosity);
}

/* From a former solution, which may have another order and older leaves. */
static hr2d_status warm_start(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  hr2d_status status = hr2di_solution_restrict(s->options.start, t->hierarchy, t->leaf,
                                               t->leaves, t->order, s->radiosity, t->watch);
  if (!status) status = hr2di_watch_work(t->watch, s->field / 4);
  if (status) return status;
  for (size_t k = 0; k < s->field; k++)
    s->radiosity[k] = ldexp(s->radiosity[k], -s->exponent[k % t->bands]);
  start_from(s);
  return HR2D_OK;
}

/* In gas of a given temperature, from the level that balances what comes in, ∫Q + ∫S, with
   what is absorbed, ∫(1−ρ) + ∫m.  A scene of one temperature is solved by that, to the last
   digits: iterations would end as soon as their tolerance allows. */
static hr2d_status level_start(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  const double *lost_to_gas = hr2di_gas_light_lost(t);
  for (size_t b = 0; b < t->bands; b++) {
    hr2di_sum in = {0, 0}, lost = {0, 0};
    for (size_t k = 0; k < t->leaves; k++) {
      const size_t patch = t->hierarchy->element[t->leaf[k]].patch, at = k * t->width + b;
      const double area = hr2di_gas_light_area(t, k);
      hr2di_sum_add(&in, area * (s->source[at] + (s->outside ? s->outside[at] : 0)));
      hr2di_sum_add(&lost, area * (hr2di_scene_absorptance(t->scene, patch, b) +
                                   lost_to_gas[k * t->gas_order]));
    }
    const double level = hr2di_sum_total(&in) / hr2di_sum_total(&lost);
    for (size_t k = 0; k < t->leaves * t->order; k++)
      s->radiosity[k * t->bands + b] = k % t->order == 0 && isfinite(level) ? level : 0;
  }
  start_from(s);
  return hr2di_watch_work(t->watch, s->field);
}

hr2d_status hr2di_first_guess(hr2di_equation *s) {
  if (s->options.start) return warm_start(s);
  return hr2di_gas_light_lost(&s->transport) ? level_start(s) : HR2D_OK;
}
