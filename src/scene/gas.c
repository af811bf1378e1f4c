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

/* A border of fewer points has no area, and none leaves the gas everywhere. */
static hr2d_status check_border(hr2d_scene *scene, const hr2d_gas *g) {
  enum { LEAST_CORNERS = 3 };
  if (!g->border_points) return HR2D_OK;
  if (!g->border) return refuse(scene, HR2D_EINVAL, "a number of border points but no points");
  if (g->border_points < LEAST_CORNERS)
    return refuse(scene, HR2D_ESCENE, "its border has fewer than three points");
  if (g->border_points > SIZE_MAX / 64) return refuse(scene, HR2D_ENOMEM, "too many points");
  for (size_t k = 0; k < g->border_points; k++)
    if (!isfinite(g->border[k].x) || !isfinite(g->border[k].y))
      return refuse(scene, HR2D_ESCENE, "a point of its border is not finite");
  return HR2D_OK;
}

static hr2d_status check(hr2d_scene *scene, const hr2d_gas *g) {
  hr2d_status status = check_values(scene, g->absorption, g->absorption_bands,
                                    "the absorption is negative or not finite");
  if (!status)
    status = check_values(scene, g->emission, g->emission_bands,
                          "the emission is negative or not finite");
  if (!status) status = check_heat(scene, g);
  if (!status) status = check_border(scene, g);
  if (status) return status;
  if (g->absorption_bands > 1 && g->emission_bands > 1 &&
      g->absorption_bands != g->emission_bands)
    return refuse(scene, HR2D_ESCENE, "absorption and emission differ in their bands");
  return HR2D_OK;
}

hr2d_status hr2di_scene_make_gas(hr2d_scene *scene, const hr2d_gas *g, hr2di_gas **gas) {
  const hr2d_status status = check(scene, g);
  if (status) return status;
  const size_t bands = g->absorption_bands + g->emission_bands;
  const size_t values = bands + 2 * g->border_points;
  hr2di_gas *made = hr2di_alloc(&scene->alloc, 1, sizeof *made + values * sizeof *made->values);
  if (!made) return refuse(scene, HR2D_ENOMEM, "out of memory");
  *made = (hr2di_gas){.absorption_bands = g->absorption_bands,
                      .emission_bands = g->emission_bands,
                      .given = g->given,
                      .value = g->value,
                      .section = g->section,
                      .border_points = g->border_points};
  for (size_t b = 0; b < g->absorption_bands; b++) made->values[b] = g->absorption[b];
  made->given_range = range_of(made);
  for (size_t b = 0; b < g->emission_bands; b++)
    made->values[g->absorption_bands + b] = g->emission[b];
  for (size_t k = 0; k < g->border_points; k++) {
    made->values[bands + 2 * k] = g->border[k].x;
    made->values[bands + 2 * k + 1] = g->border[k].y;
  }
  *gas = made;
  return HR2D_OK;
}

static size_t around(const hr2di_gases *gases) {
  for (size_t k = 0; k < gases->count; k++)
    if (!gases->gas[k]->border_points) return k;
  return HR2DI_NO_GAS;
}

hr2d_status hr2di_gases_take(hr2di_gases *gases, hr2d_scene *scene, hr2di_gas *gas) {
  if (!gas->border_points && around(gases) != HR2DI_NO_GAS)
    return refuse(scene, HR2D_EUNSUPPORTED,
                  "the scene has one without a border already, which fills it");
  if (gases->count && gases->gas[0]->section != gas->section)
    return refuse(scene, HR2D_ESCENE, "its section is another one than that of the gas before");
  if (hr2di_alloc_reserve(&scene->alloc, &gases->gas, &gases->capacity, gases->count + 1,
                          sizeof(hr2di_gas *)))
    return refuse(scene, HR2D_ENOMEM, "out of memory");
  gases->gas[gases->count++] = gas;
  return HR2D_OK;
}

void hr2di_gases_clear(hr2di_gases *gases, const hr2d_allocator *alloc) {
  while (gases->count > 0) hr2di_alloc_free(alloc, gases->gas[--gases->count]);
  hr2di_alloc_free(alloc, gases->gas);
  *gases = (hr2di_gases){0};
}

hr2d_status hr2d_scene_add_gas(hr2d_scene *scene, const hr2d_gas *gas, size_t *index) {
  hr2di_gas *made;
  if (!scene) return HR2D_EINVAL;
  hr2d_gas g = HR2D_GAS_INIT;
  if (scene->committed) return refuse(scene, HR2D_ESTATE, "the scene is committed already");
  if (!gas || hr2di_sized_copy(&g, sizeof g, gas))
    return refuse(scene, HR2D_EINVAL, "the struct_size of hr2d_gas is not set");
  hr2d_status status = hr2di_scene_make_gas(scene, &g, &made);
  if (status) return status;
  status = hr2di_gases_take(&scene->gases, scene, made);
  if (status) hr2di_alloc_free(&scene->alloc, made);
  if (!status && index) *index = scene->gases.count - 1;
  return status;
}

size_t hr2di_scene_gas_bands(const hr2d_scene *scene) {
  size_t most = 0;
  for (size_t k = 0; k < scene->gases.count; k++) {
    const hr2di_gas *g = scene->gases.gas[k];
    if (g->absorption_bands > most) most = g->absorption_bands;
    if (g->emission_bands > most) most = g->emission_bands;
  }
  return most;
}

size_t hr2d_scene_gases(const hr2d_scene *scene) {
  return scene ? scene->gases.count : 0;
}

double hr2d_scene_absorption(const hr2d_scene *scene, size_t gas, size_t band) {
  if (gas >= hr2d_scene_gases(scene) || !hr2di_scene_has_band(scene, band)) return NAN;
  const hr2di_gas *g = scene->gases.gas[gas];
  if (g->absorption_bands <= 1) return g->absorption_bands ? g->values[0] : 0;
  return band < g->absorption_bands ? g->values[band] : NAN;
}

int hr2di_scene_has_gas(const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->gases.count; k++)
    if (scene->gases.gas[k]->given_range.most > 0) return 1;
  return 0;
}

size_t hr2di_scene_gas_around(const hr2d_scene *scene) {
  return around(&scene->gases);
}

hr2di_gas_range hr2di_scene_scaled_range(const hr2d_scene *scene) {
  hr2di_gas_range all = {0, 0};
  if (hr2di_scene_gas_around(scene) != HR2DI_NO_GAS) all.least = HUGE_VAL;
  for (size_t k = 0; k < scene->gases.count; k++) {
    all.least = fmin(all.least, scene->gases.gas[k]->scaled_range.least);
    all.most = fmax(all.most, scene->gases.gas[k]->scaled_range.most);
  }
  return all;
}

double hr2di_scene_scaled_absorption(const hr2d_scene *scene, size_t gas) {
  return gas == HR2DI_NO_GAS ? 0 : scene->gases.gas[gas]->scaled_range.most;
}

int hr2di_scene_absorbs_alike(const hr2d_scene *scene, size_t band, size_t other) {
  for (size_t k = 0; k < scene->gases.count; k++)
    if (hr2d_scene_absorption(scene, k, band) != hr2d_scene_absorption(scene, k, other))
      return 0;
  return 1;
}

hr2d_section hr2di_scene_section(const hr2d_scene *scene) {
  return scene->gases.gas[0]->section;
}

double hr2di_scene_gas_emission(const hr2d_scene *scene, size_t gas, size_t band) {
  if (!hr2di_scene_has_gas(scene) || gas >= scene->gases.count) return 0;
  const hr2di_gas *g = scene->gases.gas[gas];
  if (g->given == HR2D_HEAT_FLUX) return 0;
  if (g->given == HR2D_HEAT_TEMPERATURE)
    return hr2di_scene_band_part(scene, g->value, band) * hr2d_black_body(g->value);
  const double *emission = g->values + g->absorption_bands;
  if (g->emission_bands <= 1) return g->emission_bands ? emission[0] : 0;
  return emission[band % g->emission_bands];
}

int hr2di_scene_gas_is_free(const hr2d_scene *scene, size_t gas) {
  return hr2di_scene_has_gas(scene) && scene->gases.gas[gas]->given == HR2D_HEAT_FLUX;
}

int hr2di_scene_has_free_gas(const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->gases.count; k++)
    if (hr2di_scene_gas_is_free(scene, k)) return 1;
  return 0;
}

double hr2di_scene_gas_heat(const hr2d_scene *scene, size_t gas) {
  return hr2di_scene_gas_is_free(scene, gas) ? scene->gases.gas[gas]->value : 0;
}

static int emits(const hr2d_scene *scene, size_t gas) {
  if (hr2di_scene_gas_is_free(scene, gas)) return scene->gases.gas[gas]->value != 0;
  for (size_t b = 0; b < scene->bands; b++)
    if (hr2d_scene_absorption(scene, gas, b) > 0 && hr2di_scene_gas_emission(scene, gas, b) > 0)
      return 1;
  return 0;
}

int hr2di_scene_gas_emits(const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->gases.count; k++)
    if (emits(scene, k)) return 1;
  return 0;
}

hr2di_gas_range hr2di_scene_given_range(const hr2d_scene *scene) {
  hr2di_gas_range all = {HUGE_VAL, 0};
  for (size_t k = 0; k < scene->gases.count; k++) {
    all.least = fmin(all.least, scene->gases.gas[k]->given_range.least);
    all.most = fmax(all.most, scene->gases.gas[k]->given_range.most);
  }
  return all;
}

hr2d_status hr2di_gas_refuses(const hr2d_scene *scene, const char *what,
                              hr2di_message *message) {
  if (!hr2di_scene_has_gas(scene)) return HR2D_OK;
  if (message)
    hr2di_message_fail(message, HR2D_EUNSUPPORTED,
                       "the scene has a gas that absorbs %g per length: %s through gas",
                       hr2di_scene_given_range(scene).most, what);
  return HR2D_EUNSUPPORTED;
}

static int absorbs(const hr2d_scene *scene, size_t band) {
  for (size_t k = 0; k < scene->gases.count; k++)
    if (hr2d_scene_absorption(scene, k, band) > 0) return 1;
  return 0;
}

/* Whether light comes from outside in a band that gas absorbs. */
static int has_light_outside(const hr2d_scene *scene) {
  for (size_t b = 0; b < scene->bands; b++)
    if (absorbs(scene, b) &&
        (hr2di_sky_max(scene, b) > 0 || hr2d_scene_sun(scene, b).irradiance > 0))
      return 1;
  return 0;
}

static hr2d_status check_one(hr2d_scene *scene, hr2di_gas *g) {
  size_t band;
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
  return HR2D_OK;
}

hr2d_status hr2di_scene_check_gas(hr2d_scene *scene, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  if (!hr2di_scene_has_gas(scene)) return HR2D_OK;
  (void)watch;
  for (size_t k = 0; k < scene->gases.count && !status; k++)
    status = check_one(scene, scene->gases.gas[k]);
  if (status) return status;
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
