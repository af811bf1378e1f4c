/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gas of a GeoJSON file: "medium" in its "hr2d". */
#include <float.h>
#include <string.h>

#include "base/alloc.h"
#include "formats/geojson-impl.h"
#include "scene/scene-impl.h"

static hr2d_status refuse(hr2di_geojson *reader, const char *why) {
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "hr2d: medium: %s", why);
}

static hr2d_status read_section(hr2di_geojson *reader, const json_t *json, hr2d_gas *gas) {
  const char *text = json_string_value(json);
  if (!json) return HR2D_OK;
  gas->section = HR2D_SECTION_FLAT;
  if (text && strcmp(text, "flat") == 0) return HR2D_OK;
  gas->section = HR2D_SECTION_LONG;
  if (text && strcmp(text, "long") == 0) return HR2D_OK;
  return refuse(reader, "section: must be \"long\" or \"flat\"");
}

/* A temperature or a heat, as "flux" of patches is one. */
static hr2d_status read_given(hr2di_geojson *reader, const json_t *medium, const char *name,
                              hr2d_heat heat, hr2d_gas *gas) {
  const json_t *json = hr2di_geojson_member(medium, name);
  if (!json) return HR2D_OK;
  if (!json_is_number(json))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "hr2d: medium: %s: must be a number, not %s", name,
                              hr2di_geojson_kind(json));
  if (gas->given != HR2D_HEAT_NONE)
    return refuse(reader, "both a temperature and a flux are given");
  gas->given = heat;
  gas->value = json_number_value(json);
  return HR2D_OK;
}

/* Numbers become those of an own array, as the reader has one for each name. */
static hr2d_status read_members(hr2di_geojson *reader, const json_t *medium, hr2d_gas *gas) {
  if (!hr2di_geojson_member(medium, "absorption"))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "hr2d: medium: there is no absorption; 0 is no gas");
  hr2d_status status = hr2di_geojson_values(reader, "hr2d: medium", "absorption",
                                            hr2di_geojson_member(medium, "absorption"), DBL_MAX,
                                            &reader->reflectance, &gas->absorption_bands);
  if (!status)
    status = hr2di_geojson_values(reader, "hr2d: medium", "emission",
                                  hr2di_geojson_member(medium, "emission"), DBL_MAX,
                                  &reader->emission, &gas->emission_bands);
  if (!status) status = read_section(reader, hr2di_geojson_member(medium, "section"), gas);
  if (!status) status = read_given(reader, medium, "temperature", HR2D_HEAT_TEMPERATURE, gas);
  if (!status) status = read_given(reader, medium, "flux", HR2D_HEAT_FLUX, gas);
  return status;
}

/* κ alone: the gas is cold. */
static hr2d_status read_number(hr2di_geojson *reader, const json_t *json, hr2d_gas *gas) {
  return hr2di_geojson_values(reader, "hr2d", "medium", json, DBL_MAX, &reader->reflectance,
                              &gas->absorption_bands);
}

hr2d_status hr2di_geojson_medium(hr2di_geojson *reader, const json_t *members) {
  const json_t *json = hr2di_geojson_member(members, "medium");
  hr2d_gas gas = HR2D_GAS_INIT;
  if (!json) return HR2D_OK;
  const int whole = json_is_object(json);
  if (!whole && !json_is_number(json))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "hr2d: medium: must be a number or an object, not %s",
                              hr2di_geojson_kind(json));
  hr2d_status status =
      whole ? read_members(reader, json, &gas) : read_number(reader, json, &gas);
  if (status) return status;
  gas.absorption = reader->reflectance.value;
  gas.emission = reader->emission.value;
  return hr2di_scene_make_gas(reader->scene, &gas, &reader->gas);
}

void hr2di_geojson_give_medium(hr2di_geojson *reader) {
  if (!reader->gas) return;
  hr2di_alloc_free(reader->alloc, reader->scene->gas);
  reader->scene->gas = reader->gas;
  reader->gas = NULL;
}
