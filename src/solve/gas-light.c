/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/gas-light.h"

#include <math.h>

#include "base/neumaier-sum.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

double hr2di_gas_light_area(const hr2di_transport *t, size_t leaf) {
  const hr2d_element *e = &t->hierarchy->element[t->leaf[leaf]];
  return e->patch < hr2di_scene_cell(t->scene) ? e->length : 0;
}

/* ∫mB */
static double taken(const hr2di_transport *t, size_t band, const double *radiosity) {
  hr2di_sum sum = {0, 0};
  for (size_t k = 0; k < t->leaves; k++) {
    const double area = hr2di_gas_light_area(t, k);
    for (size_t l = 0; l < t->order; l++)
      hr2di_sum_add(&sum, area * (t->gas[k * t->gas_order + l] *
                                  radiosity[k * t->width + l * t->bands + band]));
  }
  return hr2di_sum_total(&sum);
}

static void add(const hr2di_transport *t, size_t band, double emission, double *irradiance) {
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t l = 0; l < t->order; l++)
      irradiance[k * t->width + l * t->bands + band] += t->gas[k * t->gas_order + l] * emission;
}

/* Q in units of the scene. */
static double heat_of(const hr2di_transport *t, int exponent) {
  return ldexp(hr2di_scene_gas_heat(t->scene) / hr2d_scene_unit(t->scene), -exponent);
}

void hr2di_gas_light_add(const hr2di_transport *t, const int *exponent, double *irradiance) {
  for (size_t b = 0; b < t->bands; b++)
    add(t, b,
        t->gas_all > 0 ? heat_of(t, exponent[b]) / t->gas_all
                       : ldexp(hr2di_scene_gas_emission(t->scene, b), -exponent[b]),
        irradiance);
}

void hr2di_gas_light_return(const hr2di_transport *t, const double *radiosity,
                            double *irradiance) {
  for (size_t b = 0; b < t->bands; b++)
    add(t, b, taken(t, b, radiosity) / t->gas_all, irradiance);
}

double hr2di_gas_light_emission(const hr2di_transport *t, size_t band, int exponent,
                                const double *radiosity) {
  if (t->gas_all > 0) return (heat_of(t, exponent) + taken(t, band, radiosity)) / t->gas_all;
  return ldexp(hr2di_scene_gas_emission(t->scene, band), -exponent);
}

double hr2di_gas_light_heat(const hr2di_transport *t, size_t band, int exponent,
                            const double *radiosity) {
  hr2di_sum heat = {0, 0};
  if (t->gas_all > 0) return heat_of(t, exponent);
  const double emission = hr2di_gas_light_emission(t, band, exponent, radiosity);
  for (size_t k = 0; k < t->leaves * t->order; k++) {
    const double area = hr2di_gas_light_area(t, k / t->order);
    const double rest = (k % t->order == 0 ? emission : 0) - radiosity[k * t->bands + band];
    hr2di_sum_add(&heat, area * (t->gas[k] * rest));
  }
  return hr2di_sum_total(&heat);
}
