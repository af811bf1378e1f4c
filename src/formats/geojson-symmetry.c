/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mirrors and the period of a GeoJSON file.  A mirror is a feature of one segment, with no
   properties of a surface. */
#include <hr2d/symmetry.h>
#include <math.h>
#include <string.h>

#include "formats/geojson-impl.h"
#include "scene/scene-impl.h"

hr2d_status hr2di_geojson_period(hr2di_geojson *reader, const json_t *members) {
  const json_t *json = hr2di_geojson_member(members, "period");
  const json_t *x = json_array_get(json, 0), *y = json_array_get(json, 1);
  if (!json) return HR2D_OK;
  if (json_array_size(json) != 2 || !json_is_number(x) || !json_is_number(y))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "hr2d: period: must be [dx, dy], from a patch to its next image");
  reader->period = (hr2d_point){json_number_value(x), json_number_value(y)};
  reader->periodic = 1;
  return HR2D_OK;
}

static hr2d_status check_mirror(hr2di_geojson *reader, const json_t *properties) {
  static const char *const surface[] = {"emission",   "reflectance", "transmittance",
                                        "emissivity", "temperature", "flux",
                                        "heat",       "shield",      "back"};
  for (size_t k = 0; k < sizeof surface / sizeof *surface; k++)
    if (hr2di_geojson_member(properties, surface[k]))
      return hr2di_message_fail(
          reader->message, HR2D_ESCENE,
          "%s: %s: a mirror is a line of symmetry, not a surface: it takes "
          "no light and gives none",
          reader->label, surface[k]);
  return HR2D_OK;
}

hr2d_status hr2di_geojson_sides(hr2di_geojson *reader, const json_t *properties) {
  const json_t *json = hr2di_geojson_member(properties, "sides");
  const char *word = json_string_value(json);
  reader->patch.sides = HR2D_SIDES_FRONT;
  reader->is_mirror = 0;
  if (!json || (word && strcmp(word, "front") == 0)) return HR2D_OK;
  reader->is_mirror = word && strcmp(word, "mirror") == 0;
  if (reader->is_mirror) return check_mirror(reader, properties);
  reader->patch.sides = HR2D_SIDES_BOTH;
  if (word && strcmp(word, "both") == 0) return HR2D_OK;
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                            "%s: sides: must be \"front\", \"both\" or \"mirror\"",
                            reader->label);
}

hr2d_status hr2di_geojson_add_mirror(hr2di_geojson *reader, hr2d_point a, hr2d_point b) {
  if (reader->segments != 1)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "%s: a mirror is a LineString of two positions", reader->label);
  if (!isfinite(a.x) || !isfinite(a.y) || !isfinite(b.x) || !isfinite(b.y))
    return hr2di_message_fail(reader->message, HR2D_ESCENE, "%s: a coordinate is not finite",
                              reader->label);
  if (hr2d_scene_mirrors(reader->scene) + reader->mirrors >= HR2DI_MIRRORS)
    return hr2di_message_fail(reader->message, HR2D_EUNSUPPORTED,
                              "%s: more than %d mirrors are not supported", reader->label,
                              HR2DI_MIRRORS);
  reader->mirror[reader->mirrors++] = (hr2d_segment){a, b};
  return HR2D_OK;
}

void hr2di_geojson_give_symmetry(hr2di_geojson *reader) {
  for (size_t k = 0; k < reader->mirrors; k++)
    hr2d_scene_add_mirror(reader->scene, reader->mirror[k]);
  if (reader->periodic) hr2d_scene_set_period(reader->scene, reader->period);
}
