/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches of given temperature or net flux.

   Given T: ρ = 1 − ε and E = (1 − ρ)σT⁴, per band its part of it.  The factor is 1 − ρ and not
   ε: the equation absorbs 1 − ρ of H, and a room of one temperature is in equilibrium only if
   the patch emits with the same factor.  1 − ρ is exact for ρ ≥ ½, and has one rounding else.
   Given q: B = H + q, which is E = q with ρ = 1.
   Of a shield E = 0, and ρ and τ follow from ε of both sides, see scene.c.
   Of a pane with T: ρ = 1 − ε − τ, and E = (1 − (ρ + τ))σT⁴ for the same reason. */
#include <float.h>
#include <hr2d/thermal.h>
#include <math.h>
#include <stdint.h>

#include "base/alloc.h"
#include "base/black-body.h"
#include "base/sized-struct.h"
#include "scene/emissivity.h"
#include "scene/patch-light.h"
#include "scene/scene-impl.h"

static hr2d_status refuse(hr2d_scene *scene, hr2d_status status, const hr2d_patch *patch,
                          const char *why) {
  const hr2di_label label = hr2di_new_patch_label(scene, patch->name);
  return hr2di_message_fail(&scene->message, status, "%s: %s", label.text, why);
}

/* A power is that of a flux, which is known once all patches are that share it. */
static int is_flux(const hr2d_thermal *t) {
  return t->given == HR2D_HEAT_FLUX || t->given == HR2D_HEAT_POWER;
}

static hr2d_status check_value(hr2d_scene *scene, const hr2d_patch *patch,
                               const hr2d_thermal *t) {
  if (t->given != HR2D_HEAT_TEMPERATURE && !is_flux(t) && t->given != HR2D_HEAT_SHIELD)
    return refuse(scene, HR2D_EINVAL, patch, "neither a temperature nor a flux is given");
  if (t->given == HR2D_HEAT_SHIELD && t->value != 0)
    return refuse(scene, HR2D_EINVAL, patch, "a shield has no value: its net heat is 0");
  if (t->given == HR2D_HEAT_SHIELD && (t->kelvins || t->emissivity_of))
    return refuse(scene, HR2D_EUNSUPPORTED, patch,
                  "the emissivity of a shield must not depend on temperature");
  if (patch->emission_bands || patch->reflectance_bands)
    return refuse(scene, HR2D_EINVAL, patch,
                  "emission and reflectance follow from what is given, and cannot be set");
  if (!isfinite(t->value))
    return refuse(scene, HR2D_ESCENE, patch,
                  t->given == HR2D_HEAT_POWER  ? "heat is not finite"
                  : t->given == HR2D_HEAT_FLUX ? "flux is not finite"
                                               : "temperature is not finite");
  if (t->given != HR2D_HEAT_TEMPERATURE) return HR2D_OK;
  if (t->value < 0)
    return refuse(scene, HR2D_ESCENE, patch,
                  "temperature is negative: it is in kelvin, which is °C + 273.15");
  if (!isfinite(hr2d_black_body(t->value)))
    return refuse(scene, HR2D_ESCENE, patch, "temperature is too large for a double");
  return HR2D_OK;
}

/* Weights are polynomials, which do not hold at all temperatures. */
static hr2d_status check_weights(hr2d_scene *scene, const hr2d_patch *patch,
                                 const hr2d_thermal *t) {
  size_t band;
  if (!scene->spectrum.weights) return HR2D_OK;
  if (t->given != HR2D_HEAT_TEMPERATURE)
    return refuse(scene, HR2D_EUNSUPPORTED, patch,
                  "the scene has weights of bands, which need a temperature that is given");
  if (hr2di_spectrum_knows(&scene->spectrum, t->value, &band)) return HR2D_OK;
  return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                            "%s: at %.9g K the weight of band %zu is %.6g, not between 0 and 1",
                            hr2di_new_patch_label(scene, patch->name).text, t->value, band,
                            hr2di_scene_band_part(scene, t->value, band));
}

/* Temperatures of a table. */
static hr2d_status check_kelvins(hr2d_scene *scene, const hr2d_patch *patch,
                                 const hr2d_thermal *t) {
  if (!t->kelvins) return HR2D_OK;
  if (!t->kelvin || !t->emissivity_bands)
    return refuse(scene, HR2D_EINVAL, patch,
                  "emissivity: a table has temperatures, and values for each");
  if (t->kelvins > SIZE_MAX / 8 / t->emissivity_bands)
    return refuse(scene, HR2D_ENOMEM, patch, "emissivity: the table is too large");
  for (size_t k = 0; k < t->kelvins; k++)
    if (!(t->kelvin[k] >= 0 && isfinite(t->kelvin[k]) &&
          (!k || t->kelvin[k] > t->kelvin[k - 1])))
      return refuse(scene, HR2D_ESCENE, patch,
                    "emissivity: the temperatures of a table must rise, from 0 K or more");
  return HR2D_OK;
}

/* The numbers of values. */
static hr2d_status check_counts(hr2d_scene *scene, const hr2d_patch *patch,
                                const hr2d_thermal *t) {
  if (t->emissivity_bands && !t->emissivity)
    return refuse(scene, HR2D_EINVAL, patch, "emissivity: a number of bands but no values");
  if (t->emissivity_of && (t->emissivity_bands || t->kelvins))
    return refuse(scene, HR2D_EINVAL, patch, "emissivity: both values and a function");
  if (t->emissivity_bands > 1 && t->emissivity_bands != hr2di_scene_spectral_bands(scene))
    return refuse(
        scene, HR2D_ESCENE, patch,
        hr2di_scene_spectral_bands(scene) > 1
            ? "emissivity: wavelengths or weights of the scene make another number of bands"
            : "emissivity has several bands, and the scene has no wavelengths or weights");
  return check_kelvins(scene, patch, t);
}

static hr2d_status check_emissivity(hr2d_scene *scene, const hr2d_patch *patch,
                                    const hr2d_thermal *t) {
  const hr2d_status status = check_counts(scene, patch, t);
  if (status) return status;
  for (size_t k = 0; k < t->emissivity_bands * (t->kelvins ? t->kelvins : 1); k++) {
    const double e = t->emissivity[k];
    if (!(e >= 0 && e <= 1))
      return refuse(scene, HR2D_ESCENE, patch, "emissivity is not between 0 and 1");
    if (e == 0 && t->given != HR2D_HEAT_TEMPERATURE)
      return refuse(scene, HR2D_ESCENE, patch,
                    is_flux(t)
                        ? "emissivity is 0: with a flux its temperature would be unknown"
                        : "emissivity is 0: no heat passes such a shield; make it a wall");
  }
  return HR2D_OK;
}

/* Of a given T the emissivity is known: in the place of a table or a function come its values,
   in `value`. */
static hr2d_status fix_emissivity(hr2d_scene *scene, const hr2d_patch *patch, hr2d_thermal *t,
                                  double *value) {
  if (t->given != HR2D_HEAT_TEMPERATURE || !(t->kelvins || t->emissivity_of)) return HR2D_OK;
  for (size_t b = 0; b < hr2di_scene_spectral_bands(scene); b++) {
    value[b] = hr2di_emissivity_of(t, b, t->value);
    if (!(value[b] >= 0 && value[b] <= 1))
      return refuse(scene, HR2D_ECALLBACK, patch,
                    "the function of its emissivity gives a value that is not in [0,1]");
  }
  t->emissivity = value;
  t->emissivity_bands = hr2di_scene_spectral_bands(scene);
  t->kelvins = 0;
  t->emissivity_of = NULL;
  return HR2D_OK;
}

/* Room for E and ρ per band, in `value`. */
static double transmittance_of(const hr2d_patch *patch, size_t band) {
  return patch->transmittance_bands
             ? patch->transmittance[patch->transmittance_bands > 1 ? band : 0]
             : 0;
}

static void set_light(const hr2d_scene *scene, const hr2d_thermal *t, double *value,
                      hr2d_patch *patch) {
  const int flux = is_flux(t);
  if (t->given == HR2D_HEAT_SHIELD) return;
  const size_t bands = flux ? 1 : hr2di_scene_spectral_bands(scene);
  double *rho = value + bands;
  for (size_t b = 0; b < bands; b++) {
    const double tau = transmittance_of(patch, b);
    rho[b] = flux ? 1 : fmax(0, 1 - hr2di_emissivity_of(t, b, t->value) - tau);
    const double part = flux ? 1 : hr2di_scene_band_part(scene, t->value, b);
    value[b] = flux ? t->value : (1 - (rho[b] + tau)) * (part * hr2d_black_body(t->value));
  }
  patch->emission = value;
  patch->reflectance = rho;
  patch->emission_bands = bands;
  patch->reflectance_bands =
      t->emissivity_bands > 1 || patch->transmittance_bands > 1 ? bands : 1;
}

/* Of a pane: its values, with those of its emissivity. */
static hr2d_status check_transmittance(hr2d_scene *scene, const hr2d_patch *patch,
                                       const hr2d_thermal *t) {
  const size_t bands = patch->transmittance_bands;
  if (bands > 0 && !patch->transmittance)
    return refuse(scene, HR2D_EINVAL, patch, "transmittance: a number of bands but no values");
  if (bands > 1 && bands != hr2di_scene_spectral_bands(scene))
    return refuse(
        scene, HR2D_ESCENE, patch,
        "transmittance: wavelengths or weights of the scene make another number of bands");
  for (size_t b = 0; b < hr2di_scene_spectral_bands(scene) && bands; b++) {
    const double tau = transmittance_of(patch, b);
    if (!(tau >= 0 && tau <= 1))
      return refuse(scene, HR2D_ESCENE, patch, "transmittance is not between 0 and 1");
    if (tau > 0 && t->given != HR2D_HEAT_TEMPERATURE)
      return refuse(
          scene, HR2D_ESCENE, patch,
          t->given == HR2D_HEAT_SHIELD
              ? "a shield has no transmittance beside it: what passes it is its heat"
              : "a flux has no transmittance beside it: what passes a pane is no part "
                "of the heat of a side; give temperatures");
    if (hr2di_emissivity_of(t, b, t->value) + tau > 1 + 4 * DBL_EPSILON)
      return refuse(scene, HR2D_ESCENE, patch,
                    "emissivity and transmittance are together above 1");
  }
  return HR2D_OK;
}

hr2d_status hr2d_scene_add_thermal(hr2d_scene *scene, const hr2d_patch *given,
                                   const hr2d_thermal *thermal, size_t *index) {
  if (!scene || !given) return HR2D_EINVAL;
  hr2d_thermal t = HR2D_THERMAL_INIT;
  hr2d_patch patch = *given;
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE,
                              "a committed scene takes no more patches");
  if (!thermal || hr2di_sized_copy(&t, sizeof t, thermal))
    return refuse(scene, HR2D_EINVAL, given, "the struct_size of its hr2d_thermal is not set");
  hr2d_status status = check_value(scene, given, &t);
  if (!status) status = check_weights(scene, given, &t);
  if (!status) status = check_emissivity(scene, given, &t);
  if (status) return status;
  const size_t bands = hr2di_scene_spectral_bands(scene);
  double *value = hr2di_alloc(&scene->alloc, bands, 3 * sizeof *value);
  if (!value) return refuse(scene, HR2D_ENOMEM, given, "out of memory");
  status = fix_emissivity(scene, given, &t, value + 2 * bands);
  if (!status) status = check_transmittance(scene, given, &t);
  if (!status) {
    set_light(scene, &t, value, &patch);
    status = hr2di_scene_add(scene, &patch, &t, index);
  }
  hr2di_alloc_free(&scene->alloc, value);
  return status;
}

hr2d_heat hr2d_scene_heat(const hr2d_scene *scene, size_t patch, double *value) {
  if (value) *value = NAN;
  if (!hr2di_scene_has(scene, patch)) return HR2D_HEAT_NONE;
  const hr2di_light *light = scene->patch[patch].light;
  if (value) *value = light->heat == HR2D_HEAT_NONE ? NAN : light->given;
  return light->heat;
}

/* The lengths of patches may have changed since they were added. */
static hr2d_status spread_power(hr2d_scene *scene) {
  const size_t cell = hr2di_scene_cell(scene);
  for (size_t k = 0; k < cell; k++) scene->patch[k].light->across = 0;
  for (size_t k = 0; k < cell; k++)
    hr2di_light_add_length(scene->patch[k].light, scene->patch[k].given);
  for (size_t k = 0; k < cell; k++)
    if (!isfinite(scene->patch[k].light->given))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "%s is too short for its heat: the flux is no double",
                                hr2di_patch_label(scene, k).text);
  return HR2D_OK;
}

/* The part of commit: bands are known now. */
hr2d_status hr2di_scene_check_thermal(hr2d_scene *scene, hr2di_watch *watch) {
  const size_t bands = hr2di_scene_spectral_bands(scene);
  hr2d_status status = hr2di_watch_work(watch, scene->patches / 8);
  if (status) return hr2di_scene_fail(scene, status, watch, "");
  status = spread_power(scene);
  if (status) return status;
  if (bands > 1 && scene->bands == 1) scene->bands = bands;
  if (bands > 1 && scene->bands != bands)
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "the scene has %zu bands where its %s make %zu", scene->bands,
                              scene->spectrum.weights ? "weights" : "wavelengths", bands);
  for (size_t k = 0; k < scene->patches; k++) {
    const hr2d_heat heat = scene->patch[k].light->heat;
    if (heat == HR2D_HEAT_NONE || scene->bands == 1) continue;
    if (bands == 1)
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "%s has a %s, and the scene has %zu bands without wavelengths",
                                hr2di_patch_label(scene, k).text,
                                heat == HR2D_HEAT_FLUX     ? "flux"
                                : heat == HR2D_HEAT_SHIELD ? "temperature, as a shield,"
                                                           : "temperature",
                                scene->bands);
  }
  return HR2D_OK;
}
