/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gas of a scene: setting it, checks, values. */
#include "scene/gas.h"

#include <math.h>
#include <stdint.h>

#include "base/alloc.h"
#include "base/sized-struct.h"
#include "scene/frozen-temperatures.h"
#include "scene/scene-impl.h"
#include "scene/sky.h"

static hr2d_status refuse(hr2d_scene *scene, hr2d_status status, const char *why) {
  return hr2di_message_fail(&scene->message, status, "gas: %s", why);
}

static hr2d_status check_values(hr2d_scene *scene, const double *value, size_t bands,
                                const char *invalid) {
  if (bands && !value) return refuse(scene, HR2D_EINVAL, "a number of bands but no values");
  if (bands > SIZE_MAX / 64) return refuse(scene, HR2D_ENOMEM, "too many bands");
  for (size_t b = 0; b < bands; b++)
    if (!(value[b] >= 0 && isfinite(value[b]))) return refuse(scene, HR2D_ESCENE, invalid);
  return HR2D_OK;
}

static hr2d_status check_heat(hr2d_scene *scene, const hr2d_gas *g) {
  if ((unsigned)g->section > HR2D_SECTION_FLAT)
    return refuse(scene, HR2D_EINVAL, "the section is no hr2d_section");
  if ((unsigned)g->given > HR2D_HEAT_FLUX)
    return refuse(scene, HR2D_EINVAL, "what is given is no hr2d_heat");
  if (g->given == HR2D_HEAT_NONE) return HR2D_OK;
  if (g->emission_bands)
    return refuse(scene, HR2D_EINVAL, "emission follows from what is given, and cannot be set");
  if (g->given == HR2D_HEAT_FLUX)
    return isfinite(g->value) ? HR2D_OK : refuse(scene, HR2D_ESCENE, "heat is not finite");
  if (!(g->value >= 0 && isfinite(g->value)))
    return refuse(scene, HR2D_ESCENE, "temperature is not a number of kelvin");
  if (!isfinite(hr2d_black_body(g->value)))
    return refuse(scene, HR2D_ESCENE, "temperature is too large for a double");
  return HR2D_OK;
}

static hr2di_gas_range range_of(const hr2di_gas *g) {
  if (g->absorption_bands == 0) return (hr2di_gas_range){0, 0};
  hr2di_gas_range range = {HUGE_VAL, 0};
  for (size_t b = 0; b < g->absorption_bands; b++) {
    range.least = fmin(range.least, g->values[b]);
    range.most = fmax(range.most, g->values[b]);
  }
  return range;
}

hr2d_status hr2di_scene_make_gas(hr2d_scene *scene, const hr2d_gas *g, hr2di_gas **gas) {
  hr2d_status status = check_values(scene, g->absorption, g->absorption_bands,
                                    "the absorption is negative or not finite");
  if (!status)
    status = check_values(scene, g->emission, g->emission_bands,
                          "the emission is negative or not finite");
  if (!status) status = check_heat(scene, g);
  if (status) return status;
  if (g->absorption_bands > 1 && g->emission_bands > 1 &&
      g->absorption_bands != g->emission_bands)
    return refuse(scene, HR2D_ESCENE, "absorption and emission differ in their bands");
  const size_t values = g->absorption_bands + g->emission_bands;
  hr2di_gas *made = hr2di_alloc(&scene->alloc, 1, sizeof *made + values * sizeof *made->values);
  if (!made) return refuse(scene, HR2D_ENOMEM, "out of memory");
  *made = (hr2di_gas){.absorption_bands = g->absorption_bands,
                      .emission_bands = g->emission_bands,
                      .given = g->given,
                      .value = g->value,
                      .section = g->section};
  for (size_t b = 0; b < g->absorption_bands; b++) made->values[b] = g->absorption[b];
  made->given_range = range_of(made);
  for (size_t b = 0; b < g->emission_bands; b++)
    made->values[g->absorption_bands + b] = g->emission[b];
  *gas = made;
  return HR2D_OK;
}

hr2d_status hr2d_scene_add_gas(hr2d_scene *scene, const hr2d_gas *gas, size_t *index) {
  if (!scene) return HR2D_EINVAL;
  hr2d_gas g = HR2D_GAS_INIT;
  if (scene->committed) return refuse(scene, HR2D_ESTATE, "the scene is committed already");
  if (!gas || hr2di_sized_copy(&g, sizeof g, gas))
    return refuse(scene, HR2D_EINVAL, "the struct_size of hr2d_gas is not set");
  if (scene->gas)
    return refuse(scene, HR2D_EUNSUPPORTED, "the scene has one already, and takes no second");
  const hr2d_status status = hr2di_scene_make_gas(scene, &g, &scene->gas);
  if (!status && index) *index = 0;
  return status;
}

size_t hr2di_scene_gas_bands(const hr2d_scene *scene) {
  const hr2di_gas *g = scene->gas;
  if (!g) return 0;
  return g->absorption_bands > g->emission_bands ? g->absorption_bands : g->emission_bands;
}

size_t hr2d_scene_gases(const hr2d_scene *scene) {
  return scene && scene->gas;
}

double hr2d_scene_absorption(const hr2d_scene *scene, size_t gas, size_t band) {
  if (gas >= hr2d_scene_gases(scene) || !hr2di_scene_has_band(scene, band)) return NAN;
  const hr2di_gas *g = scene->gas;
  if (g->absorption_bands <= 1) return g->absorption_bands ? g->values[0] : 0;
  return band < g->absorption_bands ? g->values[band] : NAN;
}

int hr2di_scene_has_gas(const hr2d_scene *scene) {
  return scene->gas && scene->gas->given_range.most > 0;
}

hr2di_gas_range hr2di_scene_scaled_range(const hr2d_scene *scene) {
  return scene->gas ? scene->gas->scaled_range : (hr2di_gas_range){0, 0};
}

hr2d_section hr2di_scene_section(const hr2d_scene *scene) {
  return scene->gas->section;
}

double hr2di_scene_gas_emission(const hr2d_scene *scene, size_t band) {
  const hr2di_gas *g = scene->gas;
  if (!hr2di_scene_has_gas(scene) || g->given == HR2D_HEAT_FLUX) return 0;
  if (g->given == HR2D_HEAT_TEMPERATURE)
    return hr2di_scene_band_part(scene, g->value, band) * hr2d_black_body(g->value);
  const double *emission = g->values + g->absorption_bands;
  if (g->emission_bands <= 1) return g->emission_bands ? emission[0] : 0;
  return emission[band % g->emission_bands];
}

int hr2di_scene_gas_is_free(const hr2d_scene *scene) {
  return hr2di_scene_has_gas(scene) && scene->gas->given == HR2D_HEAT_FLUX;
}

double hr2di_scene_gas_heat(const hr2d_scene *scene) {
  return hr2di_scene_gas_is_free(scene) ? scene->gas->value : 0;
}

int hr2di_scene_gas_emits(const hr2d_scene *scene) {
  if (hr2di_scene_gas_is_free(scene)) return scene->gas->value != 0;
  for (size_t b = 0; b < scene->bands; b++)
    if (hr2d_scene_absorption(scene, 0, b) > 0 && hr2di_scene_gas_emission(scene, b) > 0)
      return 1;
  return 0;
}

hr2d_status hr2di_gas_refuses(const hr2d_scene *scene, const char *what,
                              hr2di_message *message) {
  if (!hr2di_scene_has_gas(scene)) return HR2D_OK;
  if (message)
    hr2di_message_fail(message, HR2D_EUNSUPPORTED,
                       "the scene has a gas that absorbs %g per length: %s through gas",
                       scene->gas->given_range.most, what);
  return HR2D_EUNSUPPORTED;
}

/* Whether light comes from outside in a band that gas absorbs. */
static int has_light_outside(const hr2d_scene *scene) {
  for (size_t b = 0; b < scene->bands; b++)
    if (hr2d_scene_absorption(scene, 0, b) > 0 &&
        (hr2di_sky_max(scene, b) > 0 || hr2d_scene_sun(scene, b).irradiance > 0))
      return 1;
  return 0;
}

hr2d_status hr2di_scene_check_gas(hr2d_scene *scene, hr2di_watch *watch) {
  (void)watch;
  size_t band;
  hr2di_gas *g = scene->gas;
  if (!g) return HR2D_OK;
  if (!hr2di_scene_has_gas(scene)) return HR2D_OK;
  g->scaled_range = (hr2di_gas_range){ldexp(g->given_range.least, scene->exponent),
                                      ldexp(g->given_range.most, scene->exponent)};
  if (!isfinite(g->scaled_range.most))
    return refuse(scene, HR2D_ESCENE, "the absorption over a scene length is beyond a double");
  if (g->given == HR2D_HEAT_TEMPERATURE && scene->bands > hr2di_scene_spectral_bands(scene))
    return refuse(
        scene, HR2D_ESCENE,
        "it has a temperature, and the scene has bands without wavelengths or weights");
  if (g->given == HR2D_HEAT_TEMPERATURE &&
      !hr2di_spectrum_knows(&scene->spectrum, g->value, &band))
    return hr2di_message_fail(
        &scene->message, HR2D_ESCENE,
        "gas: at %.9g K the weight of band %zu is %.6g, not between 0 and 1", g->value, band,
        hr2di_scene_band_part(scene, g->value, band));
  if (g->given == HR2D_HEAT_FLUX && (scene->bands > 1 || hr2di_scene_spectral_bands(scene) > 1))
    return refuse(
        scene, HR2D_EUNSUPPORTED,
        "its heat is given in several bands, for which this version does not find its "
        "temperature");
  if (has_light_outside(scene))
    return hr2di_gas_refuses(scene, "light from a background, a sky or a sun does not go",
                             &scene->message);
  if (hr2di_scene_is_unsettled(scene))
    return hr2di_gas_refuses(scene, "given fluxes in several bands do not go", &scene->message);
  return HR2D_OK;
}

hr2d_status hr2di_scene_check_far_gas(hr2d_scene *scene) {
  if (!hr2di_symmetry_cuts(&scene->symmetry)) return HR2D_OK;
  return hr2di_gas_refuses(
      scene, "light of images that are cut off, which the period has, is not known",
      &scene->message);
}
