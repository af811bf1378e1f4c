/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The suns of a GeoJSON file: directions or bearings, and irradiances; and its sky. */
#include <jansson.h>

#include "base/alloc.h"
#include "formats/geojson-impl.h"
#include "scene/scene-impl.h"

static hr2d_status wrong_kind(hr2di_geojson *reader, const char *key, const char *what,
                              const json_t *json) {
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "hr2d: sun: %s: must be %s, not %s",
                            key, what, hr2di_geojson_kind(json));
}

static int is_position(const json_t *json) {
  return json_is_array(json) && json_array_size(json) == 2 &&
         json_is_number(json_array_get(json, 0)) && json_is_number(json_array_get(json, 1));
}

static hr2d_status read_direction(hr2di_geojson *reader, const json_t *json, hr2d_sun *sun) {
  if (!is_position(json))
    return wrong_kind(reader, "direction", "[dx, dy], or an array of these", json);
  sun->direction.x = json_number_value(json_array_get(json, 0));
  sun->direction.y = json_number_value(json_array_get(json, 1));
  return HR2D_OK;
}

static hr2d_status read_bearing(hr2di_geojson *reader, const json_t *json, hr2d_sun *sun) {
  if (!json_is_number(json))
    return wrong_kind(reader, "bearing", "a number of degrees, or an array of these", json);
  const hr2d_point e = hr2di_sky_direction(json_number_value(json));
  sun->direction = (hr2d_point){0 - e.x, 0 - e.y};
  return HR2D_OK;
}

/* Of directions, bearings or irradiances, with one for all or for each band. */
typedef struct list {
  const char *key;
  const json_t *json;
  int one; /* json is an item */
  size_t count;
} list;

static list list_of(const json_t *members, const char *key) {
  const json_t *json = hr2di_geojson_member(members, key);
  const int one = !json_is_array(json) || (key[0] == 'd' && is_position(json));
  return (list){key, json, one, one ? json != NULL : json_array_size(json)};
}

static const json_t *item_of(const list *l, size_t k) {
  return l->one ? l->json : json_array_get(l->json, l->count == 1 ? 0 : k);
}

static hr2d_status check_count(hr2di_geojson *reader, const list *l, size_t suns) {
  if (l->count == 1 || l->count == suns) return HR2D_OK;
  return hr2di_message_fail(reader->message, HR2D_ESCENE,
                            "hr2d: sun: %s has %zu values where there are %zu suns", l->key,
                            l->count, suns);
}

static hr2d_status read_sun(hr2di_geojson *reader, const list *ways, const list *irradiance,
                            size_t k) {
  hr2d_sun *sun = &reader->sun[k];
  const json_t *value = item_of(irradiance, k);
  if (!json_is_number(value))
    return wrong_kind(reader, "irradiance", "a number or an array of numbers", value);
  sun->irradiance = json_number_value(value);
  const hr2d_status status = ways->key[0] == 'd' ? read_direction(reader, item_of(ways, k), sun)
                                                 : read_bearing(reader, item_of(ways, k), sun);
  return status ? status : hr2di_scene_check_sun(reader->scene, sun, k);
}

static hr2d_status read_suns(hr2di_geojson *reader, const list *ways, const list *irradiance) {
  const size_t suns = ways->count > irradiance->count ? ways->count : irradiance->count;
  hr2d_status status = check_count(reader, ways, suns);
  if (!status) status = check_count(reader, irradiance, suns);
  if (status) return status;
  reader->sun = hr2di_alloc(reader->alloc, suns, sizeof *reader->sun);
  if (!reader->sun)
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "hr2d: out of memory");
  for (size_t k = 0; k < suns && !status; k++) {
    status = hr2di_watch_work(reader->watch, 2);
    if (!status) status = read_sun(reader, ways, irradiance, k);
  }
  reader->suns = suns;
  return status;
}

hr2d_status hr2di_geojson_sun(hr2di_geojson *reader, const json_t *members) {
  const json_t *sun = hr2di_geojson_member(members, "sun");
  if (!sun) return HR2D_OK;
  if (!json_is_object(sun))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "hr2d: sun: must be an object, not %s", hr2di_geojson_kind(sun));
  const list direction = list_of(sun, "direction"), bearing = list_of(sun, "bearing"),
             irradiance = list_of(sun, "irradiance");
  if (!direction.json == !bearing.json)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "hr2d: sun: needs a direction of its light or a bearing of the "
                              "sun, one of these");
  const list *ways = direction.json ? &direction : &bearing;
  if (ways->count == 0 || irradiance.count == 0)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "hr2d: sun: %s must have a value",
                              ways->count ? "irradiance" : ways->key);
  return read_suns(reader, ways, &irradiance);
}

/* [from, to, value], where the value may be an array with one for each band. */
static hr2d_status read_piece(hr2di_geojson *reader, const json_t *json, size_t k) {
  hr2di_sky *sky = &reader->sky;
  const json_t *value = json_array_get(json, 2);
  const size_t bands = json_is_array(value) ? json_array_size(value) : 1;
  if (!json_is_array(json) || json_array_size(json) != 3 ||
      !json_is_number(json_array_get(json, 0)) || !json_is_number(json_array_get(json, 1)))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "hr2d: sky: piece %zu must be [from, to, radiosity]", k);
  if (bands != 1 && bands != sky->bands)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "hr2d: sky: piece %zu has %zu bands where another one has %zu", k,
                              bands, sky->bands);
  sky->piece[k] = (hr2d_sky_piece){json_number_value(json_array_get(json, 0)),
                                   json_number_value(json_array_get(json, 1))};
  for (size_t b = 0; b < sky->bands; b++) {
    const json_t *item =
        json_is_array(value) ? json_array_get(value, bands == 1 ? 0 : b) : value;
    if (!json_is_number(item))
      return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                                "hr2d: sky: a radiosity must be a number, not %s",
                                hr2di_geojson_kind(item));
    sky->value[k * sky->bands + b] = json_number_value(item);
  }
  return hr2di_watch_work(reader->watch, 2 + sky->bands);
}

/* The bands of the piece that has most. */
static size_t bands_of(const json_t *sky) {
  size_t bands = 1;
  for (size_t k = 0; k < json_array_size(sky); k++) {
    const size_t count = json_array_size(json_array_get(json_array_get(sky, k), 2));
    if (count > bands) bands = count;
  }
  return bands;
}

static hr2d_status read_pieces(hr2di_geojson *reader, const json_t *json) {
  hr2di_sky *sky = &reader->sky;
  hr2d_status status = HR2D_OK;
  sky->pieces = json_array_size(json);
  sky->terms = 1;
  sky->bands = bands_of(json);
  sky->piece = hr2di_alloc(reader->alloc, sky->pieces, sizeof *sky->piece);
  sky->value = hr2di_alloc(reader->alloc, sky->pieces, sky->bands * sizeof *sky->value);
  if (!sky->piece || !sky->value)
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "hr2d: out of memory");
  for (size_t k = 0; k < sky->pieces && !status; k++)
    status = read_piece(reader, json_array_get(json, k), k);
  return status ? status : hr2di_scene_check_sky(reader->scene, sky);
}

hr2d_status hr2di_geojson_sky(hr2di_geojson *reader, const json_t *members) {
  const json_t *json = hr2di_geojson_member(members, "sky");
  if (!json) return HR2D_OK;
  if (hr2di_geojson_is_continuous_sky(json)) return hr2di_geojson_continuous_sky(reader, json);
  if (!json_is_array(json) || json_array_size(json) == 0)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "hr2d: sky: must be an array of [from, to, radiosity], not %s",
                              json_is_array(json) ? "an empty one" : hr2di_geojson_kind(json));
  if (json_array_size(json) > HR2DI_SKY_PIECES)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "hr2d: sky: %zu pieces are too many", json_array_size(json));
  return read_pieces(reader, json);
}
