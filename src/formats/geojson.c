/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes from GeoJSON (RFC 7946 structure): the file and its collection. */
#include <float.h>
#include <hr2d/scene.h>
#include <jansson.h>
#include <string.h>

#include "base/alloc.h"
#include "formats/geojson-impl.h"
#include "formats/geojson-meant.h"
#include "formats/geojson-text.h"
#include "formats/scene-file.h"
#include "scene/scene-impl.h"

static hr2d_status read_scene_effects(hr2di_geojson *reader, const json_t *root,
                                      size_t *background_bands) {
  const json_t *members = hr2di_geojson_member(root, "hr2d");
  *background_bands = 0;
  if (!members) return HR2D_OK;
  if (!json_is_object(members))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "hr2d: must be an object, not %s",
                              hr2di_geojson_kind(members));
  hr2d_status status = hr2di_geojson_values(reader, "hr2d", "background",
                                            hr2di_geojson_member(members, "background"),
                                            DBL_MAX, &reader->background, background_bands);
  if (!status) status = hr2di_geojson_spectrum(reader, members, background_bands);
  if (!status) status = hr2di_geojson_sun(reader, members);
  if (!status) status = hr2di_geojson_sky(reader, members);
  if (!status) status = hr2di_geojson_period(reader, members);
  return status ? status : hr2di_geojson_medium(reader, members);
}

static int is_feature(const json_t *root) {
  const char *type = json_string_value(json_object_get(root, "type"));
  return (type && strcmp(type, "Feature") == 0) || hr2di_geojson_is_geometry(root);
}

/* Sets `features` to those of a collection. */
static hr2d_status find_features(hr2di_geojson *reader, const json_t *root, json_t **features) {
  const char *type = json_string_value(json_object_get(root, "type"));
  if (!type)
    return hr2di_message_fail(
        reader->message, HR2D_ESYNTAX, "not a GeoJSON FeatureCollection: %s",
        json_is_object(root) ? "\"type\" must be a string" : "the outermost value is an array");
  if (strcmp(type, "FeatureCollection") != 0)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "not a GeoJSON FeatureCollection: \"type\" is %s",
                              hr2di_message_quote(type).text);
  *features = json_object_get(root, "features");
  if (json_is_array(*features)) return HR2D_OK;
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "features: must be an array, not %s",
                            hr2di_geojson_kind(*features));
}

static hr2d_status read_features(hr2di_geojson *reader, json_t *features) {
  const size_t count = json_array_size(features);
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; !status && k < count; k++) {
    reader->watch->report.fraction = 0.5 + 0.5 * (double)k / (double)count;
    status = hr2di_watch_work(reader->watch, 4);
    reader->number = count > 1 ? k + 1 : 0;
    if (!status) status = hr2di_geojson_feature(reader, json_array_get(features, k), k + 1);
    /* Freed bit by bit: a large tree at once takes long, and cannot be stopped. */
    json_array_set_new(features, k, json_null());
  }
  return status;
}

/* The background is set last, so that no failure has to take it back, and then what cannot
   fail. A file without one leaves that of the scene as it is. */
static hr2d_status give_scene_effects(hr2di_geojson *reader, size_t background_bands) {
  hr2d_status status = hr2di_geojson_prepare_medium(reader);
  if (!status && background_bands)
    status =
        hr2d_scene_set_background(reader->scene, reader->background.value, background_bands);
  if (status) return status;
  if (reader->sun) {
    hr2di_scene_take_sun(reader->scene, reader->sun, reader->suns);
    reader->sun = NULL;
  }
  if (reader->sky.pieces) {
    hr2di_scene_take_sky(reader->scene, &reader->sky);
    reader->sky = (hr2di_sky){0};
  }
  hr2di_geojson_give_symmetry(reader);
  hr2di_geojson_give_medium(reader);
  *hr2di_scene_notes(reader->scene) = reader->notes;
  return HR2D_OK;
}

static hr2d_status read_collection(hr2di_geojson *reader, const json_t *root) {
  json_t *features = NULL;
  size_t background_bands;
  const int alone = is_feature(root); /* a feature or a geometry in the place of a collection */
  hr2d_status status = alone ? HR2D_OK : find_features(reader, root, &features);
  if (!status) status = hr2di_geojson_note_root(reader, root);
  if (!status) status = read_scene_effects(reader, root, &background_bands);
  if (!status)
    status = alone ? hr2di_geojson_feature(reader, root, 1) : read_features(reader, features);
  return status ? status : give_scene_effects(reader, background_bands);
}

hr2d_status hr2di_geojson_read(hr2d_scene *scene, const char *text, size_t size,
                               hr2di_watch *watch) {
  hr2di_geojson reader = {.scene = scene,
                          .alloc = hr2di_scene_allocator(scene),
                          .message = hr2di_scene_message(scene),
                          .watch = watch,
                          .notes = *hr2di_scene_notes(scene)};
  json_t *root;
  hr2d_status status = hr2di_geojson_load(text, size, &root, reader.message, watch);
  if (status) return status;
  status = read_collection(&reader, root);
  hr2di_geojson_end_spectrum(&reader, status);

  json_decref(root);
  hr2di_alloc_free(reader.alloc, reader.background.value);
  hr2di_alloc_free(reader.alloc, reader.sun);
  hr2di_gases_clear(&reader.gases, reader.alloc);
  hr2di_sky_clear(&reader.sky, reader.alloc);
  hr2di_alloc_free(reader.alloc, reader.emission.value);
  hr2di_alloc_free(reader.alloc, reader.reflectance.value);
  hr2di_alloc_free(reader.alloc, reader.transmittance.value);
  hr2di_alloc_free(reader.alloc, reader.back_emission.value);
  hr2di_alloc_free(reader.alloc, reader.back_reflectance.value);
  hr2di_alloc_free(reader.alloc, reader.back_transmittance.value);
  hr2di_alloc_free(reader.alloc, reader.point);
  hr2di_alloc_free(reader.alloc, reader.name);
  hr2di_alloc_free(reader.alloc, reader.written);
  return status;
}
