/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gases of a GeoJSON file: "medium" in its "hr2d", and of features whose polygons they
 * fill.
 */
#include <float.h>
#include <stdio.h>
#include <string.h>

#include "base/alloc.h"
#include "formats/geojson-impl.h"
#include "scene/scene-impl.h"

/* Where the medium under way stands: hr2d, or a feature. */
static const char *place_of(const hr2di_geojson *reader) {
  return reader->is_gas ? reader->label : "hr2d";
}

static hr2d_status refuse(hr2di_geojson *reader, const char *why) {
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "%s: medium: %s", place_of(reader),
                            why);
}

static hr2d_status read_section(hr2di_geojson *reader, const json_t *json, hr2d_gas *gas) {
  const char *text = json_string_value(json);
  if (!json) return HR2D_OK; /* as it is */
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
                              "%s: medium: %s: must be a number, not %s", place_of(reader),
                              name, hr2di_geojson_kind(json));
  if (gas->given != HR2D_HEAT_NONE)
    return refuse(reader, "both a temperature and a flux are given");
  gas->given = heat;
  gas->value = json_number_value(json);
  return HR2D_OK;
}

/* Numbers become those of an own array, as the reader has one for each name. */
static hr2d_status read_members(hr2di_geojson *reader, const json_t *medium, hr2d_gas *gas) {
  char place[HR2DI_PLACE_SIZE];
  snprintf(place, sizeof place, "%s: medium", place_of(reader));
  if (!hr2di_geojson_member(medium, "absorption"))
    return refuse(reader, "there is no absorption; 0 is no gas");
  hr2d_status status = hr2di_geojson_values(reader, place, "absorption",
                                            hr2di_geojson_member(medium, "absorption"), DBL_MAX,
                                            &reader->reflectance, &gas->absorption_bands);
  if (!status)
    status = hr2di_geojson_values(reader, place, "emission",
                                  hr2di_geojson_member(medium, "emission"), DBL_MAX,
                                  &reader->emission, &gas->emission_bands);
  if (!status) status = read_section(reader, hr2di_geojson_member(medium, "section"), gas);
  if (!status) status = read_given(reader, medium, "temperature", HR2D_HEAT_TEMPERATURE, gas);
  if (!status) status = read_given(reader, medium, "flux", HR2D_HEAT_FLUX, gas);
  return status;
}

/* κ alone: the gas is cold. */
static hr2d_status read_number(hr2di_geojson *reader, const json_t *json, hr2d_gas *gas) {
  return hr2di_geojson_values(reader, place_of(reader), "medium", json, DBL_MAX,
                              &reader->reflectance, &gas->absorption_bands);
}

static hr2d_status give(hr2di_geojson *reader, const hr2d_gas *gas) {
  hr2di_gas *made;
  hr2d_status status = hr2di_scene_make_gas(reader->scene, gas, &made);
  if (status) return status;
  status = hr2di_gases_take(&reader->gases, reader->scene, made);
  if (status) hr2di_alloc_free(reader->alloc, made);
  return status;
}

/* A medium, with values in arrays of the reader. */
static hr2d_status read_medium(hr2di_geojson *reader, const json_t *json, hr2d_gas *gas) {
  const int whole = json_is_object(json);
  if (!whole && !json_is_number(json))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: medium: must be a number or an object, not %s",
                              place_of(reader), hr2di_geojson_kind(json));
  const hr2d_status status =
      whole ? read_members(reader, json, gas) : read_number(reader, json, gas);
  gas->absorption = reader->reflectance.value;
  gas->emission = reader->emission.value;
  return status;
}

hr2d_status hr2di_geojson_medium(hr2di_geojson *reader, const json_t *members) {
  const json_t *json = hr2di_geojson_member(members, "medium");
  hr2d_gas gas = HR2D_GAS_INIT;
  if (!json) return HR2D_OK;
  const hr2d_status status = read_medium(reader, json, &gas);
  return status ? status : give(reader, &gas);
}

/* A section that is not said is that of the gas before. */
hr2d_status hr2di_geojson_region(hr2di_geojson *reader, const json_t *properties) {
  const json_t *json = hr2di_geojson_member(properties, "medium");
  reader->is_gas = json != NULL;
  if (!json) return HR2D_OK;
  reader->fills = (hr2d_gas)HR2D_GAS_INIT;
  if (reader->gases.count) reader->fills.section = reader->gases.gas[0]->section;
  return read_medium(reader, json, &reader->fills);
}

hr2d_status hr2di_geojson_add_region(hr2di_geojson *reader, size_t points) {
  reader->fills.border = reader->point;
  reader->fills.border_points = points;
  return give(reader, &reader->fills);
}

hr2d_status hr2di_geojson_prepare_medium(hr2di_geojson *reader) {
  hr2di_gases *of = &reader->scene->gases;
  if (!reader->gases.count) return HR2D_OK;
  if (of->count && of->gas[0]->section != reader->gases.gas[0]->section)
    return refuse(reader, "its section is another one than that of a gas of the scene");
  if (hr2di_alloc_reserve(reader->alloc, &of->gas, &of->capacity,
                          of->count + reader->gases.count, sizeof(hr2di_gas *)))
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "hr2d: medium: out of memory");
  return HR2D_OK;
}

/* A gas without a border is instead of that of the scene; others come on top. */
void hr2di_geojson_give_medium(hr2di_geojson *reader) {
  hr2di_gases *to = &reader->scene->gases;
  for (size_t k = 0; k < reader->gases.count; k++) {
    hr2di_gas *gas = reader->gases.gas[k];
    const size_t around =
        gas->border_points ? HR2DI_NO_GAS : hr2di_scene_gas_around(reader->scene);
    if (around == HR2DI_NO_GAS) {
      to->gas[to->count++] = gas;
      continue;
    }
    hr2di_alloc_free(reader->alloc, to->gas[around]);
    to->gas[around] = gas;
  }
  reader->gases.count = 0;
}
