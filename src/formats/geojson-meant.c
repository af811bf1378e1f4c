/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GeoJSON files may have members of any name, so that those that are not read cannot be errors.
   But "emissivity" on a wall is meant to change something. */
#include "formats/geojson-meant.h"

#include <stdio.h>
#include <string.h>

#define REFLECTANCE                                                                            \
  "write \"reflectance\": 1 - emissivity, or a \"temperature\", \"flux\" or \"heat\" beside "  \
  "it"
#define EMISSION "write \"emission\", power per scene length"
#define BANDS    "write \"reflectance\" as an array with a number for each band"
#define BOTH     "write \"sides\": \"both\""
#define FACES    "write \"faces\": \"in\" or \"out\""
#define GREY     "the property is called \"reflectance\""
#define KELVIN   "write \"temperature\" in kelvin, degrees Celsius + 273.15"
#define PANE     "write \"transmittance\", of a pane that scatters what passes through it"
#define CLEAR                                                                                  \
  "what passes through a pane is scattered, by \"transmittance\": refraction and "             \
  "clear glass are no part of this model"
#define DIFFUSE "walls reflect and emit diffusely: gloss is no part of this model"
#define AXIS                                                                                   \
  "a scene is a section across something long: bodies of revolution are no part "              \
  "of this model"
#define MIRROR "write \"sides\": \"mirror\" for a line of symmetry; walls reflect diffusely"
#define SUN    "light from a direction is a \"sun\" in the member \"hr2d\""
#define HEAT   "write \"flux\", the net heat flux that leaves, or \"emission\""
#define POWER                                                                                  \
  "write \"heat\", the net heat of the feature per length across the section, or "             \
  "\"emission\", power per scene length"

/* A name in small letters, the property that replaces it, or "" if there is none, and what to
   do. */
typedef struct meant {
  const char *name, *instead, *advice;
} meant;

static const meant properties_meant[] = {
    {"absorbance", "reflectance", "write \"reflectance\": 1 - absorptance"},
    {"absorptance", "reflectance", "write \"reflectance\": 1 - absorptance"},
    {"absorption", "reflectance", "write \"reflectance\": 1 - absorptance"},
    {"absorptivity", "reflectance", "write \"reflectance\": 1 - absorptivity"},
    {"albedo", "reflectance", GREY},
    {"axis", "", AXIS},
    {"axisymmetric", "", AXIS},
    {"axisymmetry", "", AXIS},
    {"brightness", "emission", EMISSION},
    {"celsius", "temperature", KELVIN},
    {"color", "reflectance", BANDS},
    {"colour", "reflectance", BANDS},
    {"double_sided", "sides", BOTH},
    {"doublesided", "sides", BOTH},
    {"emissive", "emission", EMISSION},
    {"emit", "emission", EMISSION},
    {"emittance", "emission", EMISSION},
    {"epsilon", "reflectance", REFLECTANCE},
    {"exitance", "emission", EMISSION},
    {"facing", "faces", FACES},
    {"gloss", "", DIFFUSE},
    {"glossiness", "", DIFFUSE},
    {"glossy", "", DIFFUSE},
    {"heat_flux", "flux", HEAT},
    {"heatflux", "flux", HEAT},
    {"illuminance", "emission", EMISSION},
    {"index_of_refraction", "transmittance", CLEAR},
    {"ior", "transmittance", CLEAR},
    {"irradiance", "emission", SUN},
    {"kelvin", "temperature", "the property is called \"temperature\""},
    {"luminance", "emission", EMISSION},
    {"luminosity", "emission", EMISSION},
    {"mirror", "sides", MIRROR},
    {"opacity", "transmittance", PANE},
    {"power", "emission", POWER},
    {"radiance", "emission", EMISSION},
    {"radiosity", "emission", EMISSION},
    {"reflection", "reflectance", GREY},
    {"reflective", "reflectance", GREY},
    {"reflectivity", "reflectance", GREY},
    {"refraction", "transmittance", CLEAR},
    {"refractive_index", "transmittance", CLEAR},
    {"rho", "reflectance", GREY},
    {"roughness", "", DIFFUSE},
    {"shininess", "", DIFFUSE},
    {"side", "sides", BOTH},
    {"specular", "", DIFFUSE},
    {"specular_fraction", "", DIFFUSE},
    {"specular_reflectance", "", DIFFUSE},
    {"specularity", "", DIFFUSE},
    {"tau", "transmittance", "the property is called \"transmittance\""},
    {"temp", "temperature", KELVIN},
    {"translucency", "transmittance", PANE},
    {"translucent", "transmittance", PANE},
    {"transmission", "transmittance", "the property is called \"transmittance\""},
    {"transmissivity", "transmittance", "the property is called \"transmittance\""},
    {"transparency", "transmittance", PANE},
    {"transparent", "transmittance", PANE},
    {"two_sided", "sides", BOTH},
    {"twosided", "sides", BOTH}};

/* Where the members of the format belong. */
static const char *const of_properties[] = {
    "back", "emission",    "emissivity", "faces", "flux",        "heat",         "medium",
    "name", "reflectance", "shield",     "sides", "temperature", "transmittance"};
static const char *const of_scene[] = {
    "background", "background_temperature", "medium", "period", "sky", "sun", "wavelengths",
    "weights"};

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* The key in small ASCII letters; longer keys than any in the tables are cut, and match none.
 */
typedef struct small {
  char text[32];
} small;

static small in_small_letters(const char *key) {
  small s = {{0}};
  for (size_t k = 0; k + 1 < sizeof s.text && key[k]; k++)
    s.text[k] = (char)(key[k] >= 'A' && key[k] <= 'Z' ? key[k] - 'A' + 'a' : key[k]);
  return s;
}

static const char *find(const char *const *names, size_t count, const char *key) {
  for (size_t k = 0; k < count; k++)
    if (!strcmp(names[k], key)) return names[k];
  return NULL;
}

/* A member of the format that is spelled otherwise, and is not there in its right spelling. */
static int note_spelling(hr2di_geojson *reader, const json_t *object, const char *place,
                         const char *key, const char *name) {
  static const char advice[] = "names have small letters";
  if (!name) return 0;
  if (strcmp(name, key) != 0 && !hr2di_geojson_member(object, name))
    hr2di_notes_add(&reader->notes, HR2D_WARNING_IGNORED, key, place, advice);
  return 1;
}

/* Emissivity takes part only beside a temperature or a flux. */
static int is_lonely(const json_t *properties, const char *key) {
  return !strcmp(key, "emissivity") && !hr2di_geojson_member(properties, "temperature") &&
         !hr2di_geojson_member(properties, "flux") &&
         !hr2di_geojson_member(properties, "heat") &&
         !hr2di_geojson_member(properties, "shield") &&
         !hr2di_geojson_member(properties, "reflectance");
}

/* Letters to change, add, leave out, or swap with the next one, between two names: at most
   `max`, or most + 1. */
static unsigned distance(const char *left, const char *right, unsigned max) {
  if (!*left || !*right) {
    const size_t rest = strlen(left) + strlen(right);
    return rest > max ? max + 1 : (unsigned)rest;
  }
  if (*left == *right) return distance(left + 1, right + 1, max);
  if (max == 0) return 1;
  unsigned min = distance(left + 1, right + 1, max - 1);
  const unsigned without = distance(left + 1, right, max - 1),
                 with = distance(left, right + 1, max - 1);
  if (without < min) min = without;
  if (with < min) min = with;
  if (left[0] == right[1] && left[1] == right[0]) {
    const unsigned swapped = distance(left + 2, right + 2, max - 1);
    if (swapped < min) min = swapped;
  }
  return min + 1;
}

/* Short words are near to too many others: "site" to "side", "tower" to "power".  Who mistypes
   a word has its first letter right. */
static int is_mistyped(const char *key, const char *name) {
  const size_t length = strlen(name);
  const unsigned max = length < 6 ? 0 : length < 8 ? 1 : 2;
  return max && key[0] == name[0] && distance(key, name, max) <= max;
}

/* Whether the feature has the property that a key was meant for. */
static int has(const json_t *properties, const char *name) {
  return *name && hr2di_geojson_member(properties, name);
}

static const meant *find_meant(const char *key) {
  for (size_t k = 0; k < COUNT(properties_meant); k++)
    if (!strcmp(properties_meant[k].name, key)) return &properties_meant[k];
  return NULL;
}

/* Of the words of the format those that are long enough to be told when they are mistyped. */
static const meant properties_typed[] = {
    {"emission", "emission", "the property is called \"emission\""},
    {"emissivity", "emissivity", "the property is called \"emissivity\""},
    {"reflectance", "reflectance", "the property is called \"reflectance\""},
    {"temperature", "temperature", "the property is called \"temperature\""},
    {"transmittance", "transmittance", "the property is called \"transmittance\""}};

static const meant *find_mistyped(const meant *table, size_t count, const char *key) {
  for (size_t k = 0; k < count; k++)
    if (is_mistyped(key, table[k].name)) return &table[k];
  return NULL;
}

/* What a key was meant for, if that is not a word of the format. */
static const meant *find_near(const char *key) {
  const meant *m = find_meant(key);
  if (!m) m = find_mistyped(properties_typed, COUNT(properties_typed), key);
  return m ? m : find_mistyped(properties_meant, COUNT(properties_meant), key);
}

/* Maps and drawings have "color": "#ff0000", which is of the picture, not of light. */
static int is_paint(const json_t *properties, const char *key) {
  const char *text = json_string_value(json_object_get(properties, key));
  return text && *text == '#';
}

/* Maps have words where a number would be meant: "power": "tower" is of OpenStreetMap. */
static int is_word(const json_t *properties, const char *key, const meant *m) {
  const char *text = json_string_value(json_object_get(properties, key));
  return text && !strcmp(m->instead, "emission") && !text[strcspn(text, "0123456789")];
}

static void note_property(hr2di_geojson *reader, const json_t *properties, const char *key) {
  const small s = in_small_letters(key);
  if (is_lonely(properties, key))
    hr2di_notes_add(&reader->notes, HR2D_WARNING_IGNORED, key, reader->label, REFLECTANCE);
  if (note_spelling(reader, properties, reader->label, key,
                    find(of_properties, COUNT(of_properties), s.text)))
    return;
  if (find(of_scene, COUNT(of_scene), s.text)) {
    hr2di_notes_add(&reader->notes, HR2D_WARNING_MISPLACED, key, reader->label,
                    "it belongs into the member \"hr2d\" beside \"features\"");
    return;
  }
  const meant *m = find_near(s.text);
  if (m && !has(properties, m->instead) && !is_paint(properties, key) &&
      !is_word(properties, key, m))
    hr2di_notes_add(&reader->notes, HR2D_WARNING_IGNORED, key, reader->label, m->advice);
}

/* Calls `note` for each member that is not null. */
static hr2d_status each(hr2di_geojson *reader, const json_t *object,
                        void (*note)(hr2di_geojson *, const json_t *, const char *)) {
  json_t *members = (json_t *)(uintptr_t)object; /* iterators change nothing */
  for (void *at = json_object_iter(members); at; at = json_object_iter_next(members, at)) {
    const hr2d_status status = hr2di_watch_work(reader->watch, 4);
    if (status) return status;
    if (!json_is_null(json_object_iter_value(at)))
      note(reader, object, json_object_iter_key(at));
  }
  return HR2D_OK;
}

static void note_feature_member(hr2di_geojson *reader, const json_t *feature, const char *key) {
  const small s = in_small_letters(key);
  const char *name = find(of_properties, COUNT(of_properties), s.text);
  int wanted = name && strcmp(name, "name") != 0;
  wanted |= find_meant(s.text) != NULL;
  (void)feature;
  if (wanted)
    hr2di_notes_add(&reader->notes, HR2D_WARNING_MISPLACED, key, reader->label,
                    "it belongs into the \"properties\" of the feature");
}

static void note_root_member(hr2di_geojson *reader, const json_t *root, const char *key) {
  const small s = in_small_letters(key);
  const char *name = find(of_properties, COUNT(of_properties), s.text);
  (void)root;
  if (find(of_scene, COUNT(of_scene), s.text))
    hr2di_notes_add(&reader->notes, HR2D_WARNING_MISPLACED, key, "the collection",
                    "it belongs into the member \"hr2d\" beside \"features\"");
  else if (name && strcmp(name, "name") != 0)
    hr2di_notes_add(&reader->notes, HR2D_WARNING_MISPLACED, key, "the collection",
                    "it belongs into the \"properties\" of each feature");
}

/* An object of "hr2d", whose members are all known, and what to say of others. */
typedef struct known_object {
  const char *place, *const *names;
  size_t count;
  const char *advice;
} known_object;

static void note_unknown(hr2di_geojson *reader, const json_t *object, const char *key,
                         const known_object *k) {
  if (!note_spelling(reader, object, k->place, key,
                     find(k->names, k->count, in_small_letters(key).text)))
    hr2di_notes_add(&reader->notes, HR2D_WARNING_IGNORED, key, k->place, k->advice);
}

static void note_scene_member(hr2di_geojson *reader, const json_t *members, const char *key) {
  static const known_object known = {
      "hr2d", of_scene, COUNT(of_scene),
      "members of \"hr2d\" are \"background\", \"background_temperature\", "
      "\"medium\", \"period\", \"sky\", \"sun\", \"wavelengths\" and \"weights\""};
  const meant *m = find_meant(in_small_letters(key).text);
  if (m && !*m->instead)
    hr2di_notes_add(&reader->notes, HR2D_WARNING_IGNORED, key, "hr2d", m->advice);
  else
    note_unknown(reader, members, key, &known);
}

static void note_sun_member(hr2di_geojson *reader, const json_t *sun, const char *key) {
  static const char *const names[] = {"bearing", "direction", "irradiance"};
  static const known_object known = {
      "hr2d: sun", names, COUNT(names),
      "members of \"sun\" are \"bearing\" or \"direction\", and \"irradiance\""};
  note_unknown(reader, sun, key, &known);
}

static void note_sky_member(hr2di_geojson *reader, const json_t *sky, const char *key) {
  static const char *const names[] = {"a",           "b",
                                      "c",           "cie",
                                      "d",           "disc",
                                      "e",           "g",
                                      "horizon",     "irradiance",
                                      "perez",       "section_azimuth",
                                      "sun_azimuth", "sun_elevation",
                                      "tolerance",   "zenith"};
  static const known_object known = {
      "hr2d: sky", names, COUNT(names),
      "members of a continuous \"sky\" are \"cie\" or \"perez\" or \"a\" to \"e\" and \"g\", "
      "\"irradiance\" or \"zenith\", \"sun_elevation\", \"sun_azimuth\", \"section_azimuth\", "
      "\"disc\", \"horizon\" and \"tolerance\""};
  note_unknown(reader, sky, key, &known);
}

/* One sky, or one for each band. */
static hr2d_status note_skies(hr2di_geojson *reader, const json_t *sky) {
  hr2d_status status = json_is_object(sky) ? each(reader, sky, note_sky_member) : HR2D_OK;
  for (size_t k = 0; k < json_array_size(sky) && !status; k++)
    if (json_is_object(json_array_get(sky, k)))
      status = each(reader, json_array_get(sky, k), note_sky_member);
  return status;
}

static void note_medium_member(hr2di_geojson *reader, const json_t *medium, const char *key) {
  static const char *const names[] = {"absorption", "emission", "flux", "section",
                                      "temperature"};
  static const known_object known = {
      "hr2d: medium", names, COUNT(names),
      "members of \"medium\" are \"absorption\", \"emission\", \"flux\", \"section\" and "
      "\"temperature\""};
  note_unknown(reader, medium, key, &known);
}

/* Systems of degrees, by the end of their names: WGS 84, ETRS89, NAD83, NAD27, GDA94, GDA2020,
   JGD2011. */
static int is_of_degrees(const char *name) {
  static const char *const codes[] = {"CRS84", "CRS83", "CRS27", "4326", "4979", "4258",
                                      "4269",  "4267",  "4283",  "7844", "6668"};
  const char *end = name + strlen(name);
  while (end > name && end[-1] != ':' && end[-1] != '/') end--;
  return find(codes, COUNT(codes), end) != NULL;
}

/* RFC 7946 knows no "crs"; GeoJSON of 2008 does, and some tools write it. */
static void note_crs(hr2di_geojson *reader, const json_t *root) {
  const json_t *crs = json_object_get(root, "crs");
  const char *name = json_string_value(
      json_is_string(crs) ? crs : json_object_get(json_object_get(crs, "properties"), "name"));
  if (name && is_of_degrees(name))
    hr2di_notes_add(&reader->notes, HR2D_WARNING_DEGREES, "crs", "the collection", "");
}

hr2d_status hr2di_geojson_note_root(hr2di_geojson *reader, const json_t *root) {
  note_crs(reader, root);
  hr2d_status status = each(reader, root, note_root_member);
  const json_t *scene = hr2di_geojson_member(root, "hr2d");
  if (!status) status = each(reader, scene, note_scene_member);
  if (!status) status = each(reader, hr2di_geojson_member(scene, "sun"), note_sun_member);
  if (!status) status = note_skies(reader, hr2di_geojson_member(scene, "sky"));
  return status ? status
                : each(reader, hr2di_geojson_member(scene, "medium"), note_medium_member);
}

hr2d_status hr2di_geojson_note_feature(hr2di_geojson *reader, const json_t *feature) {
  hr2d_status status = each(reader, feature, note_feature_member);
  if (status) return status;
  return each(reader, hr2di_geojson_member(feature, "properties"), note_property);
}

/* What a feature has of its geometry and its name holds for both sides. */
static void note_back_member(hr2di_geojson *reader, const json_t *back, const char *key) {
  static const char *const of_feature[] = {"back", "faces", "name", "shield", "sides"};
  if (!strcmp(key, "emissivity")) return; /* the feature may have the temperature */
  if (find(of_feature, COUNT(of_feature), in_small_letters(key).text))
    hr2di_notes_add(&reader->notes, HR2D_WARNING_IGNORED, key, reader->label,
                    "both sides have it of the feature");
  else
    note_property(reader, back, key);
}

hr2d_status hr2di_geojson_note_back(hr2di_geojson *reader, const json_t *back) {
  return each(reader, back, note_back_member);
}
