/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A GeoJSON geometry: makes patches of lines and rings, and turns the fronts of rings in or out
   as they should be. */
#include <float.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/alloc.h"
#include "formats/geojson-impl.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* A line keeps its direction; a ring is reversed if its fronts look to the wrong side. */
typedef enum role { LINE, OUTER, HOLE } role;

/* A list of positions, and its place for messages: feature 3 ("hall"): polygon 2, ring 1. */
typedef struct path {
  const json_t *positions;
  role role;
  char place[HR2DI_PLACE_SIZE];
} path;

static const json_t *number_at(const json_t *position, size_t k) {
  return json_array_get(position, k);
}

/* What tools write where they have no position: null, or null for x or y. */
static int is_missing(const json_t *position) {
  return json_is_null(position) ||
         (json_array_size(position) >= 2 &&
          (json_is_null(number_at(position, 0)) || json_is_null(number_at(position, 1))));
}

static hr2d_status read_position(hr2di_geojson *reader, const path *p, size_t k,
                                 hr2d_point *point) {
  const json_t *position = json_array_get(p->positions, k);
  const size_t size = json_array_size(position);
  int numbers = size >= 2;
  for (size_t m = 0; m < size; m++)
    numbers &= json_is_number(number_at(position, m)) ||
               (m > 1 && json_is_null(number_at(position, m)));
  if (!numbers)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: position %zu: must be an array of two or more numbers",
                              p->place, k + 1);
  if (size > 2 && json_number_value(number_at(position, 2)) != 0)
    hr2di_notes_add(&reader->notes, HR2D_WARNING_ALTITUDE, "", p->place,
                    "a scene is a section of the plane: x and y are its coordinates");
  *point = (hr2d_point){json_number_value(number_at(position, 0)),
                        json_number_value(number_at(position, 1))};
  return HR2D_OK;
}

static double altitude(const path *p, size_t k) {
  return json_number_value(number_at(json_array_get(p->positions, k), 2));
}

/* The positions of a path that were read: the number of the last one, and whether some have two
   numbers and some have more. */
typedef struct progress {
  size_t kept, last;
  int flat, deep;
} progress;

static size_t min_positions(const path *p) {
  return p->role == LINE ? 2 : 4;
}

/* Keeps a position unless it repeats the last one. */
static hr2d_status keep_position(hr2di_geojson *reader, const path *p, size_t k, progress *at) {
  hr2d_point point;
  const hr2d_status status = read_position(reader, p, k, &point);
  if (status) return status;
  const int same = at->kept && hr2di_point_same(reader->point[at->kept - 1], point);
  if (same && altitude(p, at->last) != altitude(p, k))
    return hr2di_message_fail(
        reader->message, HR2D_ESCENE,
        "%s: segment %zu has no length: positions %zu and %zu are the same in x and y; third "
        "numbers are not used",
        p->place, at->kept, at->last + 1, k + 1);
  const int deep = json_array_size(json_array_get(p->positions, k)) > 2;
  at->flat |= !deep;
  at->deep |= deep;
  at->last = k;
  if (same)
    hr2di_notes_add(&reader->notes, HR2D_WARNING_SKIPPED, "position", p->place,
                    "a position repeats the one before it, and is left out");
  else
    reader->point[at->kept++] = point;
  return HR2D_OK;
}

/* A line or a ring all of whose positions are one place is no more than a repeated position, as
   simplification leaves of what is small. */
static hr2d_status check_kept(hr2di_geojson *reader, const path *p, const progress *at) {
  if (at->kept > 1 && at->kept < min_positions(p))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: needs %zu positions or more, has %zu without those that are "
                              "null or repeat the one before",
                              p->place, min_positions(p), at->kept);
  if (at->flat && at->deep)
    hr2di_notes_add(&reader->notes, HR2D_WARNING_ALTITUDE, "mixed", p->place,
                    "decimals have a point, not a comma");
  if (p->role != LINE && at->kept &&
      !hr2di_point_same(reader->point[0], reader->point[at->kept - 1]))
    return hr2di_message_fail(
        reader->message, HR2D_ESYNTAX,
        "%s: a ring must be closed: its last position must repeat the first", p->place);
  return HR2D_OK;
}

/* Reads the positions that differ from the one before them. */
static hr2d_status read_points(hr2di_geojson *reader, const path *p, size_t *count) {
  const size_t n = json_array_size(p->positions);
  progress at = {0, 0, 0, 0};
  if (!json_is_array(p->positions))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: coordinates: must be an array of positions, not %s",
                              p->place, hr2di_geojson_kind(p->positions));
  if (n < min_positions(p))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: needs %zu positions or more, has %zu", p->place,
                              min_positions(p), n);
  if (hr2di_alloc_reserve(reader->alloc, &reader->point, &reader->point_capacity, n,
                          sizeof *reader->point))
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "%s: out of memory", p->place);
  for (size_t k = 0; k < n; k++) {
    hr2d_status status = hr2di_watch_work(reader->watch, 2);
    if (status) return status;
    if (is_missing(json_array_get(p->positions, k)))
      hr2di_notes_add(&reader->notes, HR2D_WARNING_SKIPPED, "null", p->place,
                      "a position is null, and is left out: its neighbours are joined");
    else
      status = keep_position(reader, p, k, &at);
    if (status) return status;
  }
  *count = at.kept;
  return check_kept(reader, p, &at);
}

/* Twice the signed area of a ring, as a fan of triangles around its first point; 0 if rounding
   leaves the sign open.  Each triangle has full relative accuracy, so a convex ring has it,
   too, however thin and far from the origin it is.  For other rings the error, in
   roundings, is at most the number of triangles times the sum of their magnitudes.  Coordinates
   are scaled against overflow. */
static double ring_area(const hr2d_point *point, size_t n) {
  double largest = 0, area = 0, magnitude = 0;
  int exponent;
  for (size_t k = 0; k < n; k++)
    largest = fmax(largest, fmax(fabs(point[k].x), fabs(point[k].y)));
  frexp(largest, &exponent);
  hr2d_point corner[3];
  for (size_t k = 0; k + 1 < n; k++) {
    corner[k < 2 ? k : 2] =
        (hr2d_point){ldexp(point[k].x, -exponent), ldexp(point[k].y, -exponent)};
    if (k < 2) continue;
    const double triangle = hr2di_orient(corner[0], corner[1], corner[2]);
    area += triangle;
    magnitude += fabs(triangle);
    corner[1] = corner[2];
  }
  return fabs(area) > 8 * (double)n * DBL_EPSILON * magnitude ? area : 0;
}

/* Names a patch NAME, or NAME/k if the feature has several segments. */
static hr2d_status set_name(hr2di_geojson *reader, hr2d_patch *patch) {
  if (!patch->name || reader->segments == 1) return HR2D_OK;
  const size_t digits = 24;
  if (hr2di_alloc_reserve(reader->alloc, &reader->name, &reader->name_capacity,
                          strlen(patch->name) + digits, 1))
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "%s: out of memory", reader->label);
  snprintf(reader->name, reader->name_capacity, "%s/%zu", patch->name, reader->added + 1);
  patch->name = reader->name;
  return HR2D_OK;
}

/* The first patch of a feature, or one that is like it. */
static hr2d_status add_side(hr2di_geojson *reader, const hr2d_patch *patch,
                            const hr2d_thermal *thermal, size_t like) {
  if (reader->added) return hr2di_scene_add_alike(reader->scene, patch, like);
  return thermal->given ? hr2d_scene_add_thermal(reader->scene, patch, thermal, NULL)
                        : hr2d_scene_add(reader->scene, patch, NULL);
}

/* The back of the patch that was added last. */
static hr2d_status add_back(hr2di_geojson *reader, const hr2d_patch *front) {
  const size_t number = hr2d_scene_patches(reader->scene) - 1;
  const char *name = hr2d_scene_name(reader->scene, number);
  hr2d_patch patch = reader->back;
  char *made = hr2di_alloc(reader->alloc, strlen(name) + sizeof " (back)", 1);
  if (!made) return hr2di_message_fail(reader->message, HR2D_ENOMEM, "out of memory");
  sprintf(made, "%s (back)", name);
  patch.a = front->b;
  patch.b = front->a;
  patch.sides = HR2D_SIDES_FRONT;
  patch.name = made;
  const hr2d_status status = add_side(reader, &patch, &reader->back_thermal, reader->first + 1);
  hr2di_alloc_free(reader->alloc, made);
  return status;
}

/* Of patches that were added: which feature they are of, unless it has a name. */
static void mark(const hr2di_geojson *reader, size_t first, int looks_in) {
  for (size_t k = first; k < reader->scene->patches; k++) {
    reader->scene->patch[k].looks_in = (unsigned char)looks_in;
    if (!reader->patch.name && reader->number < UINT32_MAX)
      reader->scene->patch[k].feature = (uint32_t)reader->number;
  }
}

static hr2d_status add_segment(hr2di_geojson *reader, hr2d_point a, hr2d_point b) {
  hr2d_patch patch = reader->patch;
  hr2d_status status = set_name(reader, &patch);
  if (status) return status;
  patch.a = a;
  patch.b = b;
  status = hr2di_watch_work(reader->watch, 4);
  if (status) return status;
  if (reader->has_back) patch.sides = HR2D_SIDES_FRONT;
  if (!reader->added) reader->first = hr2d_scene_patches(reader->scene);
  status = add_side(reader, &patch, &reader->thermal, reader->first);
  if (!status && reader->has_back) status = add_back(reader, &patch);
  reader->added++;
  if (!status || status == HR2D_ENOMEM) return status;
  return hr2di_message_fail(reader->message, status, "%s: %s", reader->label,
                            reader->message->text);
}

/* The border of a gas is one ring; the last of its points is the first. */
static hr2d_status add_region(hr2di_geojson *reader, const path *p, size_t points) {
  if (p->role == LINE)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: medium: a gas fills a Polygon, and this is a line",
                              p->place);
  if (p->role == HOLE)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: medium: the border of a gas has no holes: leave this one "
                              "out, and add what fills it as a gas after this one",
                              p->place);
  return hr2di_geojson_add_region(reader, points - 1);
}

static hr2d_status add_path(hr2di_geojson *reader, const path *p) {
  size_t n = 0;
  int reverse = 0;
  hr2d_status status = read_points(reader, p, &n);
  if (status || n < 2) return status;
  if (p->role != LINE) {
    const double area = ring_area(reader->point, n);
    if (area == 0)
      return hr2di_message_fail(reader->message, HR2D_ESCENE, "%s: the ring encloses no area",
                                p->place);
    /* Counter-clockwise, fronts look into the ring. */
    const int search_in = (p->role == OUTER) != reader->faces_out;
    reverse = (area > 0) != search_in;
  }
  if (reader->is_gas) return add_region(reader, p, n);
  if (reader->is_mirror)
    return hr2di_geojson_add_mirror(reader, reader->point[0], reader->point[1]);
  const size_t first = reader->scene->patches;
  for (size_t k = 1; !status && k < n; k++)
    status = add_segment(reader, reader->point[reverse ? k : k - 1],
                         reader->point[reverse ? k - 1 : k]);
  mark(reader, first, p->role != LINE && !reader->faces_out);
  return status;
}

/* `prefix` is "polygon 2" in a MultiPolygon, else "". */
static hr2d_status add_polygon(hr2di_geojson *reader, const json_t *rings, const char *prefix) {
  path p;
  if (json_array_size(rings) == 0)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s%s%s: coordinates: must be an array of rings, not %s",
                              reader->label, *prefix ? ": " : "", prefix,
                              json_is_array(rings) ? "empty" : hr2di_geojson_kind(rings));
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; !status && k < json_array_size(rings); k++) {
    p.positions = json_array_get(rings, k);
    p.role = k ? HOLE : OUTER;
    snprintf(p.place, sizeof p.place, "%s: %s%sring %zu", reader->label, prefix,
             *prefix ? ", " : "", k + 1);
    status = add_path(reader, &p);
  }
  return status;
}

static hr2d_status add_line(hr2di_geojson *reader, const json_t *positions,
                            const char *prefix) {
  path p = {.positions = positions, .role = LINE};
  snprintf(p.place, sizeof p.place, "%s%s%s", reader->label, *prefix ? ": " : "", prefix);
  return add_path(reader, &p);
}

typedef struct shape {
  const char *type;
  int multi, polygon, point;
} shape;

static const shape shapes[] = {{"LineString", 0, 0, 0}, {"MultiLineString", 1, 0, 0},
                               {"Polygon", 0, 1, 0},    {"MultiPolygon", 1, 1, 0},
                               {"Point", 0, 0, 1},      {"MultiPoint", 1, 0, 1}};

static const shape *find_shape(const char *type) {
  for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
    if (!strcmp(type, shapes[k].type)) return &shapes[k];
  return NULL;
}

static int is_collection(const char *type) {
  return !strcmp(type, "GeometryCollection");
}

int hr2di_geojson_is_geometry(const json_t *json) {
  const char *type = json_string_value(json_object_get(json, "type"));
  return type && (find_shape(type) || is_collection(type));
}

/* 1 for a single segment; for more than one any number above 1, as only this matters. */
static size_t count_segments(const json_t *geometry) {
  const json_t *members = json_object_get(geometry, "geometries");
  while (json_array_size(members) == 1) {
    geometry = json_array_get(members, 0);
    members = json_object_get(geometry, "geometries");
  }
  const char *type = json_string_value(json_object_get(geometry, "type"));
  const json_t *coordinates = json_object_get(geometry, "coordinates");
  const shape *s = type ? find_shape(type) : NULL;
  if (!s || s->polygon || (s->multi && json_array_size(coordinates) != 1)) return 2;
  return json_array_size(s->multi ? json_array_get(coordinates, 0) : coordinates) == 2 ? 1 : 2;
}

static hr2d_status add_parts(hr2di_geojson *reader, const json_t *parts, const shape *s) {
  char prefix[40];
  if (json_array_size(parts) == 0)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: coordinates: must be an array of %s, not %s", reader->label,
                              s->polygon ? "polygons" : "lines",
                              json_is_array(parts) ? "empty" : hr2di_geojson_kind(parts));
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; !status && k < json_array_size(parts); k++) {
    snprintf(prefix, sizeof prefix, "%s %zu", s->polygon ? "polygon" : "line", k + 1);
    status = (s->polygon ? add_polygon : add_line)(reader, json_array_get(parts, k), prefix);
  }
  return status;
}

static hr2d_status add_shape(hr2di_geojson *reader, const json_t *coordinates, const shape *s) {
  if (s->point || json_is_null(coordinates) ||
      (json_is_array(coordinates) && json_array_size(coordinates) == 0)) {
    hr2di_notes_add(&reader->notes, HR2D_WARNING_SKIPPED, s->point ? "point" : "empty",
                    reader->label,
                    s->point ? "a point is no wall, and is left out"
                             : "a geometry has no positions, and adds no patch");
    return HR2D_OK;
  }
  if (reader->segments > 1 && reader->patch.name &&
      strlen(reader->patch.name) > HR2DI_MOST_NAME)
    return hr2di_message_fail(
        reader->message, HR2D_ESYNTAX,
        "%s: name: must not have more than %d bytes where it is for several "
        "segments",
        reader->label, HR2DI_MOST_NAME);
  if (s->multi) return add_parts(reader, coordinates, s);
  return (s->polygon ? add_polygon : add_line)(reader, coordinates, "");
}

static hr2d_status add_geometry(hr2di_geojson *reader, const json_t *geometry);

/* What a part of the feature is made of has the properties of the feature, and names that go on
   where those of the part before end.  Messages say which part they mean.  A collection in a
   collection is no deeper than jansson reads. */
static hr2d_status add_collection(hr2di_geojson *reader, const json_t *geometries) {
  const size_t label = strlen(reader->label);
  if (!json_is_array(geometries))
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: geometries: must be an array of geometries, not %s",
                              reader->label, hr2di_geojson_kind(geometries));
  if (json_array_size(geometries) == 0) return add_geometry(reader, NULL);
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; !status && k < json_array_size(geometries); k++) {
    snprintf(reader->label + label, sizeof reader->label - label, ": geometry %zu", k + 1);
    const json_t *geometry = json_array_get(geometries, k);
    status = hr2di_watch_work(reader->watch, 4);
    if (!status) status = add_geometry(reader, json_is_null(geometry) ? NULL : geometry);
  }
  reader->label[label] = '\0';
  return status;
}

static hr2d_status add_geometry(hr2di_geojson *reader, const json_t *geometry) {
  if (!geometry) {
    hr2di_notes_add(&reader->notes, HR2D_WARNING_SKIPPED, "empty", reader->label,
                    "a geometry has no positions, and adds no patch");
    return HR2D_OK;
  }
  const char *type = json_string_value(json_object_get(geometry, "type"));
  if (!type)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: geometry: must be an object with a \"type\"", reader->label);
  if (is_collection(type))
    return add_collection(reader, json_object_get(geometry, "geometries"));
  const shape *s = find_shape(type);
  if (!s)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "%s: geometry: %s has no patches; use LineString, Polygon, "
                              "MultiLineString, MultiPolygon or a GeometryCollection of them",
                              reader->label, hr2di_message_quote(type).text);
  return add_shape(reader, json_object_get(geometry, "coordinates"), s);
}

hr2d_status hr2di_geojson_geometry(hr2di_geojson *reader, const json_t *geometry) {
  reader->segments = count_segments(geometry);
  reader->added = 0;
  return add_geometry(reader, geometry);
}
