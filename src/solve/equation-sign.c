/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a solution sends less than nothing. */
#include <math.h>

#include "hierarchy/hierarchy-impl.h"
#include "scene/relit-scene.h"
#include "solve/equation.h"
#include "solve/gas-light.h"

/* The first patch with a negative flux; as many as there are patches if there is none. */
static size_t find_taker(const hr2d_scene *scene) {
  size_t k = 0;
  while (k < scene->patches && hr2d_scene_emission(scene, k, 0) >= 0) k++;
  return k;
}

/* Refuses a negative average of B, in the only band: only scenes of one band have fluxes. */
static hr2d_status check_averages(hr2di_equation *s, double min) {
  hr2di_transport *t = &s->transport;
  const hr2d_scene *scene = t->scene;
  double high = 0;
  size_t lowest = 0;
  hr2di_transport_pull(t, s->radiosity);
  if (t->failed) return t->failed;
  for (size_t k = 0; k < scene->patches; k++) {
    high = fmax(high, t->up[k * t->width]);
    if (t->up[k * t->width] < t->up[lowest * t->width]) lowest = k;
  }
  const double low = t->up[lowest * t->width];
  if (low >= -min * high && (low >= 0 || high > 0)) return HR2D_OK;
  return hr2di_message_fail(
      &s->links->message, HR2D_ENO_SOLUTION,
      "no solution: %s would send a negative radiosity, %.4g: the negative fluxes of the scene "
      "take away more heat than there is",
      hr2di_patch_label(scene, lowest).text, ldexp(low, s->exponent[0]));
}

/* The roundings of row sums, as a part of the light from outside: what a leaf gets of a
   background that sees it edge-on, or not at all; and of the level of a component, which has
   the light of a sun that is absorbed at once. */
#define ROW_ROUNDING 1e-12

/* The most that comes from outside. */
static double brightest(const hr2di_equation *s, size_t band) {
  const hr2di_transport *t = &s->transport;
  double max = s->background ? s->light[band] : 0;
  for (size_t k = 0; k < t->leaves && s->background && s->outside; k++)
    max = fmax(max, s->outside[k * t->width + band]);
  return max;
}

/* If B = Q + ρKB and neither K nor Q is negative, then B is negative somewhere if and only if
   ΣK^kρ^kQ diverges: with the positive left eigenvector v of the radius λ, (1−λ)vB = vQ.  At an
   order above 1 B may be slightly negative for other reasons.  With a negative flux of a patch
   Q is negative, and the average of B on a patch tells whether so much heat can leave it. */
hr2d_status hr2di_equation_check_sign(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  const double min = t->order > 1 ? 1e-2 : 1e-6;
  const size_t taker = find_taker(t->scene);
  int takes = 0;
  for (size_t k = 0; k < t->scene->gases.count && t->gas; k++) {
    takes |= hr2di_scene_gas_heat(t->scene, k) < 0;
    if (hr2di_gas_light_emission(t, k, 0, s->exponent[0], s->radiosity) < 0)
      return hr2di_message_fail(
          &s->links->message, HR2D_ENO_SOLUTION,
          "no solution: the gas would be colder than 0 K: its negative heat "
          "takes away more than there is");
  }
  if (takes || taker < t->scene->patches) return check_averages(s, min);
  for (size_t b = 0; b < t->bands; b++) {
    double low = 0, high = 0;
    const hr2d_status status = hr2di_watch_work(t->watch, t->leaves / 16);
    if (status) return status;
    for (size_t k = 0; k < t->leaves; k++) {
      low = fmin(low, s->radiosity[k * t->width + b]);
      high = fmax(high, s->radiosity[k * t->width + b]);
    }
    high = fmax(high, ROW_ROUNDING / min * brightest(s, b));
    if (low < -min * high || (low < 0 && high == 0))
      return hr2di_message_fail(
          &s->links->message, HR2D_ENOT_CONVERGED,
          "in band %zu the links reflect more light than falls on them, so that "
          "it grows for ever: closure or finer links are needed",
          hr2di_scene_known_band(t->scene, b));
  }
  return HR2D_OK;
}
