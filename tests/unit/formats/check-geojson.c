/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GeoJSON scene files: the scene is what the file says, and anything else is refused. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <dirent.h>
#include <errno.h>
#include <float.h>
#include <jansson.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "data/malformed/expected.h"
#include "support/scene-files.h"

enum { TEXT = 8192 };

static const char *malformed_path(const char *file) {
  char path[300];
  snprintf(path, sizeof path, "tests/data/malformed/%s", file);
  return test_source_path(path);
}

#define COLLECTION(features) "{\"type\":\"FeatureCollection\",\"features\":[" features "]}"
#define FEATURE(properties, type, coordinates)                                                 \
  "{\"type\":\"Feature\",\"properties\":{" properties "},\"geometry\":{\"type\":\"" type       \
  "\",\"coordinates\":" coordinates "}}"

/* The shipped scenes. */

static int is_scene(const char *file) {
  const size_t length = strlen(file);
  return length > 8 && strcmp(file + length - 8, ".geojson") == 0;
}

START_TEST(every_shipped_scene_commits_and_has_light) {
  DIR *directory = opendir(test_scene_path(""));
  ck_assert_ptr_nonnull(directory);
  int count = 0;
  for (struct dirent *entry; (entry = readdir(directory));) {
    if (!is_scene(entry->d_name)) continue;
    hr2d_scene *scene = test_shipped_scene(entry->d_name);
    ck_assert_msg(hr2d_scene_effect(scene, HR2D_EFFECT_EMISSION, NULL), "%s is dark",
                  entry->d_name);
    hr2d_scene_destroy(scene);
    count++;
  }
  closedir(directory);
  ck_assert_int_ge(count, 10);
}
END_TEST

/* The theorem of Gauss: the vectors of a closed room sum to zero, and its area equals that
   of the drawing, computed here by hand. */
START_TEST(shipped_rooms_are_closed_and_face_inwards) {
  static const struct {
    const char *file;
    double area;
  } rooms[] = {
      {"square-room.geojson", 1},
      {"furnace-enclosure.geojson", 1},
      {"furnace.geojson", 6 * 2 + 6 * 0.6 / 2},
      {"lit-room.geojson", 5 * 3 - 1.8 * 1.2 / 2},
      /* a square without its corners */
      {"castel-del-monte.geojson", 17.86 * 17.86 - 4 * 5.23 * 5.23 / 2},
  };
  for (size_t r = 0; r < sizeof rooms / sizeof *rooms; r++) {
    hr2d_scene *scene = test_shipped_scene(rooms[r].file);
    const file_outline o = file_outline_of(scene);
    ck_assert_msg(fabs(o.x) < 1e-13 && fabs(o.y) < 1e-13, "%s is open", rooms[r].file);
    ck_assert_msg(fabs(o.area / rooms[r].area - 1) < 1e-13, "%s: area %.17g", rooms[r].file,
                  o.area);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(the_scenes_of_the_paper_are_as_drawn) {
  static const struct {
    const char *file;
    double s[8];
  } scenes[] = {
      {"par-near.geojson", {0, 0, 1, 0, 1, 0.1, 0, 0.1}},
      {"par-far.geojson", {0, 0, 1, 0, 1, 1, 0, 1}},
      {"orth-near.geojson", {0.1, 0, 1.1, 0, 0, 1.1, 0, 0.1}},
      {"orth-far.geojson", {1, 0, 2, 0, 0, 2, 0, 1}},
      {"corner.geojson", {0, 0, 1, 0, 0, 1, 0, 0}},
  };
  for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
    hr2d_scene *scene = test_shipped_scene(scenes[k].file);
    const double *s = scenes[k].s;
    ck_assert_uint_eq(hr2d_scene_patches(scene), 2);
    file_expect_segment(scene, 0, s[0], s[1], s[2], s[3]);
    file_expect_segment(scene, 1, s[4], s[5], s[6], s[7]);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* E = εσT⁴ and ρ = 1 − ε of the temperatures and emissivities that the file has. */
START_TEST(the_furnace_emits_as_its_temperatures_say) {
  const double sigma = 5.670374419e-8; /* CODATA 2018, W/(m² K⁴) */
  const struct {
    const char *name;
    double kelvin, emissivity;
  } of[] = {{"load", 900, .8},
            {"hearth", 1100, .6},
            {"burner", 1700, .3},
            {"wall", 1350, .6},
            {"roof", 1450, .65}};
  hr2d_scene *scene = test_shipped_scene("furnace.geojson");
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    size_t row = 0;
    while (row < 4 && strncmp(hr2d_scene_name(scene, k), of[row].name, strlen(of[row].name)))
      row++;
    const double t = of[row].kelvin, e = of[row].emissivity;
    const double expected = e * sigma * t * t * t * t;
    ck_assert_double_le(fabs(hr2d_scene_emission(scene, k, 0) / expected - 1), 1e-14);
    ck_assert_double_eq_tol(hr2d_scene_reflectance(scene, k, 0), 1 - e, DBL_EPSILON);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Accepted contents. */

START_TEST(properties_reach_every_patch_of_a_feature) {
  hr2d_scene *scene = file_parsed(COLLECTION(
      FEATURE("\"name\":\"w\u00e4nde\",\"emission\":[1,2,3],\"reflectance\":0.5,\"colour\":{}", "LineString", "[[0,0],[1,0],[1,1,7.5]]") "," FEATURE(
          "\"reflectance\":[0,0.25,1]", "MultiLineString",
          "[[[5,5],[6,5]]]") "," FEATURE("\"name\":\"\",\"emission\":null,\"sides\":null,"
                                         "\"faces\":null",
                                         "LineString",
                                         "[[7,7],[8,8]]") "," FEATURE("\"name\":\"one\","
                                                                      "\"sides\":\"front\"",
                                                                      "LineString",
                                                                      "[[9,7],[10,8]]") "," FEATURE("\"name\":\"two\"",
                                                                                                    "MultiLineString",
                                                                                                    "[[[0,7],[0,8]],[[1,7],[1,8]]]")));
  ck_assert_uint_eq(hr2d_scene_patches(scene), 7);
  file_expect_name(scene, 0, "w\u00e4nde/1");
  file_expect_name(scene, 1, "w\u00e4nde/2");
  file_expect_name(scene, 2, "patch 2");
  file_expect_name(scene, 3, "patch 3");
  file_expect_name(scene, 4, "one");
  file_expect_name(scene, 5, "two/1");
  file_expect_name(scene, 6, "two/2");
  file_expect_segment(scene, 1, 1, 0, 1, 1);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_bands(scene), 3);
  const double reflectance[5][3] = {{.5, .5, .5}, {.5, .5, .5}, {0, .25, 1}};
  for (size_t k = 0; k < 5; k++)
    for (size_t band = 0; band < 3; band++) {
      ck_assert_double_eq(hr2d_scene_emission(scene, k, band), k < 2 ? (double)band + 1 : 0);
      ck_assert_double_eq(hr2d_scene_reflectance(scene, k, band), reflectance[k][band]);
    }
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(both_sides_are_two_patches) {
  hr2d_scene *scene = file_parsed(COLLECTION(
      FEATURE("\"name\":\"fin\",\"sides\":\"both\"", "LineString", "[[0,0],[1,0],[1,1]]")));
  ck_assert_uint_eq(hr2d_scene_patches(scene), 4);
  static const char *const names[] = {"fin/1", "fin/1 (back)", "fin/2", "fin/2 (back)"};
  for (size_t k = 0; k < 4; k++) file_expect_name(scene, k, names[k]);
  file_expect_segment(scene, 0, 0, 0, 1, 0);
  file_expect_segment(scene, 1, 1, 0, 0, 0);
  file_expect_segment(scene, 3, 1, 1, 1, 0);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(what_says_nothing_adds_nothing) {
  static const char *const texts[] = {
      COLLECTION(""),
      COLLECTION("{\"type\":\"Feature\"}"),
      COLLECTION("{\"type\":\"Feature\",\"geometry\":null,\"properties\":null}"),
      "\xEF\xBB\xBF" COLLECTION(""),
      "{\"type\":\"FeatureCollection\",\"features\":[],\"crs\":{},\"bbox\":[0,0,1,1]}",
      "{\"type\":\"FeatureCollection\",\"features\":[],\"hr2d\":{\"medium\":0,\"other\":1}}",
      "{\"type\":\"FeatureCollection\",\"features\":[],\"hr2d\":{\"background\":[0,-0.0]}}",
      "{\"type\":\"FeatureCollection\",\"features\":[],\"hr2d\":null}",
  };
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
    hr2d_scene *scene = file_parsed(texts[k]);
    ck_assert_uint_eq(hr2d_scene_patches(scene), 0);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* What files of other programs have, and no reader should stop at: each with the patches that
   it makes, the name of the last one, and what is told. */

typedef struct told {
  size_t skipped, others;
  char text[512];
} told;

static hr2d_status take_skipped(void *ctx, const hr2d_warning *w) {
  told *t = ctx;
  if (w->code == HR2D_WARNING_SKIPPED && !t->skipped++)
    snprintf(t->text, sizeof t->text, "%s", w->text);
  t->others += w->code == HR2D_WARNING_IGNORED;
  return HR2D_OK;
}

#define GEOMETRY(type, coordinates) "{\"type\":\"" type "\",\"coordinates\":" coordinates "}"
#define GEOMETRIES(members)         "{\"type\":\"GeometryCollection\",\"geometries\":[" members "]}"
#define GATHERED(properties, members)                                                          \
  COLLECTION("{\"type\":\"Feature\",\"properties\":{" properties                               \
             "},\"geometry\":" GEOMETRIES(members) "}")
#define LINE_OF(positions) FEATURE("\"name\":\"w\"", "LineString", positions)

START_TEST(what_other_programs_write_is_read) {
  static const struct {
    const char *text, *name, *says;
    size_t patches, warnings;
  } cases[] = {
      /* 0: rooms have numbers, and names in several languages */
      {COLLECTION(FEATURE("\"name\":101", "LineString", "[[0,0],[1,0]]")), "101", "", 1, 0},
      {COLLECTION(FEATURE("\"name\":-0.125", "LineString", "[[0,0],[1,0]]")), "-0.125", "", 1,
       0},
      {COLLECTION(FEATURE("\"name\":{\"x\":1,\"en\":\"Hall\"}", "LineString", "[[0,0],[1,0]]")),
       "Hall", "", 1, 0},
      {COLLECTION(FEATURE("\"name\":{}", "LineString", "[[0,0],[1,0]]")), "patch 0", "", 1, 0},
      {COLLECTION(FEATURE("\"name\":null", "LineString", "[[0,0],[1,0]]")), "patch 0", "", 1,
       0},
      /* 5: no collection */
      {FEATURE("\"name\":\"w\"", "LineString", "[[0,0],[1,0]]"), "w", "", 1, 0},
      {"{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[4,0],[4,3],[0,0]]]}", "patch 2", "", 3,
       0},
      {COLLECTION("{\"type\":\"LineString\",\"coordinates\":[[0,0],[1,0]]}"), "patch 0", "", 1,
       0},
      /* 8: geometries without patches */
      {COLLECTION(FEATURE("", "Point", "[1,2]") "," FEATURE(
           "", "MultiPoint", "[[1,2]]") "," LINE_OF("[[0,0],[1,0]]")),
       "w", "feature 1 and feature 2: a point is no wall", 1, 1},
      {COLLECTION(FEATURE("", "Point", "[1,2]") "," FEATURE("", "Point", "[1,2]") "," FEATURE(
           "", "Point", "[1,2]") "," FEATURE("", "Point",
                                             "[1,2]") "," LINE_OF("[[0,0],[1,0]]")),
       "w", "feature 1, feature 2, feature 3 and 1 more: a point is no wall", 1, 1},
      {COLLECTION(FEATURE("", "Polygon", "[]") "," FEATURE(
           "", "MultiLineString", "null") "," LINE_OF("[[0,0],[1,0]]")),
       "w", "feature 1 and feature 2: a geometry has no positions", 1, 1},
      {COLLECTION("{\"type\":\"Feature\",\"geometry\":null}," LINE_OF("[[0,0],[1,0]]")), "w",
       "feature 1: a geometry has no positions", 1, 1},
      /* 12: positions that repeat the last one, and that are null */
      {COLLECTION(LINE_OF("[[0,0],[0,0],[1,0],[1,0],[1,0],[1,1]]")), "w/2",
       "feature 1 (\"w\") and 2 more: a position repeats", 2, 1},
      {COLLECTION(LINE_OF("[[0,1],[-0.0,1]]") "," LINE_OF("[[0,0],[1,0]]")), "w",
       "a position repeats", 1, 1},
      {COLLECTION(
           FEATURE("\"name\":\"w\"", "Polygon", "[[[0,0],[9,0],[9,0],[9,9],[0,0],[0,0]]]")),
       "w/3", "a position repeats", 3, 1},
      {COLLECTION(
           FEATURE("", "Polygon", "[[[1,2],[1,2],[1,2],[1,2]]]") "," LINE_OF("[[0,0],[1,0]]")),
       "w", "feature 1: ring 1 and 2 more: a position repeats", 1, 1},
      {COLLECTION(
           FEATURE("", "Polygon", "[[null,null,null,null]]") "," LINE_OF("[[0,0],[1,0]]")),
       "w", "neighbours are joined", 1, 1},
      {COLLECTION(LINE_OF("[null,[0,0],[null,null],[1,0],[1,null]]")), "w/1",
       "neighbours are joined", 1, 1},
      {COLLECTION(LINE_OF("[[0,0,null],[1,0,0]]")), "w", "", 1, 0},
      /* 19: collections: one wall has no number; nothing, and nothing but points */
      {GATHERED("\"name\":\"w\"", GEOMETRIES(GEOMETRY("LineString", "[[0,0],[1,0]]"))), "w", "",
       1, 0},
      {COLLECTION(GEOMETRIES("") "," LINE_OF("[[0,0],[1,0]]")), "w",
       "feature 1: a geometry has no positions", 1, 1},
      {COLLECTION(GEOMETRIES(GEOMETRY("Point", "[1,2]")) "," LINE_OF("[[0,0],[1,0]]")), "w",
       "feature 1: geometry 1: a point is no wall", 1, 1},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    told t = {0};
    hr2d_scene *scene = test_new_scene(NULL);
    const hr2d_status status = file_parse(scene, cases[k].text);
    ck_assert_msg(!status, "%zu: %s", k, hr2d_scene_message(scene));
    ck_assert_msg(hr2d_scene_patches(scene) == cases[k].patches, "%zu: %zu patches", k,
                  hr2d_scene_patches(scene));
    file_expect_name(scene, cases[k].patches - 1, cases[k].name);
    ck_assert_int_eq(hr2d_scene_lint(scene, take_skipped, &t, NULL), HR2D_OK);
    ck_assert_msg(t.skipped == cases[k].warnings && strstr(t.text, cases[k].says),
                  "%zu: %zu times \"%s\"", k, t.skipped, t.text);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

static hr2d_status take_unused(void *ctx, const hr2d_warning *w) {
  if (w->code == HR2D_WARNING_IGNORED && strstr(w->text, "\"name\" is not used"))
    ++*(size_t *)ctx;
  return HR2D_OK;
}

/* Of "name", or "" if there is none; then the warning says so, but for what is empty. */
START_TEST(a_name_of_any_kind_has_a_text) {
#define LONG "\"0123456789 0123456789 0123456789 0123456789 0123456789 01234\""
  static const struct {
    const char *json, *text;
  } names[] = {
      {"\"Hall\"", "Hall"},
      {"12", "12"},
      {"-0.125", "-0.125"},
      {"0.1", "0.1"},
      {"1e300", "1e300"},
      {"2.05", "2.05"},
      {"true", "true"},
      {"false", "false"},
      {"{\"de\":\"B\u00FCro\",\"en\":\"Office\"}", "Office"},
      {"{\"de\":\"B\u00FCro\",\"en\":null}", "B\u00FCro"},
      {"{\"x\":{\"en\":\"no\"},\"y\":\"\",\"z\":7}", "7"},
      {"[\"a\", 1, 2.50, true, null]", "[\"a\",1,2.5,true,null]"},
      {"[1.0,\"\\\"1.0,\\\\\", {\"k.0\": 10.0}]", "[1,\"\\\"1.0,\\\\\",{\"k.0\":10}]"},
      {"[\"B\u00FCro\\u000A\\u00fc\"]", "[\"B\u00FCro\\n\u00FC\"]"},
      {"[" LONG "," LONG "," LONG "," LONG ",1]", "[" LONG "," LONG "," LONG "," LONG ",1]"},
      {"[" LONG "," LONG "," LONG "," LONG ",10]", ""},
      {"null", ""},
      {"{}", ""},
      {"[]", ""},
      {"{\"en\":{\"en\":\"x\"},\"de\":[\"x\"]}", ""},
  };
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    char text[1024];
    size_t unused = 0;
    snprintf(text, sizeof text,
             COLLECTION(FEATURE("\"name\":%s", "LineString", "[[0,0],[1,0]]")), names[k].json);
    hr2d_scene *scene = file_parsed(text);
    file_expect_name(scene, 0, *names[k].text ? names[k].text : "patch 0");
    ck_assert_int_eq(hr2d_scene_lint(scene, take_unused, &unused, NULL), HR2D_OK);
    ck_assert_msg(unused == (!*names[k].text && strcmp(names[k].json, "null")), "%s: %zu",
                  names[k].json, unused);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* The parts of a collection have the patches that features of these geometries and of the same
   properties have, and names that go on. */
START_TEST(a_geometry_collection_is_its_parts) {
#define LIGHT "\"name\":\"w\",\"faces\":\"out\",\"emission\":[1,2]"
#define RING  "[[[0,0],[4,0],[4,3],[0,0]]]"
#define ROWS  "[[[5,5],[6,5]],[[7,5],[8,5],[9,5]]]"
  hr2d_scene *one = file_parsed(
      GATHERED(LIGHT, GEOMETRY("Polygon", RING) "," GEOMETRIES(GEOMETRY(
                          "MultiLineString", ROWS) ",null") "," GEOMETRY("Point", "[9,9]")));
  hr2d_scene *all = file_parsed(
      COLLECTION(FEATURE(LIGHT, "Polygon", RING) "," FEATURE(LIGHT, "MultiLineString", ROWS)));
  ck_assert_uint_eq(hr2d_scene_patches(one), 6);
  ck_assert_uint_eq(hr2d_scene_patches(all), 6);
  for (size_t k = 0; k < 6; k++) {
    const hr2d_segment s = hr2d_scene_segment(all, k);
    char name[8];
    snprintf(name, sizeof name, "w/%zu", k + 1);
    file_expect_segment(one, k, s.a.x, s.a.y, s.b.x, s.b.y);
    file_expect_name(one, k, name);
    ck_assert_double_eq(hr2d_scene_emission(one, k, 1), 2);
  }
  hr2d_scene_destroy(all);
  hr2d_scene_destroy(one);
}
END_TEST

START_TEST(messages_say_which_part_of_a_collection) {
  static const struct {
    const char *text, *says;
  } cases[] = {
      {GATHERED("\"name\":\"w\"",
                GEOMETRY("Point", "[9,9]") "," GEOMETRY("LineString", "[[0,0]]")),
       "feature 1 (\"w\"): geometry 2: needs 2 positions or more, has 1"},
      {GATHERED("", GEOMETRIES(GEOMETRY("Circle", "[9,9]"))),
       "feature 1: geometry 1: geometry 1: geometry: \"Circle\" has no patches"},
      {GATHERED("", "7"), "feature 1: geometry 1: geometry: must be an object"},
      {GATHERED("\"sides\":\"mirror\"", GEOMETRY("LineString", "[[0,0],[1,0]]") "," GEOMETRY(
                                            "LineString", "[[0,0],[1,0]]")),
       "feature 1: geometry 1: a mirror is a LineString of two positions"},
      {COLLECTION("{\"type\":\"GeometryCollection\"}"), "feature 1: geometries: must be"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_ne(file_parse(scene, cases[k].text), HR2D_OK);
    ck_assert_msg(strstr(hr2d_scene_message(scene), cases[k].says), "%zu: %s", k,
                  hr2d_scene_message(scene));
    ck_assert_uint_eq(hr2d_scene_patches(scene), 0);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* The bare feature has what the file says of the whole scene. */
START_TEST(a_bare_feature_is_a_whole_scene) {
  hr2d_scene *scene = file_parsed(
      "{\"type\":\"Feature\",\"hr2d\":{\"background\":3},\"properties\":{\"faces\":\"out\","
      "\"reflectance\":0.25},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[1,0],["
      "0,1],"
      "[0,0]]]}}");
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_double_eq(hr2d_scene_background(scene, 0), 3);
  ck_assert_double_eq(hr2d_scene_reflectance(scene, 2, 0), .25);
  hr2d_scene_destroy(scene);
}
END_TEST

#define WITH_BACKGROUND(value, features)                                                       \
  "{\"type\":\"FeatureCollection\",\"hr2d\":{\"background\":" value                            \
  "},\"features\":[" features "]}"
#define WALL     FEATURE("\"reflectance\":[0.5,0.5]", "LineString", "[[0,0],[1,0]]")
#define BAD_WALL FEATURE("\"reflectance\":2", "LineString", "[[0,0],[1,0]]")

#define WITH_SUN(sun)                                                                          \
  "{\"type\":\"FeatureCollection\",\"hr2d\":{\"sun\":" sun "},\"features\":[]}"

#define WITH_SKY(sky)                                                                          \
  "{\"type\":\"FeatureCollection\",\"hr2d\":{\"sky\":" sky "},\"features\":[]}"

#define NOON "\"sun_elevation\":40"

/* A file has the sky of hr2d_scene_set_continuous_sky(), of an irradiance or a zenith. */
START_TEST(skies_are_continuous) {
  static const struct {
    const char *text, *phrase;
    hr2d_status status;
  } bad[] = {
      {WITH_SKY("{\"cie\":17}"), "from 1 to 16", HR2D_ESCENE},
      {WITH_SKY("{\"cie\":1,\"perez\":{}}"), "both a type of CIE", HR2D_ESCENE},
      {WITH_SKY("{\"perez\":{\"clearness\":2}}"), "perez: needs", HR2D_ESCENE},
      {WITH_SKY("{\"perez\":3}"), "must be an object, not a number", HR2D_ESYNTAX},
      {WITH_SKY("{\"sun_elevation\":80,\"perez\":{\"clearness\":1.3,\"brightness\":0}}"),
       "a larger brightness", HR2D_ESCENE},
      {WITH_SKY("{\"irradiance\":\"x\"}"), "must be a number, not a string", HR2D_ESYNTAX},
      {WITH_SKY("{\"irradiance\":1,\"zenith\":1}"), "both an irradiance", HR2D_ESCENE},
      {WITH_SKY("{\"irradiance\":-1}"), "an irradiance is no number", HR2D_ESCENE},
      {WITH_SKY("{\"disc\":{\"irradiance\":1}}"), "the radius of the disc", HR2D_ESCENE},
      {WITH_SKY("[{\"irradiance\":1},3]"), "an object for each band", HR2D_ESYNTAX},
  };
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    hr2d_scene *scene =
        file_parsed(WITH_SKY("[{\"cie\":16,\"irradiance\":1},{\"irradiance\":7}]"));
    ck_assert_int_eq(file_parse(scene, bad[k].text), bad[k].status);
    test_expect_message(scene, bad[k].phrase);
    ck_assert_double_eq_tol(hr2d_scene_sky(scene, 33, 1), 7, 1e-13);
    ck_assert_double_eq(hr2d_scene_sky(scene, 180, 1), 0);
    hr2d_scene_destroy(scene);
  }
  static const char *const same[] = {
      WITH_SKY("{" NOON ",\"cie\":12,\"irradiance\":3,\"sun_azimuth\":200,"
               "\"section_azimuth\":90,\"disc\":{\"irradiance\":2,\"radius\":5},"
               "\"horizon\":{\"irradiance\":1,\"height\":6}}"),
      WITH_SKY("{" NOON ",\"perez\":{\"diffuse\":100,\"direct\":500}}")};
  for (int k = 0; k < 2; k++) {
    hr2d_sky sky = HR2D_SKY_INIT;
    double delta;
    sky.sun_elevation = 40;
    sky.irradiance = k ? 100 : 3;
    if (k) {
      const double clearness = hr2d_sky_clearness(100, 500, 1361, 40, &delta);
      ck_assert_int_eq(hr2d_sky_perez(clearness, delta, &sky), HR2D_OK);
    } else {
      sky.sun_azimuth = 200;
      sky.section_azimuth = 90;
      sky.disc_irradiance = 2;
      sky.disc_radius = 5;
      sky.horizon_irradiance = 1;
      sky.horizon_height = 6;
      ck_assert_int_eq(hr2d_sky_cie(12, &sky), HR2D_OK);
    }
    hr2d_scene *scene = file_parsed(same[k]), *other = test_new_scene(NULL);
    ck_assert_int_eq(hr2d_scene_set_continuous_sky(other, &sky, 1), HR2D_OK);
    for (int bearing = -95; bearing <= 95; bearing += 10)
      ck_assert_double_eq(hr2d_scene_sky(scene, bearing, 0), hr2d_scene_sky(other, bearing, 0));
    hr2d_scene_destroy(scene);
    hr2d_scene_destroy(other);
  }
  hr2d_scene *scene = file_parsed(WITH_SKY("{\"cie\":16,\"zenith\":9}"));
  hr2d_scene *other = file_parsed(WITH_SKY("{\"cie\":16,\"irradiance\":21.991148575128552}"));
  ck_assert_double_eq_tol(hr2d_scene_sky(scene, 50, 0), hr2d_scene_sky(other, 50, 0), 1e-12);
  hr2d_scene_destroy(scene);
  hr2d_scene_destroy(other);
}
END_TEST

START_TEST(skies_are_pieces) {
  static const struct {
    const char *text, *phrase;
    hr2d_status status;
  } bad[] = {
      {WITH_SKY("1"), "must be an array of [from, to, radiosity], not a number", HR2D_ESYNTAX},
      {WITH_SKY("[]"), "not an empty one", HR2D_ESYNTAX},
      {WITH_SKY("[[1,2]]"), "piece 0 must be [from, to, radiosity]", HR2D_ESYNTAX},
      {WITH_SKY("[[1,2,\"x\"]]"), "must be a number, not a string", HR2D_ESYNTAX},
      {WITH_SKY("[[1,2,[1,2]],[3,4,[1,2,3]]]"), "2 bands where another one has 3", HR2D_ESCENE},
      {WITH_SKY("[[1,3,1],[2,4,1]]"), "overlap", HR2D_ESCENE},
      {WITH_SKY("[[3,1,1]]"), "is no piece", HR2D_ESCENE},
      {WITH_SKY("[[1,3,-1]]"), "0 or more", HR2D_ESCENE},
  };
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    hr2d_scene *scene = file_parsed(WITH_SKY("[[-90,0,[3,4]],[0,90,5]]"));
    ck_assert_int_eq(file_parse(scene, bad[k].text), bad[k].status);
    test_expect_message(scene, bad[k].phrase);
    ck_assert_double_eq(hr2d_scene_sky(scene, -45, 1), 4);
    ck_assert_double_eq(hr2d_scene_sky(scene, 45, 1), 5);
    ck_assert_double_eq(hr2d_scene_sky(scene, 180, 1), 0);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(suns_have_directions_or_bearings) {
  hr2d_scene *scene =
      file_parsed(WITH_SUN("{\"bearing\":[0,90,-90,180,450,30],\"irradiance\":2}"));
  static const hr2d_point way[] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}, {-1, 0}};
  for (size_t k = 0; k < 5; k++) {
    ck_assert_double_eq(hr2d_scene_sun(scene, k).direction.x, way[k].x);
    ck_assert_double_eq(hr2d_scene_sun(scene, k).direction.y, way[k].y);
    ck_assert_double_eq(hr2d_scene_sun(scene, k).irradiance, 2);
  }
  ck_assert_double_eq_tol(hr2d_scene_sun(scene, 5).direction.x, -0.5, 1e-15);
  ck_assert_int_eq(file_parse(scene, WITH_SUN("{\"direction\":[3,-4],\"irradiance\":[1,0.5]}")),
                   HR2D_OK);
  ck_assert_double_eq(hr2d_scene_sun(scene, 1).direction.y, -4);
  ck_assert_double_eq(hr2d_scene_sun(scene, 1).irradiance, 0.5);
  ck_assert_int_eq(
      file_parse(scene, WITH_SUN("{\"direction\":[[1,0],[0,1]],\"irradiance\":1}")), HR2D_OK);
  ck_assert_double_eq(hr2d_scene_sun(scene, 1).direction.y, 1);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(what_is_no_sun_is_refused) {
  static const struct {
    const char *text, *phrase;
    hr2d_status status;
  } cases[] = {
      {WITH_SUN("1"), "sun: must be an object, not a number", HR2D_ESYNTAX},
      {WITH_SUN("{\"irradiance\":1}"), "needs a direction", HR2D_ESCENE},
      {WITH_SUN("{\"direction\":[1,0],\"bearing\":3,\"irradiance\":1}"), "one of these",
       HR2D_ESCENE},
      {WITH_SUN("{\"bearing\":3}"), "irradiance must have a value", HR2D_ESYNTAX},
      {WITH_SUN("{\"bearing\":[],\"irradiance\":1}"), "bearing must have a value",
       HR2D_ESYNTAX},
      {WITH_SUN("{\"bearing\":\"up\",\"irradiance\":1}"), "not a string", HR2D_ESYNTAX},
      {WITH_SUN("{\"bearing\":[1,2,3],\"irradiance\":[1,2]}"),
       "irradiance has 2 values where there are 3 suns", HR2D_ESCENE},
      {WITH_SUN("{\"direction\":[0,0],\"irradiance\":1}"), "is no direction", HR2D_ESCENE},
      {WITH_SUN("{\"direction\":[0,1,2],\"irradiance\":1}"), "must be [dx, dy]", HR2D_ESYNTAX},
      {WITH_SUN("{\"direction\":[0,1],\"irradiance\":-1}"), "0 or more", HR2D_ESCENE},
      {WITH_SUN("{\"direction\":[0,1],\"irradiance\":{}}"), "not an object", HR2D_ESYNTAX},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    hr2d_scene *scene = file_parsed(WITH_SUN("{\"direction\":[3,-4],\"irradiance\":7}"));
    ck_assert_int_eq(file_parse(scene, cases[k].text), cases[k].status);
    test_expect_message(scene, cases[k].phrase);
    ck_assert_double_eq(hr2d_scene_sun(scene, 0).irradiance, 7);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

static void expect_background(hr2d_scene *scene, double first, double second) {
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_bands(scene), 2);
  ck_assert_double_eq(hr2d_scene_background(scene, 0), first);
  ck_assert_double_eq(hr2d_scene_background(scene, 1), second);
}

START_TEST(the_background_is_that_of_the_last_file_that_has_one) {
  static const struct {
    const char *second;
    hr2d_status status;
    double background[2];
  } cases[] = {
      {WITH_BACKGROUND("0.75", ""), HR2D_OK, {0.75, 0.75}},
      {WITH_BACKGROUND("[3,0]", ""), HR2D_OK, {3, 0}},
      {WITH_BACKGROUND("0", ""), HR2D_OK, {0, 0}},
      {WITH_BACKGROUND("null", ""), HR2D_OK, {1, 0.25}},
      {COLLECTION(""), HR2D_OK, {1, 0.25}},
      {WITH_BACKGROUND("[3,-1]", ""), HR2D_ESCENE, {1, 0.25}},
      {WITH_BACKGROUND("[]", ""), HR2D_ESYNTAX, {1, 0.25}},
      {WITH_BACKGROUND("1e999", ""), HR2D_ESYNTAX, {1, 0.25}},
      {WITH_BACKGROUND("0.75", BAD_WALL), HR2D_ESCENE, {1, 0.25}},
      {WITH_BACKGROUND("0.75,\"medium\":-1", ""), HR2D_ESCENE, {1, 0.25}},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    hr2d_scene *scene = file_parsed(WITH_BACKGROUND("[1,0.25]", WALL));
    const hr2d_status status = file_parse(scene, cases[k].second);
    ck_assert_msg(status == cases[k].status, "%zu: %d, %s", k, (int)status,
                  hr2d_scene_message(scene));
    expect_background(scene, cases[k].background[0], cases[k].background[1]);
    hr2d_scene_destroy(scene);
  }
  hr2d_scene *none = file_parsed(COLLECTION(WALL));
  expect_background(none, 0, 0);
  hr2d_scene_destroy(none);
}
END_TEST

/* Every fourth text has integers, also beyond 2⁶³, where other readers keep 64 bits. */
static void write_line(char *text, size_t size, int k, double c[4]) {
  const int whole = k % 4 == 0;
  for (int m = 0; m < 4 && whole; m++) c[m] = trunc(fmod(c[m], 0x1p70));
  snprintf(text, size,
           whole ? COLLECTION(FEATURE("", "LineString", "[[%.0f,%.0f],[%.0f,%.0f]]"))
                 : COLLECTION(FEATURE("", "LineString", "[[%.17g,%.17g],[%.17g,%.17g]]")),
           c[0], c[1], c[2], c[3]);
}

START_TEST(coordinates_keep_every_bit) {
  file_expect_bits(write_line);
}
END_TEST

/* Rings. */

/* All patches have `point` strictly on their left (side 1) or right (side -1). */
static void expect_side(const hr2d_scene *scene, hr2d_point point, int side) {
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    ck_assert_int_eq(hr2d_orientation(s.a, s.b, point), side);
  }
}

static size_t write_ring(char *text, size_t size, const hr2d_point *p, size_t n, size_t first,
                         int backwards) {
  size_t length = 0;
  for (size_t k = 0; k <= n; k++) {
    const hr2d_point q = p[(first + (backwards ? n - k : k)) % n];
    length += (size_t)snprintf(text + length, size - length, "%s[%.17g,%.17g]", k ? "," : "[",
                               q.x, q.y);
  }
  length += (size_t)snprintf(text + length, size - length, "]");
  ck_assert_uint_lt(length, size);
  return length;
}

/* Star-shaped rings, most of them not convex: their centre is left of each edge of a
   counter-clockwise one.  Both directions, any first point, near and far from 0. */
START_TEST(ring_order_does_not_matter) {
  enum { MOST = 24 };
  const double pi = acos(-1);
  char ring[TEXT], text[TEXT + 256];
  randoms r = randoms_stream(test_seed(), 3);
  for (int n = test_count(3000); n > 0; n--) {
    const size_t corners = 3 + (size_t)random_below(&r, MOST - 2);
    const double size = ldexp(1, random_below(&r, 1000) - 500);
    const double x = size * 1e6 * random_unit(&r), y = -size * 1e6 * random_unit(&r);
    const hr2d_point centre = {x, y};
    hr2d_point p[MOST];
    for (size_t k = 0; k < corners; k++) {
      const double turn = 2 * pi * ((double)k + 0.2 * random_unit(&r)) / (double)corners;
      const double radius = size * (0.1 + random_unit(&r));
      p[k] = (hr2d_point){centre.x + radius * cos(turn), centre.y + radius * sin(turn)};
    }
    const int backwards = random_below(&r, 2), out = random_below(&r, 2);
    write_ring(ring, sizeof ring, p, corners, (size_t)random_below(&r, (int)corners),
               backwards);
    snprintf(text, sizeof text, COLLECTION(FEATURE("\"faces\":\"%s\"", "Polygon", "[%s]")),
             out ? "out" : "in", ring);
    hr2d_scene *scene = file_parsed(text);
    ck_assert_uint_eq(hr2d_scene_patches(scene), corners);
    expect_side(scene, centre, out ? -1 : 1);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* One unit in the last place high, 2^52 of them wide; and near overflow. */
START_TEST(extreme_rings_have_an_inside) {
  const double up = 1 + DBL_EPSILON, far = DBL_MAX, tiny = DBL_MIN;
  const hr2d_point rings[][4] = {
      {{1, 1}, {2, 1}, {2, up}, {1, up}},
      {{1, 1}, {2, 2}, {2, 2 + 2 * DBL_EPSILON}, {1, up}},
      {{-far, -far}, {far, -far}, {far, far}, {-far, far}},
      {{-far, -far},
       {far, far},
       {far * (1 - DBL_EPSILON), far},
       {-far, -far * (1 - DBL_EPSILON)}},
      {{0, 0}, {tiny, 0}, {tiny, tiny}, {0, tiny}},
      {{1e15, 1e15}, {1e15 + 1, 1e15}, {1e15 + 1, 1e15 + 1}, {1e15, 1e15 + 1}},
  };
  char ring[TEXT], text[TEXT + 256];
  for (size_t r = 0; r < sizeof rings / sizeof *rings; r++)
    for (size_t first = 0; first < 4; first++)
      for (int backwards = 0; backwards < 2; backwards++) {
        write_ring(ring, sizeof ring, rings[r], 4, first, backwards);
        snprintf(text, sizeof text, COLLECTION(FEATURE("", "Polygon", "[%s]")), ring);
        hr2d_scene *scene = file_parsed(text);
        for (size_t k = 0; k < 4; k++) {
          const hr2d_segment s = hr2d_scene_segment(scene, k);
          for (size_t m = 0; m < 4; m++)
            ck_assert_int_ge(hr2d_orientation(s.a, s.b, rings[r][m]), 0);
        }
        hr2d_scene_destroy(scene);
      }
}
END_TEST

/* Names count the segments of the file, whichever way the ring runs. */
START_TEST(holes_face_the_inside_of_their_polygon) {
  static const char *const outer[] = {"[[0,0],[9,0],[9,9],[0,9],[0,0]]",
                                      "[[0,0],[0,9],[9,9],[9,0],[0,0]]"};
  static const char *const hole[] = {"[[3,3],[6,3],[6,6],[3,6],[3,3]]",
                                     "[[3,3],[3,6],[6,6],[6,3],[3,3]]"};
  const hr2d_point middle = {4.5, 4.5};
  char text[1024];
  for (int variant = 0; variant < 16; variant++) {
    const int out = variant & 4, multi = variant & 8;
    snprintf(
        text, sizeof text,
        COLLECTION(FEATURE("\"name\":\"hall\",\"faces\":\"%s\"", "%sPolygon", "%s[%s,%s]%s")),
        out ? "out" : "in", multi ? "Multi" : "", multi ? "[" : "", outer[variant & 1],
        hole[(variant & 2) / 2], multi ? "]" : "");
    hr2d_scene *scene = file_parsed(text);
    ck_assert_uint_eq(hr2d_scene_patches(scene), 8);
    for (size_t k = 0; k < 8; k++) {
      const hr2d_segment s = hr2d_scene_segment(scene, k);
      ck_assert_int_eq(hr2d_orientation(s.a, s.b, middle), (k < 4) == !out ? 1 : -1);
    }
    file_expect_name(scene, 0, "hall/1");
    file_expect_name(scene, 7, "hall/8");
    const int reversed = out ? !(variant & 1) : variant & 1;
    const hr2d_segment s = hr2d_scene_segment(scene, 0);
    const hr2d_point start = reversed ? s.b : s.a;
    ck_assert_double_eq(start.x, 0);
    ck_assert_double_eq(start.y, 0);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Refusals. */

static const char good[] =
    "{\n  \"type\": \"FeatureCollection\",\n  \"hr2d\": {\"background\": 0},\n"
    "  \"features\": [\n    {\"type\": \"Feature\", \"properties\":\n"
    "      {\"name\": \"d\xC3\xA9j\xC3\xA0 vu\", \"emission\": [1, 2.5e-3], \"sides\": "
    "\"both\"},"
    "\n     \"geometry\": {\"type\": \"LineString\", \"coordinates\": [[0, 0], [1, 0]]}},\n"
    "    {\"type\": \"Feature\", \"properties\": {\"reflectance\": 0.5, \"faces\": \"out\"},\n"
    "     \"geometry\": {\"type\": \"Polygon\",\n"
    "       \"coordinates\": [[[0, 2], [3, 2], [3, 4], [0, 2]]]}}\n  ]\n}";

/* A terminal obeys control characters, be they of ASCII or, as C2 80 to C2 9F, of Latin-1; and
   a text that is cut within a character is not UTF-8. */
START_TEST(messages_have_nothing_that_a_terminal_obeys) {
  static const char *const texts[] = {
      "{\"type\":\"FeatureCollection\",\"features\":[]\x1B[2J}",
      "{\"type\":\"FeatureCollection\",\"features\":[]\x0E}",
      "{\"type\":\"FeatureCollection\",\"features\":[]\x7F}",
      "{\"type\":\"FeatureCollection\",\"features\":[]\xC2\x9B}",
      "{\"typ\\\xC3\xA9\":\"FeatureCollection\"}",
      COLLECTION(FEATURE("\"name\":\"a\xC2\x9B"
                         "31m\",\"sides\":7",
                         "LineString", "[[0,0],[1,0]]")),
  };
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(file_parse(scene, texts[k]), HR2D_ESYNTAX);
    const char *message = hr2d_scene_message(scene);
    for (const char *c = message; *c; c++) {
      ck_assert_msg((unsigned char)*c >= 0x20 && *c != 0x7F, "text %zu: %s", k, message);
      ck_assert_msg(memcmp(c, "\xC2\x9B", 2) != 0, "text %zu: %s", k, message);
      if (((unsigned char)*c & 0xC0) == 0xC0) ck_assert_int_eq(c[1] & 0xC0, 0x80);
    }
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A NUL byte in the place of any other one, and behind the end, where a caller counts the one
   that ends a string.  The control is a space, which is no error in many of these places. */
START_TEST(no_nul_byte_is_read_over) {
  char text[sizeof good], wanted[80];
  unsigned long line = 1, column = 1;
  size_t taken = 0;
  hr2d_scene *scene = file_occupied_scene();
  for (size_t k = 0; k < sizeof good; k++) {
    memcpy(text, good, sizeof good);
    text[k] = '\0';
    snprintf(wanted, sizeof wanted, "line %lu, column %lu: a NUL byte", line, column);
    file_expect_refused(scene, "NUL", file_parse_bytes(scene, text, k + 1), HR2D_ESYNTAX,
                        wanted);
    file_expect_refused(scene, "NUL", file_parse_bytes(scene, text, sizeof good), HR2D_ESYNTAX,
                        wanted);
    text[k] = ' ';
    hr2d_scene *other = test_new_scene(NULL);
    taken += !file_parse_bytes(other, text, sizeof good - (k + 1 < sizeof good));
    hr2d_scene_destroy(other);
    column = good[k] == '\n' ? 1 : column + (((unsigned char)good[k] & 0xC0) != 0x80);
    line += good[k] == '\n';
  }
  ck_assert_uint_gt(taken, 50);
  file_expect_refused(scene, "key", file_parse(scene, "{\"typ\\u0000\":1}"), HR2D_ESYNTAX,
                      "line 1, column 12: a string must not contain \\u0000");
  hr2d_scene_destroy(scene);
}
END_TEST

/* Its first two characters are enough, if both have a zero byte; with a mark, the mark. */
START_TEST(utf_16_is_named) {
  static const char *const texts[] = {"\xFF\xFE", "\xFE\xFF\0{", "{\0\"\0", "\0{\0\"", "V\0 \0",
                                      /* controls */
                                      "{\0\"x", "\0\0\0{", "\xFF\xFD{\0"};
  static const size_t sizes[] = {2, 4, 4, 4, 4, 4, 4, 4};
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(file_parse_bytes(scene, texts[k], sizes[k]), HR2D_ESYNTAX);
    const int named = strstr(hr2d_scene_message(scene), "UTF-16") != NULL;
    ck_assert_msg(named == (k < 5), "%zu: %s", k, hr2d_scene_message(scene));
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(every_malformed_file_is_refused_with_its_reason) {
  hr2d_scene *scene = file_occupied_scene();
  for (size_t k = 0; k < sizeof malformed / sizeof *malformed; k++) {
    const struct malformed *m = &malformed[k];
    hr2d_status status = hr2d_scene_read(scene, malformed_path(m->file));
    file_expect_refused(scene, m->file, status, m->status, m->phrase);
  }
  /* It is still of use. */
  ck_assert_int_eq(file_parse(scene, good), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 6);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(every_malformed_file_is_in_the_table) {
  DIR *directory = opendir(malformed_path(""));
  ck_assert_ptr_nonnull(directory);
  size_t count = 0;
  for (struct dirent *entry; (entry = readdir(directory));)
    count += is_scene(entry->d_name) || strstr(entry->d_name, ".vs2");
  closedir(directory);
  ck_assert_uint_eq(count, sizeof malformed / sizeof *malformed);
}
END_TEST

START_TEST(what_is_no_file_is_an_io_error) {
  hr2d_scene *scene = file_occupied_scene();
  ck_assert_int_eq(hr2d_scene_read(scene, malformed_path("")), HR2D_EIO);
  ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), strerror(EISDIR)));
  ck_assert_int_eq(hr2d_scene_read(scene, malformed_path("missing.geojson")), HR2D_EIO);
  ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), strerror(ENOENT)));
  ck_assert_int_eq(hr2d_scene_read(scene, malformed_path("no-surface.vs2/x")), HR2D_EIO);
  ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), strerror(ENOTDIR)));
  ck_assert_int_eq(hr2d_scene_read(scene, ""), HR2D_EIO);
  ck_assert_int_eq(hr2d_scene_read(scene, NULL), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_scene_parse(scene, NULL, 1), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_scene_parse(scene, NULL, 0), HR2D_ESYNTAX);
  file_expect_unchanged(scene);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(file_parse(scene, good), HR2D_ESTATE);
  ck_assert_int_eq(file_parse(scene, COLLECTION("")), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_scene_read(scene, test_scene_path("par-near.geojson")), HR2D_ESTATE);
  file_expect_unchanged(scene);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Longer than several blocks, through a file. */
START_TEST(a_long_file_is_read_whole) {
  enum { SEGMENTS = 20000 };
  char path[] = "/tmp/check_geojson_XXXXXX";
  FILE *file = file_temporary(path);
  fputs("{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":"
        "{\"name\":\"long\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[0,0]",
        file);
  for (int k = 1; k <= SEGMENTS; k++) fprintf(file, ",[%d,%d.5]", k, k * (k % 7));
  fputs("]}}]}", file);
  ck_assert_int_eq(fclose(file), 0);
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_read(scene, path), HR2D_OK);
  unlink(path);
  ck_assert_uint_eq(hr2d_scene_patches(scene), SEGMENTS);
  for (int k = 1; k < SEGMENTS; k++)
    file_expect_segment(scene, (size_t)k, k, k * (k % 7) + .5, k + 1,
                        (k + 1) * ((k + 1) % 7) + .5);
  file_expect_name(scene, SEGMENTS - 1, "long/20000");
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(every_truncation_is_refused) {
  const size_t size = sizeof good - 1;
  hr2d_scene *scene = file_occupied_scene();
  for (size_t k = 0; k < size; k++) {
    hr2d_status status = file_parse_bytes(scene, good, k);
    ck_assert_msg(status == HR2D_ESYNTAX, "%zu bytes: %d", k, (int)status);
    ck_assert_int_eq(strncmp(hr2d_scene_message(scene), "line ", 5), 0);
    file_expect_unchanged(scene);
  }
  ck_assert_int_eq(file_parse_bytes(scene, good, size), HR2D_OK);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(random_damage_is_refused_or_read) {
  FILE_EXPECT_DAMAGE(good, "\"\\[]{}:,.-+eE019 \n\0\x80\xFF", "");
}
END_TEST

static hr2d_status read_enclosure(hr2d_scene *scene) {
  return hr2d_scene_read(scene, test_scene_path("furnace-enclosure.geojson"));
}

/* At least the file, the bands, the points, a name, and the data of the scene. */
START_TEST(every_failed_allocation_is_reported) {
  ck_assert_int_ge(file_starve(read_enclosure, 4), 10);
}
END_TEST

static hr2d_status read_odd_names(hr2d_scene *scene) {
  return file_parse(
      scene,
      COLLECTION(FEATURE("\"name\":{\"en\":7}", "LineString", "[[0,0],[1,0]]") "," FEATURE(
          "\"name\":[1,\"a\",[true]]", "LineString", "[[0,1],[1,1],[2,1]]")));
}

/* The points, both names, those of two segments, and the data of the scene. */
START_TEST(every_failed_allocation_of_a_name_is_reported) {
  ck_assert_int_ge(file_starve(read_odd_names, 3), 6);
}
END_TEST

START_TEST(a_read_that_runs_out_of_memory_keeps_the_background) {
  for (int for_good = 0; for_good < 2; for_good++) {
    long k = 0;
    for (int failed = 1; failed; k++) {
      test_memory memory = {.until_failure = -1};
      const hr2d_allocator hooks = test_hooks(&memory);
      hr2d_scene *scene = test_new_scene(&hooks);
      ck_assert_int_eq(file_parse(scene, WITH_BACKGROUND("[1,0.25]", WALL)), HR2D_OK);
      memory.for_good = for_good;
      memory.until_failure = k;
      const hr2d_status status = file_parse(
          scene, WITH_BACKGROUND("[3,4]", FEATURE("", "LineString", "[[0,1],[1,1]]")));
      failed = memory.failures > 0;
      memory.until_failure = -1;
      ck_assert_int_eq(status, failed ? HR2D_ENOMEM : HR2D_OK);
      ck_assert_uint_eq(hr2d_scene_patches(scene), failed ? 1 : 2);
      expect_background(scene, failed ? 1 : 3, failed ? 0.25 : 4);
      hr2d_scene_destroy(scene);
    }
    /* The values, the points, the patch, and the background that the scene keeps. */
    ck_assert_int_gt(k, 4);
  }
}
END_TEST

/* The allocations of jansson, which do not use the hooks.  If one fails, its lexer may drop
   a byte within a token or behind it, and would end the process in the second case.  No byte
   may be lost. */
static test_memory parser_memory;

static void *parser_allocate(size_t size) {
  if (!test_runs_out(&parser_memory)) return malloc(size);
  errno = ENOMEM;
  return NULL;
}

/* Parses with each allocation of jansson failing, and returns how many there are. */
static long starve_parser(const char *text, size_t size) {
  hr2d_scene *whole = test_new_scene(NULL);
  const hr2d_status wanted = hr2d_scene_parse(whole, text, size);
  char message[512];
  snprintf(message, sizeof message, "%s", hr2d_scene_message(whole));
  long k = 0;
  for (int for_good = 0; for_good < 2; for_good++) {
    k = 0;
    for (int done = 0; !done; k++) {
      parser_memory = (test_memory){.until_failure = k, .for_good = for_good};
      hr2d_scene *scene = test_new_scene(NULL);
      json_set_alloc_funcs(parser_allocate, free);
      hr2d_status status = hr2d_scene_parse(scene, text, size);
      json_set_alloc_funcs(malloc, free);
      done = parser_memory.failures == 0;
      ck_assert_int_eq(status, done ? wanted : HR2D_ENOMEM);
      ck_assert_uint_eq(hr2d_scene_patches(scene), done ? hr2d_scene_patches(whole) : 0);
      if (!done) ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), "out of memory"));
      if (done && status) ck_assert_str_eq(hr2d_scene_message(scene), message);
      for (size_t m = 0; done && m < hr2d_scene_patches(whole); m++) {
        const hr2d_segment one = hr2d_scene_segment(whole, m);
        file_expect_segment(scene, m, one.a.x, one.a.y, one.b.x, one.b.y);
        file_expect_name(scene, m, hr2d_scene_name(whole, m));
      }
      hr2d_scene_destroy(scene);
    }
  }
  hr2d_scene_destroy(whole);
  return k;
}

START_TEST(no_failed_allocation_of_the_parser_is_lost) {
  static const char text[] =
      COLLECTION(FEATURE("\"name\":\"long enough to outgrow the buffer of the lexer twice and "
                         "more\",\"reflectance\":[0.5]",
                         "LineString", "[[-1.2345678901234567e-300,0],[1,1]]"));
  ck_assert_int_gt(starve_parser(text, sizeof text - 1), 20);
  /* names that jansson writes */
  static const char number[] =
      COLLECTION(FEATURE("\"name\":101", "LineString", "[[0,0],[1,1]]")),
                    array[] = COLLECTION(
                        FEATURE("\"name\":[1,[\"a\"]]", "LineString", "[[0,0],[1,1]]"));
  ck_assert_int_gt(starve_parser(number, sizeof number - 1), 20);
  ck_assert_int_gt(starve_parser(array, sizeof array - 1), 20);
}
END_TEST

/* Tokens of every length, and texts that are wrong in or behind one. */
START_TEST(no_length_of_a_token_is_fatal) {
  static const char *const forms[] = {
      COLLECTION(FEATURE("", "LineString", "[[0,0],[1,1%.*s]]")),
      COLLECTION(FEATURE("", "LineString", "[[0,0],[1,1.%.*s]]")),
      COLLECTION(FEATURE("", "LineString", "[[0,0],[1,1%.*s ]]")),
      COLLECTION(FEATURE("\"name\":\"%.*s\"", "LineString", "[[0,0],[1,1]]")),
      COLLECTION(FEATURE("\"%.*s\":1", "LineString", "[[0,0],[1,1]]")),
      COLLECTION(FEATURE("\"name\":\"%.*s\n\"", "LineString", "[[0,0],[1,1]]")),
      COLLECTION(FEATURE("", "LineString", "[[0,0],[1,1%.*s.]]")),
      COLLECTION(FEATURE("\"name\":nul%.*s", "LineString", "[[0,0],[1,1]]")),
      "%.*s",
      "{\"%.*s",
      "{} %.*s",
      "\"%.*s\"",
  };
  static const char zeros[] =
      "00000000000000000000000000000000000000000000000000000000000000000"
      "00000000000000000000000000000000000000000000000000000000000000000";
  for (size_t form = 0; form < sizeof forms / sizeof *forms; form++)
    for (int length = 0; length < 2 * 64 + 2;
         length += test_count(100) < 10 && length % 16 == 2 ? 9 : 1) {
      char text[1024];
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
      const int size = snprintf(text, sizeof text, forms[form], length, zeros);
#pragma GCC diagnostic pop
      starve_parser(text, (size_t)size);
    }
}
END_TEST

TEST_SUITE("geojson") {
  ADD_TESTS("shipped scenes", every_shipped_scene_commits_and_has_light,
            shipped_rooms_are_closed_and_face_inwards, the_scenes_of_the_paper_are_as_drawn,
            the_furnace_emits_as_its_temperatures_say);
  ADD_TESTS("content", properties_reach_every_patch_of_a_feature, both_sides_are_two_patches,
            what_says_nothing_adds_nothing, what_other_programs_write_is_read,
            a_name_of_any_kind_has_a_text, a_geometry_collection_is_its_parts,
            messages_say_which_part_of_a_collection, a_bare_feature_is_a_whole_scene,
            skies_are_pieces, skies_are_continuous, suns_have_directions_or_bearings,
            what_is_no_sun_is_refused, the_background_is_that_of_the_last_file_that_has_one,
            coordinates_keep_every_bit);
  ADD_TESTS("rings", ring_order_does_not_matter, extreme_rings_have_an_inside,
            holes_face_the_inside_of_their_polygon);
  ADD_TESTS("refusals", every_malformed_file_is_refused_with_its_reason,
            no_nul_byte_is_read_over, utf_16_is_named,
            messages_have_nothing_that_a_terminal_obeys, every_malformed_file_is_in_the_table,
            what_is_no_file_is_an_io_error, a_long_file_is_read_whole,
            every_truncation_is_refused, random_damage_is_refused_or_read,
            every_failed_allocation_is_reported, every_failed_allocation_of_a_name_is_reported,
            a_read_that_runs_out_of_memory_keeps_the_background,
            no_failed_allocation_of_the_parser_is_lost, no_length_of_a_token_is_fatal);
}
