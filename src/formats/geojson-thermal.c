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
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: %s: must be a number, not %s%s", place, key,
                              hr2di_geojson_kind(json),
                              json_is_string(json) ? ": leave out the quotation marks" : "");
  *value = json_number_value(json);
  return HR2D_OK;
}

/* What is given in the place of emission: at most one of them. */
static const struct given {
  const char *key;
  hr2d_heat heat;
} ways[] = {{"temperature", HR2D_HEAT_TEMPERATURE},
            {"flux", HR2D_HEAT_FLUX},
            {"heat", HR2D_HEAT_POWER}};

/* What a feature gives besides, or in place of, emission and reflectance; NULL: nothing.  A
   feature with emission has thermal properties for its readers only. */
static hr2d_status choose(hr2di_geojson *reader, const json_t *properties,
                          const struct given **way) {
  *way = NULL;
  if (hr2di_geojson_member(properties, "emission")) return HR2D_OK;
  for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
    if (!hr2di_geojson_member(properties, ways[k].key)) continue;
    if (*way)
      return hr2di_message_fail(reader->message, HR2D_ESCENE,
                                "%s: %s and %s cannot both be given: each follows "
                                "from the other",
                                reader->label, (*way)->key, ways[k].key);
    *way = &ways[k];
  }
  if (*way && hr2di_geojson_member(properties, "reflectance"))
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "%s: reflectance: beside a %s write \"emissivity\": "
                              "1 - reflectance",
                              reader->label, (*way)->key);
  return HR2D_OK;
}

/* A table [[T, ε], …]; with bands [[T, ε₀, ε₁, …], …].  Its numbers come into a row of ε for
   each entry, and the temperatures behind them. */
static hr2d_status read_table(hr2di_geojson *reader, const json_t *json) {
  const size_t entries = json_array_size(json),
               width = json_array_size(json_array_get(json, 0));
  hr2di_values *values = &reader->reflectance;
  hr2d_thermal *t = &reader->thermal;
  if (hr2di_alloc_reserve(reader->alloc, &values->value, &values->capacity,
                          entries * (width ? width : 1), sizeof *values->value))
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "%s: out of memory", reader->label);
  for (size_t k = 0; k < entries; k++) {
    const json_t *entry = json_array_get(json, k);
    if (!json_is_array(entry) || width < 2 || json_array_size(entry) != width)
      return hr2di_message_fail(
          reader->message, HR2D_ESYNTAX,
          "%s: emissivity: the entries of a table must be [T, emissivity], "
          "or have one emissivity for each band",
          reader->label);
    for (size_t m = 0; m < width; m++) {
      hr2d_status status = hr2di_watch_work(reader->watch, 1);
      double *to = m ? &values->value[k * (width - 1) + m - 1]
                     : &values->value[entries * (width - 1) + k];
      if (!status)
        status = read_number(reader, reader->label, "emissivity", json_array_get(entry, m), to);
      if (status) return status;
    }
  }
  t->emissivity = values->value;
  t->emissivity_bands = width - 1;
  t->kelvin = values->value + entries * (width - 1);
  t->kelvins = entries;
  return HR2D_OK;
}

static hr2d_status read_emissivity(hr2di_geojson *reader, const json_t *json) {
  hr2d_thermal *t = &reader->thermal;
  if (json_is_array(json_array_get(json, 0))) return read_table(reader, json);
  const hr2d_status status = hr2di_geojson_values(reader, reader->label, "emissivity", json, 1,
                                                  &reader->reflectance, &t->emissivity_bands);
  if (!status && t->emissivity_bands) t->emissivity = reader->reflectance.value;
  return status;
}

/* "shield": true, beside an emissivity alone. */
static hr2d_status read_shield(hr2di_geojson *reader, const json_t *properties) {
  static const char *const others[] = {"emission",    "reflectance", "transmittance",
                                       "temperature", "flux",        "heat"};
  for (size_t k = 0; k < sizeof others / sizeof *others; k++)
    if (hr2di_geojson_member(properties, others[k]))
      return hr2di_message_fail(reader->message, HR2D_ESCENE,
                                "%s: %s: a shield takes the temperature that its heat of 0 "
                                "asks for: give it an \"emissivity\" alone",
                                reader->label, others[k]);
  reader->thermal.given = HR2D_HEAT_SHIELD;
  return read_emissivity(reader, hr2di_geojson_member(properties, "emissivity"));
}

hr2d_status hr2di_geojson_thermal(hr2di_geojson *reader, const json_t *properties) {
  const json_t *json = hr2di_geojson_member(properties, "shield");
  const struct given *way;
  hr2d_thermal *t = &reader->thermal;
  *t = (hr2d_thermal)HR2D_THERMAL_INIT;
  if (json && !json_is_boolean(json))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: shield: must be true or false, not %s", reader->label,
                              hr2di_geojson_kind(json));
  if (json_is_true(json)) return read_shield(reader, properties);
  hr2d_status status = choose(reader, properties, &way);
  if (status || !way) return status;
  status = read_number(reader, reader->label, way->key,
                       hr2di_geojson_member(properties, way->key), &t->value);
  t->given = way->heat;
  return status ? status
                : read_emissivity(reader, hr2di_geojson_member(properties, "emissivity"));
}

/* The spectrum of a former file may be said again; another one takes its place. */
static int is_set(const double *of, size_t count, const double *value, size_t values) {
  return count == values && !memcmp(of, value, count * sizeof *value);
}

static void set_aside(hr2di_geojson *reader) {
  if (!reader->replaced) reader->former = reader->scene->spectrum;
  reader->replaced = 1;
  reader->scene->spectrum = (hr2di_spectrum){0};
}

static hr2d_status read_wavelengths(hr2di_geojson *reader, const json_t *members) {
  hr2d_scene *scene = reader->scene;
  size_t count;
  hr2d_status status = hr2di_geojson_values(reader, "hr2d", "wavelengths",
                                            hr2di_geojson_member(members, "wavelengths"),
                                            DBL_MAX, &reader->emission, &count);
  if (status || !count ||
      is_set(scene->spectrum.wavelength, scene->spectrum.wavelengths, reader->emission.value,
             count))
    return status;
  set_aside(reader);
  return hr2d_scene_set_wavelengths(scene, reader->emission.value, count);
}

/* One polynomial, of as many terms as the first one. */
static hr2d_status read_polynomial(hr2di_geojson *reader, const json_t *json, size_t number,
                                   size_t terms) {
  if (!json_is_array(json) || json_array_size(json) != terms)
    return hr2di_message_fail(
        reader->message, HR2D_ESYNTAX,
        "hr2d: weights: number %zu must be an array of numbers, as many as the first has: the "
        "coefficients of 1, T, T^2 and so on",
        number + 1);
  for (size_t k = 0; k < terms; k++) {
    const json_t *value = json_array_get(json, k);
    if (!json_is_number(value))
      return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                                "hr2d: weights: number %zu has %s where a number must be",
                                number + 1, hr2di_geojson_kind(value));
    reader->emission.value[number * terms + k] = json_number_value(value);
  }
  return HR2D_OK;
}

static hr2d_status read_weights(hr2di_geojson *reader, const json_t *members) {
  const json_t *json = hr2di_geojson_member(members, "weights");
  hr2d_scene *scene = reader->scene;
  if (!json) return HR2D_OK;
  const size_t count = json_array_size(json), terms = json_array_size(json_array_get(json, 0));
  if (!count || !terms || count > HR2D_MAX_WAVELENGTHS || terms > HR2D_MAX_WAVELENGTHS)
    return hr2di_message_fail(
        reader->message, HR2D_ESYNTAX,
        "hr2d: weights: must be an array of polynomials in T, one for each "
        "band behind the first");
  if (hr2di_geojson_member(members, "wavelengths"))
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "hr2d: wavelengths and weights cannot both be given");
  if (hr2di_alloc_reserve(reader->alloc, &reader->emission.value, &reader->emission.capacity,
                          count * terms, sizeof *reader->emission.value))
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "hr2d: out of memory");
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status; k++)
    status = read_polynomial(reader, json_array_get(json, k), k, terms);
  if (status || (terms == scene->spectrum.terms &&
                 is_set(scene->spectrum.weight, scene->spectrum.weights * terms,
                        reader->emission.value, count * terms)))
    return status;
  set_aside(reader);
  return hr2d_scene_set_weights(scene, reader->emission.value, count, terms);
}

static hr2d_status read_background(hr2di_geojson *reader, const json_t *members,
                                   size_t *bands) {
  const json_t *json = hr2di_geojson_member(members, "background_temperature");
  const size_t count = hr2di_scene_spectral_bands(reader->scene);
  double kelvin = 0;
  if (!json) return HR2D_OK;
  if (*bands)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "hr2d: background and background_temperature cannot both be "
                              "given");
  hr2d_status status = read_number(reader, "hr2d", "background_temperature", json, &kelvin);
  if (status) return status;
  size_t band;
  if (!hr2di_spectrum_knows(&reader->scene->spectrum, kelvin, &band))
    return hr2di_message_fail(
        reader->message, HR2D_ESCENE,
        "hr2d: background_temperature: at %.9g K the weight of band %zu is "
        "not between 0 and 1",
        kelvin, band);
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
  hr2d_status status = read_wavelengths(reader, members);
  if (!status) status = read_weights(reader, members);
  return status ? status : read_background(reader, members, background_bands);
}

void hr2di_geojson_end_spectrum(hr2di_geojson *reader, hr2d_status status) {
  hr2di_spectrum *own = &reader->scene->spectrum, *old = status ? own : &reader->former;
  if (!reader->replaced) return;
  hr2di_alloc_free(reader->alloc, old->wavelength);
  hr2di_alloc_free(reader->alloc, old->weight);
  if (status) *own = reader->former;
}
