/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/emissivity.h"

#include <math.h>

#include "base/black-body.h"
#include "scene/scene-impl.h"

/* A light as it was described. */
static hr2d_thermal thermal_of(const hr2d_scene *scene, size_t patch) {
  const hr2di_light *light = scene->patch[patch].light;
  const double *value = light->value + light->emission_bands + light->reflectance_bands;
  const size_t tables = light->kelvins ? light->kelvins : 1;
  hr2d_thermal t = HR2D_THERMAL_INIT;
  t.emissivity = value;
  t.emissivity_bands = light->emissivity_bands;
  t.kelvin = value + tables * light->emissivity_bands;
  t.kelvins = light->kelvins;
  t.emissivity_of = light->emissivity_of;
  t.emissivity_ctx = light->emissivity_ctx;
  return t;
}

/* Straight lines between the entries, and the last ones beyond them. */
static double look_up(const hr2d_thermal *t, size_t band, double kelvin) {
  const size_t bands = t->emissivity_bands, column = bands > 1 ? band : 0;
  size_t low = 0, high = t->kelvins - 1;
  if (!(kelvin > t->kelvin[low])) return t->emissivity[column];
  if (kelvin >= t->kelvin[high]) return t->emissivity[high * bands + column];
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    *(kelvin < t->kelvin[middle] ? &high : &low) = middle;
  }
  const double part = (kelvin - t->kelvin[low]) / (t->kelvin[high] - t->kelvin[low]);
  return (1 - part) * t->emissivity[low * bands + column] +
         part * t->emissivity[high * bands + column];
}

double hr2di_emissivity_of(const hr2d_thermal *t, size_t band, double kelvin) {
  if (t->emissivity_of) return t->emissivity_of(t->emissivity_ctx, kelvin, band);
  if (t->kelvins) return look_up(t, band, kelvin);
  return t->emissivity_bands ? t->emissivity[t->emissivity_bands > 1 ? band : 0] : 1;
}

int hr2di_emissivity_depends(const hr2d_scene *scene, size_t patch) {
  const hr2di_light *light = scene->patch[patch].light;
  return light->kelvins || light->emissivity_of;
}

double hr2d_scene_emissivity_at(const hr2d_scene *scene, size_t patch, size_t band,
                                double kelvin) {
  if (!hr2di_scene_has(scene, patch) || !hr2di_scene_has_band(scene, band)) return NAN;
  if (scene->patch[patch].light->heat == HR2D_HEAT_NONE) return NAN;
  const hr2d_thermal t = thermal_of(scene, patch);
  return hr2di_emissivity_of(&t, band % (hr2di_scene_spectral_bands(scene)), kelvin);
}

double hr2d_scene_emissivity(const hr2d_scene *scene, size_t patch, size_t band) {
  if (!hr2di_scene_has(scene, patch) || !hr2di_scene_has_band(scene, band)) return NAN;
  return hr2di_emissivity_depends(scene, patch)
             ? NAN
             : hr2d_scene_emissivity_at(scene, patch, band, 0);
}

double hr2di_emissivity_slope(const hr2d_scene *scene, size_t patch, size_t band,
                              double kelvin) {
  const double part = 1e-4;
  return (hr2d_scene_emissivity_at(scene, patch, band, kelvin * (1 + part)) -
          hr2d_scene_emissivity_at(scene, patch, band, kelvin * (1 - part))) /
         (2 * part);
}

/* ε(T)(σT⁴ − H) − q, which rises with T unless ε falls fast. */
static double surplus(const hr2d_scene *scene, size_t patch, double irradiance, double radiance,
                      double flux) {
  const double e = hr2d_scene_emissivity_at(scene, patch, 0, hr2di_black_body_kelvin(radiance));
  return e > 0 && e <= 1 ? e * (radiance - irradiance) - flux : NAN;
}

/* By halving, from an interval at whose ends the surplus has different signs. */
double hr2di_emissivity_radiance(const hr2d_scene *scene, size_t patch, double irradiance) {
  const double h = irradiance, min = surplus(scene, patch, h, 0, 0);
  const double flux = scene->patch[patch].light->given;
  if (!hr2di_emissivity_depends(scene, patch))
    return h + flux / hr2d_scene_emissivity(scene, patch, 0);
  if (isnan(min) || !(min <= flux)) return flux - min;
  double low = 0, high = fmax(h, fabs(flux)), over = surplus(scene, patch, h, high, flux);
  while (over < 0 && high < 1e300) {
    low = high;
    high *= 2;
    over = surplus(scene, patch, h, high, flux);
  }
  for (double middle = 0.5 * (low + high); low < middle && middle < high && !isnan(over);
       middle = 0.5 * (low + high)) {
    over = surplus(scene, patch, h, middle, flux);
    *(over < 0 ? &low : &high) = middle;
  }
  return isnan(over) ? NAN : high;
}

double hr2di_shield_radiance(const hr2d_scene *scene, size_t patch, double irradiance,
                             double other) {
  const double e = hr2d_scene_emissivity(scene, patch, 0),
               of_other = hr2d_scene_emissivity(scene, hr2di_scene_other_side(scene, patch), 0);
  return (e * irradiance + of_other * other) / (e + of_other);
}

double hr2d_scene_temperature(const hr2d_scene *scene, size_t patch, double irradiance) {
  if (!hr2di_scene_has(scene, patch)) return NAN;
  const hr2di_light *light = scene->patch[patch].light;
  if (light->heat != HR2D_HEAT_FLUX || scene->bands > 1)
    return light->heat == HR2D_HEAT_TEMPERATURE ? light->given : NAN;
  const double radiance = hr2di_emissivity_radiance(scene, patch, irradiance);
  return radiance >= 0 ? hr2di_black_body_kelvin(radiance) : NAN;
}
