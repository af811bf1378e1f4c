/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With the exchange areas g of gases, a gas k of the heat Q has
     (∫m_k + Σ_l g_kl) E_k = Q_k + ∫m_k B + Σ_l g_kl E_l.
   t->gas_return is the inverse of that for all gases of given heat. */
#include "solve/gas-light.h"

#include <math.h>

#include "base/neumaier-sum.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

double hr2di_gas_light_area(const hr2di_transport *t, size_t leaf) {
  const hr2d_element *e = &t->hierarchy->element[t->leaf[leaf]];
  return e->patch < hr2di_scene_cell(t->scene) ? e->length : 0;
}

const double *hr2di_gas_light_lost(const hr2di_transport *t) {
  return t->gas_return ? t->gas_kept : t->gas;
}

/* m of a gas. */
static const double *part_of(const hr2di_transport *t, size_t gas) {
  return t->gas_of ? t->gas_of + gas * t->leaves * t->gas_order : t->gas;
}

static double exchange(const hr2di_transport *t, size_t gas, size_t other) {
  return t->gas_exchange ? t->gas_exchange[gas * t->scene->gases.count + other] : 0;
}

/* ∫mB */
static double taken(const hr2di_transport *t, size_t gas, size_t band,
                    const double *radiosity) {
  const double *m = part_of(t, gas);
  hr2di_sum sum = {0, 0};
  for (size_t k = 0; k < t->leaves; k++) {
    const double area = hr2di_gas_light_area(t, k);
    for (size_t l = 0; l < t->order; l++)
      hr2di_sum_add(&sum, area * (m[k * t->gas_order + l] *
                                  radiosity[k * t->width + l * t->bands + band]));
  }
  return hr2di_sum_total(&sum);
}

static void add(const hr2di_transport *t, size_t gas, size_t band, double emission,
                double *irradiance) {
  const double *m = part_of(t, gas);
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t l = 0; l < t->order; l++)
      irradiance[k * t->width + l * t->bands + band] += m[k * t->gas_order + l] * emission;
}

/* Q in units of the scene. */
static double heat_of(const hr2di_transport *t, size_t gas, int exponent) {
  return ldexp(hr2di_scene_gas_heat(t->scene, gas) / hr2d_scene_unit(t->scene), -exponent);
}

static double given(const hr2di_transport *t, size_t gas, size_t band, int exponent) {
  return ldexp(hr2di_scene_gas_emission(t->scene, gas, band), -exponent);
}

static int is_free(const hr2di_transport *t, size_t gas) {
  return t->gas_return && hr2di_scene_gas_is_free(t->scene, gas);
}

/* What a gas of given heat has whatever B is: its heat, and what gases of given E_g send it. */
static double got(const hr2di_transport *t, size_t gas, size_t band, int exponent) {
  double sum = heat_of(t, gas, exponent);
  for (size_t k = 0; k < t->scene->gases.count; k++)
    if (!is_free(t, k)) sum += exchange(t, gas, k) * given(t, k, band, exponent);
  return sum;
}

/* E_g of a gas of given heat, if those get what is in the room behind t->gas_return. */
static double found(const hr2di_transport *t, size_t gas) {
  const size_t gases = t->scene->gases.count;
  const double *gets = t->gas_return + gases * gases;
  double sum = 0;
  for (size_t k = 0; k < gases; k++)
    if (is_free(t, k)) sum += t->gas_return[gas * gases + k] * gets[k];
  return sum;
}

/* Sets that room to what they have whatever B is, unless `exponent` is NULL, and what patches
   of this radiosity send them, unless that is NULL. */
static void collect(const hr2di_transport *t, size_t band, const int *exponent,
                    const double *radiosity) {
  double *gets =
      t->gas_return ? t->gas_return + t->scene->gases.count * t->scene->gases.count : NULL;
  for (size_t k = 0; k < t->scene->gases.count && gets; k++) {
    if (!is_free(t, k)) continue;
    gets[k] = exponent ? got(t, k, band, *exponent) : 0;
    if (radiosity) gets[k] += taken(t, k, band, radiosity);
  }
}

void hr2di_gas_light_add(const hr2di_transport *t, const int *exponent, double *irradiance) {
  for (size_t b = 0; b < t->bands; b++) {
    collect(t, b, &exponent[b], NULL);
    for (size_t k = 0; k < t->scene->gases.count; k++)
      add(t, k, b, is_free(t, k) ? found(t, k) : given(t, k, b, exponent[b]), irradiance);
  }
}

void hr2di_gas_light_return(const hr2di_transport *t, const double *radiosity,
                            double *irradiance) {
  for (size_t b = 0; b < t->bands; b++) {
    collect(t, b, NULL, radiosity);
    for (size_t k = 0; k < t->scene->gases.count; k++)
      if (is_free(t, k)) add(t, k, b, found(t, k), irradiance);
  }
}

double hr2di_gas_light_emission(const hr2di_transport *t, size_t gas, size_t band, int exponent,
                                const double *radiosity) {
  if (!is_free(t, gas)) return given(t, gas, band, exponent);
  collect(t, band, &exponent, radiosity);
  return found(t, gas);
}

double hr2di_gas_light_heat(const hr2di_transport *t, size_t gas, size_t band, int exponent,
                            const double *radiosity) {
  const double *m = part_of(t, gas);
  hr2di_sum heat = {0, 0};
  if (is_free(t, gas)) return heat_of(t, gas, exponent);
  const double emission = given(t, gas, band, exponent);
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t l = 0; l < t->order; l++) {
      const double rest =
          (l == 0 ? emission : 0) - radiosity[k * t->width + l * t->bands + band];
      hr2di_sum_add(&heat, hr2di_gas_light_area(t, k) * (m[k * t->gas_order + l] * rest));
    }
  collect(t, band, &exponent, radiosity);
  for (size_t k = 0; k < t->scene->gases.count; k++) {
    const double other = is_free(t, k) ? found(t, k) : given(t, k, band, exponent);
    hr2di_sum_add(&heat, exchange(t, gas, k) * (emission - other));
  }
  return hr2di_sum_total(&heat);
}
