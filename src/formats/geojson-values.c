/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values of a GeoJSON file: their kinds, members of objects, numbers per band. */
#include <float.h>
#include <jansson.h>

#include "base/alloc.h"
#include "formats/geojson-impl.h"

static const char *const kinds[] = {
    [JSON_OBJECT] = "an object", [JSON_ARRAY] = "an array", [JSON_STRING] = "a string",
    [JSON_INTEGER] = "a number", [JSON_REAL] = "a number",  [JSON_TRUE] = "true",
    [JSON_FALSE] = "false",      [JSON_NULL] = "null",
};

const char *hr2di_geojson_kind(const json_t *json) {
  return json ? kinds[json_typeof(json)] : "missing";
}

const json_t *hr2di_geojson_member(const json_t *object, const char *key) {
  const json_t *member = json_object_get(object, key);
  return json_is_null(member) ? NULL : member;
}

static hr2d_status check_value(hr2di_geojson *reader, const char *place, const char *key,
                               const json_t *json, double max) {
  if (!json_is_number(json))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: %s: must be a number or an array of numbers, not %s%s",
                              place, key, hr2di_geojson_kind(json),
                              json_is_string(json) ? ": leave out the quotation marks" : "");
  const double value = json_number_value(json);
  if (value >= 0 && value <= max) return HR2D_OK;
  if (max < DBL_MAX)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "%s: %s: must be between 0 and %g, not %.17g%s", place, key, max,
                              value, value > 1 && value <= 100 ? "; 1 is 100 %" : "");
  return hr2di_message_fail(reader->message, HR2D_ESCENE,
                            "%s: %s: must not be negative, not %g", place, key, value);
}

hr2d_status hr2di_geojson_values(hr2di_geojson *reader, const char *place, const char *key,
                                 const json_t *json, double max, hr2di_values *values,
                                 size_t *count) {
  *count = 0;
  if (!json) return HR2D_OK;
  const int array = json_is_array(json);
  const size_t size = array ? json_array_size(json) : 1;
  if (!size)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: %s: must have a value, not be an empty array", place, key);
  if (hr2di_alloc_reserve(reader->alloc, &values->value, &values->capacity, size,
                          sizeof *values->value))
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "%s: out of memory", place);
  for (size_t k = 0; k < size; k++) {
    const json_t *item = array ? json_array_get(json, k) : json;
    hr2d_status status = hr2di_watch_work(reader->watch, 1);
    if (status) return status;
    status = check_value(reader, place, key, item, max);
    if (status) return status;
    values->value[k] = json_number_value(item);
  }
  *count = size;
  return HR2D_OK;
}
