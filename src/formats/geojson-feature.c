/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A GeoJSON feature: its properties, which hold for all of its patches. */
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "formats/geojson-impl.h"
#include "formats/geojson-meant.h"

static void set_label(hr2di_geojson *reader, size_t number, const char *name) {
  if (name && *name)
    snprintf(reader->label, sizeof reader->label, "feature %zu (%s)", number,
             hr2di_message_quote(name).text);
  else
    snprintf(reader->label, sizeof reader->label, "feature %zu", number);
}

/* Reads a property that is one of two words; *is_second becomes 1 for the second, else 0. */
static hr2d_status read_choice(hr2di_geojson *reader, const json_t *properties, const char *key,
                               const char *first, const char *second, int *is_second) {
  const json_t *json = hr2di_geojson_member(properties, key);
  const char *word = json_string_value(json);
  *is_second = word && strcmp(word, second) == 0;
  if (!json || *is_second || (word && strcmp(word, first) == 0)) return HR2D_OK;
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "%s: %s: must be \"%s\" or \"%s\"",
                            reader->label, key, first, second);
}

static hr2d_status check_type(hr2di_geojson *reader, const json_t *feature,
                              const json_t *properties) {
  const char *type = json_string_value(json_object_get(feature, "type"));
  if (!type || strcmp(type, "Feature") != 0)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: must be an object of \"type\" \"Feature\", or a geometry",
                              reader->label);
  if (properties && !json_is_object(properties))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: properties: must be an object, not %s", reader->label,
                              hr2di_geojson_kind(properties));
  return HR2D_OK;
}

hr2d_status hr2di_geojson_feature(hr2di_geojson *reader, const json_t *feature, size_t number) {
  const int bare = hr2di_geojson_is_geometry(feature);
  const json_t *properties = bare ? NULL : hr2di_geojson_member(feature, "properties");
  const json_t *named = hr2di_geojson_member(properties, "name");
  const char *name;
  hr2d_status status = hr2di_geojson_name(reader, named, &name);
  if (status) return status;

  reader->patch = (hr2d_patch)HR2D_PATCH_INIT;
  if (name && *name) reader->patch.name = name;
  set_label(reader, number, name);
  if (!bare) status = check_type(reader, feature, properties);
  if (!status && !bare) status = hr2di_geojson_note_feature(reader, feature);
  if (named && !name)
    hr2di_notes_add(&reader->notes, HR2D_WARNING_IGNORED, "name", reader->label,
                    "a name is a text or a number, or an object or a short array with one");
  if (!status) status = hr2di_geojson_region(reader, properties);
  if (!status && reader->is_gas)
    return hr2di_geojson_geometry(reader, hr2di_geojson_member(feature, "geometry"));
  if (!status) status = hr2di_geojson_surface(reader, properties);
  if (!status) status = hr2di_geojson_sides(reader, properties);
  if (!status) status = hr2di_geojson_back(reader, properties);
  if (!status)
    status = read_choice(reader, properties, "faces", "in", "out", &reader->faces_out);
  if (status) return status;
  return hr2di_geojson_geometry(reader,
                                bare ? feature : hr2di_geojson_member(feature, "geometry"));
}
