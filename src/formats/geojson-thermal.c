/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Thermal properties of a GeoJSON file: temperatures, fluxes, emissivities, and the spectrum.
 */
#include <float.h>
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "formats/geojson-impl.h"
#include "scene/scene-impl.h"

static hr2d_status read_number(hr2di_geojson *reader, const char *place, const char *key,
                               const json_t *json, double *value) {
  if (!json_is_number(json))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "%s: %s: must be a number, not %s",
                              place, key, hr2di_geojson_kind(json));
  *value = json_number_value(json);
  return HR2D_OK;
}

/* What a feature gives besides, or in place of, emission and reflectance.  A feature with
   emission has thermal properties for its readers only. */
static hr2d_status choose(hr2di_geojson *reader, const json_t *properties, const json_t **json,
                          const char **key) {
  const json_t *temperature = hr2di_geojson_member(properties, "temperature");
  const json_t *flux = hr2di_geojson_member(properties, "flux");
  *json = temperature ? temperature : flux;
  *key = temperature ? "temperature" : "flux";
  if (!*json || hr2di_geojson_member(properties, "emission")) {
    *json = NULL;
    return HR2D_OK;
  }
  if (temperature && flux)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "%s: temperature and flux cannot both be given: each follows "
                              "from the other",
                              reader->label);
  if (hr2di_geojson_member(properties, "reflectance"))
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "%s: reflectance: beside a %s write \"emissivity\": "
                              "1 - reflectance",
                              reader->label, *key);
  return HR2D_OK;
}

hr2d_status hr2di_geojson_thermal(hr2di_geojson *reader, const json_t *properties) {
  const json_t *json;
  const char *key = NULL;
  hr2d_thermal *t = &reader->thermal;
  *t = (hr2d_thermal)HR2D_THERMAL_INIT;
  hr2d_status status = choose(reader, properties, &json, &key);
  if (status || !json) return status;
  status = read_number(reader, reader->label, key, json, &t->value);
  if (!status)
    status = hr2di_geojson_values(reader, reader->label, "emissivity",
                                  hr2di_geojson_member(properties, "emissivity"), 1,
                                  &reader->reflectance, &t->emissivity_bands);
  if (status) return status;
  t->given = *key == 't' ? HR2D_HEAT_TEMPERATURE : HR2D_HEAT_FLUX;
  t->emissivity = t->emissivity_bands ? reader->reflectance.value : NULL;
  return HR2D_OK;
}

/* The wavelengths of a former file may be said again. */
static int are_set(const hr2d_scene *scene, const double *wavelength, size_t count) {
  return count == scene->wavelengths &&
         !memcmp(wavelength, scene->wavelength, count * sizeof *wavelength);
}

static hr2d_status read_wavelengths(hr2di_geojson *reader, const json_t *members) {
  hr2d_scene *scene = reader->scene;
  size_t count;
  hr2d_status status = hr2di_geojson_values(reader, "hr2d", "wavelengths",
                                            hr2di_geojson_member(members, "wavelengths"),
                                            DBL_MAX, &reader->emission, &count);
  if (status || !count || are_set(scene, reader->emission.value, count)) return status;
  reader->former = scene->wavelength;
  reader->formers = scene->wavelengths;
  reader->replaced = 1;
  scene->wavelength = NULL;
  scene->wavelengths = 0;
  return hr2d_scene_set_wavelengths(scene, reader->emission.value, count);
}

static hr2d_status read_background(hr2di_geojson *reader, const json_t *members,
                                   size_t *bands) {
  const json_t *json = hr2di_geojson_member(members, "background_temperature");
  const size_t count = reader->scene->wavelengths + 1;
  double kelvin = 0;
  if (!json) return HR2D_OK;
  if (*bands)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "hr2d: background and background_temperature cannot both be "
                              "given");
  hr2d_status status = read_number(reader, "hr2d", "background_temperature", json, &kelvin);
  if (status) return status;
  if (kelvin < 0 || !isfinite(hr2d_black_body(kelvin)))
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "hr2d: background_temperature: must be 0 K or more, and its "
                              "radiosity a double, not %g",
                              kelvin);
  if (hr2di_alloc_reserve(reader->alloc, &reader->background.value,
                          &reader->background.capacity, count,
                          sizeof *reader->background.value))
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "hr2d: out of memory");
  for (size_t b = 0; b < count; b++)
    reader->background.value[b] =
        hr2di_scene_band_part(reader->scene, kelvin, b) * hr2d_black_body(kelvin);
  *bands = count;
  return HR2D_OK;
}

hr2d_status hr2di_geojson_spectrum(hr2di_geojson *reader, const json_t *members,
                                   size_t *background_bands) {
  const hr2d_status status = read_wavelengths(reader, members);
  return status ? status : read_background(reader, members, background_bands);
}

void hr2di_geojson_end_spectrum(hr2di_geojson *reader, hr2d_status status) {
  hr2d_scene *scene = reader->scene;
  if (!reader->replaced) return;
  hr2di_alloc_free(reader->alloc, status ? scene->wavelength : reader->former);
  if (!status) return;
  scene->wavelength = reader->former;
  scene->wavelengths = reader->formers;
}
