/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Continuous skies of a GeoJSON file: an object of hr2d_sky's members, or one for each band. */
#include <hr2d/sky.h>
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "formats/geojson-impl.h"
#include "scene/scene-impl.h"
#include "scene/sky-model.h"

/* W/m², the mean over the year. */
#define EXTRATERRESTRIAL 1361

static hr2d_status refuse(hr2di_geojson *reader, hr2d_status status, const char *why) {
  return hr2di_message_fail(reader->message, status, "hr2d: sky: %s", why);
}

/* Leaves *to if there is no such member. */
static hr2d_status read_number(hr2di_geojson *reader, const json_t *of, const char *key,
                               double *to) {
  const json_t *json = hr2di_geojson_member(of, key);
  if (!json) return HR2D_OK;
  if (!json_is_number(json))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "hr2d: sky: %s: must be a number, not %s", key,
                              hr2di_geojson_kind(json));
  *to = json_number_value(json);
  return HR2D_OK;
}

/* *part becomes the object of a member; NULL if there is none. */
static hr2d_status find_object(hr2di_geojson *reader, const json_t *of, const char *key,
                               const json_t **part) {
  *part = hr2di_geojson_member(of, key);
  if (!*part || json_is_object(*part)) return HR2D_OK;
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                            "hr2d: sky: %s: must be an object, not %s", key,
                            hr2di_geojson_kind(*part));
}

static hr2d_status read_cie(hr2di_geojson *reader, const json_t *json, hr2d_sky *sky) {
  const json_t *member = hr2di_geojson_member(json, "cie");
  const double type = json_number_value(member);
  if (!member) return HR2D_OK;
  if (json_is_number(member) && type >= 1 && type <= 16 && type == floor(type))
    return hr2d_sky_cie((int)type, sky);
  return refuse(reader, HR2D_ESCENE, "cie: must be a type from 1 to 16");
}

/* From clearness and brightness, or from irradiances; then *diffuse is that of the sky. */
static hr2d_status read_perez(hr2di_geojson *reader, const json_t *json, hr2d_sky *sky,
                              double *diffuse) {
  double clearness = NAN, brightness = NAN, direct = 0, outside = EXTRATERRESTRIAL;
  const json_t *perez;
  hr2d_status status = find_object(reader, json, "perez", &perez);
  if (status || !perez) return status;
  if (hr2di_geojson_member(json, "cie"))
    return refuse(reader, HR2D_ESCENE, "both a type of CIE and the model of Perez are given");
  status = read_number(reader, perez, "clearness", &clearness);
  if (!status) status = read_number(reader, perez, "brightness", &brightness);
  if (!status) status = read_number(reader, perez, "direct", &direct);
  if (!status) status = read_number(reader, perez, "diffuse", diffuse);
  if (!status) status = read_number(reader, perez, "extraterrestrial", &outside);
  if (status) return status;
  if (!isnan(*diffuse))
    clearness = hr2d_sky_clearness(*diffuse, direct, outside, sky->sun_elevation, &brightness);
  status = hr2d_sky_perez(clearness, brightness, sky);
  if (status == HR2D_EINVAL)
    return refuse(reader, HR2D_ESCENE,
                  "perez: needs a clearness of 1 or more and a brightness, or a diffuse "
                  "irradiance above 0 and a direct one, and a sun_elevation in [0,90]");
  if (status)
    return refuse(reader, HR2D_ESCENE,
                  "perez: the model has no valid radiance there: a larger brightness may help");
  return HR2D_OK;
}

/* Of a sky without disc and band the radiance at the zenith is in proportion. */
static hr2d_status read_irradiance(hr2di_geojson *reader, const json_t *json, double diffuse,
                                   hr2d_sky *sky) {
  double zenith = NAN;
  hr2d_sky one = *sky;
  hr2d_status status = read_number(reader, json, "zenith", &zenith);
  if (!isnan(diffuse)) sky->irradiance = diffuse;
  if (!status) status = read_number(reader, json, "irradiance", &sky->irradiance);
  if (status || isnan(zenith)) return status;
  if (hr2di_geojson_member(json, "irradiance") || !isnan(diffuse))
    return refuse(reader, HR2D_ESCENE, "both an irradiance and a radiance at the zenith");
  one.irradiance = 1;
  sky->irradiance = zenith / hr2d_sky_radiance(&one, 90, 0);
  return HR2D_OK;
}

static hr2d_status read_parts(hr2di_geojson *reader, const json_t *json, hr2d_sky *sky) {
  const json_t *disc, *horizon;
  hr2d_status status = find_object(reader, json, "disc", &disc);
  if (!status) status = read_number(reader, disc, "irradiance", &sky->disc_irradiance);
  if (!status) status = read_number(reader, disc, "radius", &sky->disc_radius);
  if (!status) status = find_object(reader, json, "horizon", &horizon);
  if (!status) status = read_number(reader, horizon, "irradiance", &sky->horizon_irradiance);
  return status ? status : read_number(reader, horizon, "height", &sky->horizon_height);
}

static hr2d_status read_sky(hr2di_geojson *reader, const json_t *json, hr2d_sky *sky) {
  const struct {
    const char *key;
    double *to;
  } number[] = {{"a", &sky->a},
                {"b", &sky->b},
                {"c", &sky->c},
                {"d", &sky->d},
                {"e", &sky->e},
                {"g", &sky->g},
                {"section_azimuth", &sky->section_azimuth},
                {"tolerance", &sky->tolerance}};
  double diffuse = NAN;
  hr2d_status status = hr2di_watch_work(reader->watch, 4);
  if (!status) status = read_number(reader, json, "sun_elevation", &sky->sun_elevation);
  if (!status) status = read_number(reader, json, "sun_azimuth", &sky->sun_azimuth);
  if (!status) status = read_cie(reader, json, sky);
  if (!status) status = read_perez(reader, json, sky, &diffuse);
  for (size_t k = 0; k < sizeof number / sizeof *number && !status; k++)
    status = read_number(reader, json, number[k].key, number[k].to);
  if (!status) status = read_irradiance(reader, json, diffuse, sky);
  return status ? status : read_parts(reader, json, sky);
}

int hr2di_geojson_is_continuous_sky(const json_t *json) {
  return json_is_object(json) || json_is_object(json_array_get(json, 0));
}

hr2d_status hr2di_geojson_continuous_sky(hr2di_geojson *reader, const json_t *json) {
  const size_t bands = json_is_array(json) ? json_array_size(json) : 1;
  hr2d_sky *sky = hr2di_alloc(reader->alloc, bands, sizeof *sky);
  hr2d_status status = HR2D_OK;
  if (!sky) return hr2di_message_fail(reader->message, HR2D_ENOMEM, "hr2d: out of memory");
  for (size_t b = 0; b < bands && !status; b++) {
    const json_t *one = json_is_array(json) ? json_array_get(json, b) : json;
    sky[b] = (hr2d_sky)HR2D_SKY_INIT;
    status = json_is_object(one)
                 ? read_sky(reader, one, &sky[b])
                 : refuse(reader, HR2D_ESYNTAX, "must be an object for each band");
  }
  if (!status)
    status = hr2di_scene_make_sky(reader->scene, sky, bands, reader->watch, &reader->sky);
  hr2di_alloc_free(reader->alloc, sky);
  return status;
}
