/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the patches of a GeoJSON feature emit, reflect and let through, on either side. */
#include <float.h>
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "formats/geojson-impl.h"
#include "formats/geojson-meant.h"

static hr2d_status read_light(hr2di_geojson *reader, const json_t *properties) {
  hr2d_patch *patch = &reader->patch;
  hr2d_status status = hr2di_geojson_values(reader, reader->label, "emission",
                                            hr2di_geojson_member(properties, "emission"),
                                            DBL_MAX, &reader->emission, &patch->emission_bands);
  if (status) return status;
  status = hr2di_geojson_values(reader, reader->label, "reflectance",
                                hr2di_geojson_member(properties, "reflectance"), 1,
                                &reader->reflectance, &patch->reflectance_bands);
  if (status) return status;
  if (patch->emission_bands > 1 && patch->reflectance_bands > 1 &&
      patch->emission_bands != patch->reflectance_bands)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "%s: emission has %zu bands, reflectance has %zu", reader->label,
                              patch->emission_bands, patch->reflectance_bands);
  patch->emission = reader->emission.value;
  patch->reflectance = reader->reflectance.value;
  return HR2D_OK;
}

static hr2d_status read_transmittance(hr2di_geojson *reader, const json_t *properties) {
  hr2d_patch *patch = &reader->patch;
  const hr2d_status status = hr2di_geojson_values(
      reader, reader->label, "transmittance", hr2di_geojson_member(properties, "transmittance"),
      1, &reader->transmittance, &patch->transmittance_bands);
  patch->transmittance = reader->transmittance.value;
  return status;
}

hr2d_status hr2di_geojson_surface(hr2di_geojson *reader, const json_t *properties) {
  hr2d_status status = hr2di_geojson_thermal(reader, properties);
  if (!status && !reader->thermal.given) status = read_light(reader, properties);
  return status ? status : read_transmittance(reader, properties);
}

/* Properties of which one takes the place of another. */
enum { GROUP = 4 };
static const char *const group[][GROUP] = {{"emission", "temperature", "flux", "heat"},
                                           {"reflectance", "emissivity", NULL, NULL}};

/* The properties of the back: those that are given, and else those of the feature.  NULL
   without memory. */
static json_t *properties_of_back(const json_t *properties, const json_t *back) {
  json_t *all = json_copy((json_t *)(uintptr_t)properties); /* changes nothing */
  for (size_t g = 0; g < sizeof group / sizeof *group && all; g++) {
    int given = 0;
    for (int k = 0; k < GROUP && group[g][k]; k++)
      given |= hr2di_geojson_member(back, group[g][k]) != NULL;
    for (int k = 0; k < GROUP && group[g][k] && given; k++) json_object_del(all, group[g][k]);
  }
  if (all && !json_object_update(all, (json_t *)(uintptr_t)back)) return all;
  json_decref(all);
  return NULL;
}

static void exchange(hr2di_values *a, hr2di_values *b) {
  const hr2di_values kept = *a;
  *a = *b;
  *b = kept;
}

/* Front and back change places, with their buffers. */
static void turn_round(hr2di_geojson *reader) {
  const hr2d_patch patch = reader->patch;
  const hr2d_thermal thermal = reader->thermal;
  reader->patch = reader->back;
  reader->thermal = reader->back_thermal;
  reader->back = patch;
  reader->back_thermal = thermal;
  exchange(&reader->emission, &reader->back_emission);
  exchange(&reader->reflectance, &reader->back_reflectance);
  exchange(&reader->transmittance, &reader->back_transmittance);
}

/* Heat is that of both sides, which share it evenly if they are alike. */
static hr2d_status check_heat(hr2di_geojson *reader, const json_t *back) {
  if (reader->thermal.given != HR2D_HEAT_POWER) return HR2D_OK;
  for (int k = 0; k < GROUP; k++)
    if (hr2di_geojson_member(back, group[0][k])) return HR2D_OK;
  return hr2di_message_fail(reader->message, HR2D_ESCENE,
                            "%s: back: the heat of sides that differ has to be told for each: "
                            "give the back a \"heat\" of its own",
                            reader->label);
}

static hr2d_status read_back(hr2di_geojson *reader, const json_t *properties,
                             const json_t *back) {
  const size_t label = strlen(reader->label);
  json_t *all = properties_of_back(properties, back);
  if (!all)
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "%s: out of memory", reader->label);
  snprintf(reader->label + label, sizeof reader->label - label, ": back");
  hr2d_status status = hr2di_geojson_note_back(reader, back);
  reader->back = reader->patch;
  reader->back.emission_bands = reader->back.reflectance_bands = 0;
  turn_round(reader);
  if (!status) status = hr2di_geojson_surface(reader, all);
  turn_round(reader);
  reader->label[label] = '\0';
  json_decref(all);
  return status;
}

hr2d_status hr2di_geojson_back(hr2di_geojson *reader, const json_t *properties) {
  const json_t *back = hr2di_geojson_member(properties, "back");
  reader->has_back = back != NULL;
  if (!back) return HR2D_OK;
  if (!json_is_object(back))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: back: must be an object with properties of the other side, "
                              "not %s",
                              reader->label, hr2di_geojson_kind(back));
  if (reader->patch.sides != HR2D_SIDES_BOTH)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "%s: back: there is none without \"sides\": \"both\"",
                              reader->label);
  const hr2d_status status = check_heat(reader, back);
  return status ? status : read_back(reader, properties, back);
}
