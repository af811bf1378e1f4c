/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What people write when they draw their first scenes, and what they are told. */
#include <stdio.h>
#include <string.h>

#include "support/support.h"

#define COLLECTION(features) "{\"type\":\"FeatureCollection\",\"features\":[" features "]}"
#define WITH(members, features)                                                                \
  "{\"type\":\"FeatureCollection\"," members ",\"features\":[" features "]}"
#define FEATURE(properties, type, coordinates)                                                 \
  "{\"type\":\"Feature\",\"properties\":{" properties "},\"geometry\":{\"type\":\"" type       \
  "\",\"coordinates\":" coordinates "}}"
#define LINE(properties, coordinates) FEATURE(properties, "LineString", coordinates)
#define ROOM(properties, coordinates) FEATURE(properties, "Polygon", "[" coordinates "]")

/* A square room with its fronts inside, and a lamp that lights it. */
#define SQUARE "[[0,0],[4,0],[4,3],[0,3],[0,0]]"
#define WALLS  ROOM("\"name\":\"room\",\"reflectance\":0.5", SQUARE)
#define LAMP   LINE("\"name\":\"lamp\",\"emission\":1,\"sides\":\"both\"", "[[1,2.5],[2,2.5]]")

typedef struct mistake {
  const char *what, *file;
  hr2d_warning_code code; /* or HR2D_WARNING_COUNT: the file is refused */
  const char *says;       /* a part of the warning, or of the message of the refusal */
} mistake;

#define REFUSED HR2D_WARNING_COUNT

static const mistake mistakes[] = {
    /* 0 */
    {"fronts of a room look out", COLLECTION(LAMP "," ROOM("\"faces\":\"out\"", SQUARE)),
     HR2D_WARNING_SEES_NOTHING,
     "no patch is seen from the front of patch 0 (\"lamp\") and patch 1"},
    {"one wall runs the wrong way",
     COLLECTION(LAMP "," LINE("", "[[0,0],[4,0],[4,3]]") "," LINE("\"name\":\"wall\"",
                                                                  "[[0,3],[4,3]]")),
     HR2D_WARNING_UNLIT, "no light reaches the front of patch 4 (\"wall\")"},
    {"a lamp looks out", COLLECTION(WALLS "," LINE("\"emission\":1", "[[1,-1],[2,-1]]")),
     HR2D_WARNING_UNLIT, "swap the ends, or for a polygon \"faces\""},
    {"a gap of 1 mm",
     COLLECTION(LAMP "," WALLS "," LINE("\"sides\":\"both\"", "[[2,0.001],[2,1]]")),
     HR2D_WARNING_LOOSE_END, "0.001 short of patch 2 (\"room/1\")"},
    {"a gap of a millionth",
     COLLECTION(LAMP "," WALLS "," LINE("\"name\":\"screen\"", "[[2,0.000001],[2,1]]")),
     HR2D_WARNING_LOOSE_END, "ends at (2, 1e-06), 1e-06 short of"},
    /* 5 */
    {"corners that do not meet",
     COLLECTION(LAMP "," LINE("\"name\":\"floor\"",
                              "[[0,0],[3.998,0]]") "," LINE("", "[[4,0],[4,3]]")),
     HR2D_WARNING_LOOSE_END, "patch 2 (\"floor\") ends at (3.998, 0), 0.002 short of patch 3"},
    {"a slit between two boxes",
     COLLECTION(LAMP "," ROOM("\"faces\":\"out\"", "[[0,0],[1,0],[1,1],[0,1],[0,0]]") "," ROOM(
         "\"faces\":\"out\"", "[[1.0005,0],[2,0],[2,1],[1.0005,1],[1.0005,0]]")),
     HR2D_WARNING_NEAR_COPY, "only 0.0005 beside it"},
    {"a narrow opening beside a corner",
     COLLECTION(LAMP "," WALLS
                     "," ROOM("\"faces\":\"out\"", "[[1,1],[3,1.2],[3.999,2],[2,2],[1,1]]")),
     HR2D_WARNING_NARROW_GAP, "an opening of only 0.001 at (3.999, 2)"},
    {"a wall is drawn twice",
     COLLECTION(LAMP "," WALLS "," LINE("\"name\":\"again\"", "[[0,0],[4,0]]")), REFUSED,
     "is a copy of patch 2 (\"room/1\")"},
    {"twice, the second time inexactly",
     COLLECTION(LAMP "," WALLS "," LINE("\"name\":\"again\"", "[[0.001,0.001],[3.999,0.001]]")),
     HR2D_WARNING_NEAR_COPY, "lies along patch"},
    /* 10 */
    {"longitude and latitude",
     COLLECTION(LINE("\"emission\":1", "[[7.468,51.492],[7.469,51.492]]") "," LINE(
         "", "[[7.469,51.493],[7.468,51.493]]")),
     HR2D_WARNING_DEGREES, "look like longitude and latitude"},
    {"degrees by crs",
     WITH("\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"urn:ogc:def:crs:OGC:1.3:CRS84"
          "\"}}",
          LAMP "," WALLS),
     HR2D_WARNING_DEGREES, "as \"crs\" says"},
    {"altitudes", COLLECTION(LAMP "," LINE("", "[[0,0,1],[4,0,2.5]]")), HR2D_WARNING_ALTITUDE,
     "third numbers of positions are not used"},
    {"a wall that stands upright in x, y, z", COLLECTION(LINE("", "[[0,0,0],[0,0,3]]")),
     REFUSED, "the same in x and y; third numbers are not used"},
    {"centimetres",
     COLLECTION(LINE("\"emission\":1", "[[0,0],[400,0]]") "," LINE("", "[[400,250],[0,250]]")),
     HR2D_WARNING_UNITS, "over a range of 400, like centimetres"},
    /* 15 */
    {"emissivity", COLLECTION(LAMP "," ROOM("\"emissivity\":0.9", SQUARE)),
     HR2D_WARNING_IGNORED, "feature 2: \"emissivity\" is not used: write \"reflectance\""},
    {"rho", COLLECTION(LAMP "," ROOM("\"rho\":0.9", SQUARE)), HR2D_WARNING_IGNORED,
     "\"rho\" is not used: the property is called \"reflectance\""},
    {"albedo", COLLECTION(LAMP "," ROOM("\"name\":\"hall\",\"Albedo\":0.9", SQUARE)),
     HR2D_WARNING_IGNORED, "feature 2 (\"hall\"): \"Albedo\" is not used"},
    {"a colour", COLLECTION(LAMP "," ROOM("\"colour\":\"red\"", SQUARE)), HR2D_WARNING_IGNORED,
     "an array with a number for each band"},
    {"a capital letter", COLLECTION(LAMP "," ROOM("\"Reflectance\":0.9", SQUARE)),
     HR2D_WARNING_IGNORED, "\"Reflectance\" is not used: names have small letters"},
    /* 20 */
    {"a temperature in other words", COLLECTION(LAMP "," ROOM("\"kelvin\":300", SQUARE)),
     HR2D_WARNING_IGNORED, "the property is called \"temperature\""},
    {"two-sided in other words",
     COLLECTION(LAMP "," WALLS "," LINE("\"two_sided\":true", "[[1,1],[2,1]]")),
     HR2D_WARNING_IGNORED, "write \"sides\": \"both\""},
    {"a background outside of hr2d", WITH("\"background\":1", LAMP "," WALLS),
     HR2D_WARNING_MISPLACED, "belongs into the member \"hr2d\""},
    {"a background on a feature", COLLECTION(LAMP "," ROOM("\"background\":1", SQUARE)),
     HR2D_WARNING_MISPLACED, "\"background\" is not used: it belongs into the member \"hr2d\""},
    {"another word in hr2d", WITH("\"hr2d\":{\"clouds\":1}", LAMP "," WALLS),
     HR2D_WARNING_IGNORED,
     "hr2d: \"clouds\" is not used: members of \"hr2d\" are \"background\", \"background_temp"},
    /* 25 */
    {"properties beside \"properties\"",
     COLLECTION(WALLS
                ",{\"type\":\"Feature\",\"emission\":1,\"geometry\":{\"type\":\"LineString"
                "\",\"coordinates\":[[1,1],[2,1]]}}"),
     HR2D_WARNING_MISPLACED, "belongs into the \"properties\" of the feature"},
    {"no light at all", COLLECTION(WALLS), HR2D_WARNING_DARK_SCENE, "no patch emits"},
    {"only mirrors", COLLECTION(ROOM("\"emission\":1,\"reflectance\":1", SQUARE)),
     HR2D_WARNING_NO_ABSORBER, "every reflectance of band 0 is 1"},
    {"percent", COLLECTION(ROOM("\"reflectance\":80", SQUARE)), REFUSED,
     "reflectance: must be between 0 and 1, not 80; 1 is 100 %"},
    {"a number as a string", COLLECTION(ROOM("\"reflectance\":\"0.8\"", SQUARE)), REFUSED,
     "not a string: leave out the quotation marks"},
    /* 30 */
    {"a collection of features that is none", "{\"type\":\"Features\"}", REFUSED,
     "not a GeoJSON FeatureCollection: \"type\" is \"Features\""},
    {"a ring that is not closed", COLLECTION(ROOM("", "[[0,0],[4,0],[4,3],[0,3]]")), REFUSED,
     "a ring must be closed: its last position must repeat the first"},
    {"points", COLLECTION(LAMP "," WALLS "," FEATURE("", "Point", "[0,0]")),
     HR2D_WARNING_SKIPPED, "feature 3: a point is no wall, and is left out"},
    {"walls that cross",
     COLLECTION(LAMP "," LINE("", "[[0,0],[4,4]]") "," LINE("", "[[0,3],[4,0]]")), REFUSED,
     "--split-crossings cuts them there"},
    {"bands of two lengths",
     COLLECTION(LINE("\"emission\":[1,2]", "[[0,0],[1,0]]") "," LINE("\"reflectance\":[1,0,0]",
                                                                     "[[0,0],[0,1]]")),
     REFUSED, "where patch 0 (feature 1) has 2 bands"},
    /* 35 */
    {"a hole that is its outline",
     COLLECTION(LAMP "," FEATURE("", "Polygon", "[" SQUARE "," SQUARE "]")), HR2D_WARNING_UNLIT,
     "no light reaches the front of patch 6"},
    {"a front inside of a wall, under a sky",
     WITH("\"hr2d\":{\"background\":1}",
          ROOM("\"faces\":\"out\"", SQUARE) "," LINE("\"name\":\"lamp\"", "[[1,1],[2,1]]")),
     HR2D_WARNING_SEES_NOTHING,
     "no patch and no sky is seen from the front of patch 4 (\"lamp\")"},
    {"a wall is drawn twice, the second time backwards",
     COLLECTION(LAMP "," WALLS "," LINE("\"name\":\"again\"", "[[4,0],[0,0]]")),
     HR2D_WARNING_UNLIT, "no light reaches the front of patch 6 (\"again\")"},
    {"degrees Celsius",
     COLLECTION(LINE("\"temperature\":20", "[[0,0],[4,0]]") "," LINE("\"temperature\":60",
                                                                     "[[4,0],[0,3]]")),
     HR2D_WARNING_UNITS, "temperatures from 20 to 60 look like degrees Celsius"},
    {"degrees Celsius below 0", COLLECTION(LINE("\"temperature\":-5", "[[0,0],[4,0]]")),
     REFUSED, "it is in kelvin, which is °C + 273.15"},
    /* 40 */
    {"degrees Celsius by name", COLLECTION(LAMP "," ROOM("\"celsius\":20", SQUARE)),
     HR2D_WARNING_IGNORED, "write \"temperature\" in kelvin"},
    {"a temperature as a string", COLLECTION(ROOM("\"temperature\":\"300\"", SQUARE)), REFUSED,
     "not a string: leave out the quotation marks"},
    {"a temperature and a flux", COLLECTION(ROOM("\"temperature\":300,\"flux\":0", SQUARE)),
     REFUSED, "cannot both be given"},
    {"a reflectance beside a temperature",
     COLLECTION(ROOM("\"temperature\":300,\"reflectance\":0.2", SQUARE)), REFUSED,
     "write \"emissivity\": 1 - reflectance"},
    {"emissivity in percent", COLLECTION(ROOM("\"temperature\":300,\"emissivity\":90", SQUARE)),
     REFUSED, "must be between 0 and 1, not 90; 1 is 100 %"},
    /* 45 */
    {"heat in other words", COLLECTION(LAMP "," ROOM("\"heat_flux\":100", SQUARE)),
     HR2D_WARNING_IGNORED, "write \"flux\", the net heat flux"},
    {"a closed room of fluxes", COLLECTION(ROOM("\"flux\":0", SQUARE)),
     HR2D_WARNING_NO_ABSORBER, "or a \"temperature\""},
    {"wavelengths in metres",
     WITH("\"hr2d\":{\"wavelengths\":[3e-6,8e-6]}", ROOM("\"temperature\":300", SQUARE)),
     HR2D_WARNING_UNITS, "look like metres, as no patch emits below them: write micrometres"},
    {"wavelengths in nanometres",
     WITH("\"hr2d\":{\"wavelengths\":[3000,8000]}", ROOM("\"temperature\":300", SQUARE)),
     HR2D_WARNING_UNITS, "look like nanometres"},
    {"a direction to the sun, not of its light",
     WITH("\"hr2d\":{\"sun\":{\"direction\":[1,2],\"irradiance\":800}}",
          LINE("\"reflectance\":0.5", "[[0,0],[4,0]]")),
     HR2D_WARNING_NO_SUNLIGHT, "its light travels in direction (1, 2)"},
    /* 50 */
    {"a sun without irradiance",
     WITH("\"hr2d\":{\"sun\":{\"bearing\":40}}", LINE("", "[[0,0],[4,0]]")), REFUSED,
     "irradiance must have a value"},
    {"a sun outside of hr2d",
     WITH("\"sun\":{\"bearing\":40,\"irradiance\":800}", LAMP "," WALLS),
     HR2D_WARNING_MISPLACED, "\"sun\" is not used: it belongs into the member \"hr2d\""},
    {"a comma too many",
     "{\"type\":\"FeatureCollection\",\"features\":[" LINE("\"emission\":1,",
                                                           "[[0,0],[1,0]]") "]}",
     REFUSED, "line 1, column"},
    {"an empty file", "", REFUSED, "line 1, column 1"},
    {"a polygon without its list of rings", COLLECTION(FEATURE("", "Polygon", SQUARE)), REFUSED,
     "ring 1"},
    /* 55 */
    {"a comma for a point", COLLECTION(LAMP "," LINE("", "[[0,1],[4,1,0]]")),
     HR2D_WARNING_ALTITUDE, "some positions have two numbers, and others more"},
    {"footprints whose fronts look in, under a sky",
     WITH("\"hr2d\":{\"background\":1}", ROOM("\"name\":\"house\"", SQUARE)),
     HR2D_WARNING_NO_SKY, "write \"faces\": \"out\" for what is seen from outside"},
    {"a partition of two rooms that is one-sided",
     COLLECTION(
         LINE("\"name\":\"a\",\"emission\":1", "[[3,0],[3,3],[0,3],[0,0],[3,0]]") "," LINE(
             "\"name\":\"b\",\"emission\":1", "[[3,0],[6,0],[6,3],[3,3]]")),
     HR2D_WARNING_SEES_BACK,
     "the back of patch 0 (\"a/1\") stands in front of patch 4 (\"b/1\") and of 2 more"},
    {"a floor that runs the wrong way, without light",
     COLLECTION(LINE("\"name\":\"floor\"", "[[6,0],[0,0]]") "," LINE("",
                                                                     "[[6,0],[6,2.5],[0,2.5],"
                                                                     "[0,0]]")),
     HR2D_WARNING_SEES_NOTHING, "no patch is seen from the front of patch 0 (\"floor\")"},
    {"a corner that is missed by 1 cm",
     COLLECTION(LINE("\"name\":\"floor\",\"emission\":1", "[[0,0],[4,0],[4,3],[0,3]]") "," LINE(
         "\"name\":\"w\"", "[[0,3],[0,0.01]]")),
     HR2D_WARNING_LOOSE_END,
     "patch 0 (\"floor/1\") ends at (0, 0), 0.01 short of patch 3 (\"w\")"},
    /* 60 */
    {"a wall that is sunk below the end of a floor",
     COLLECTION(LINE("\"name\":\"floor\",\"emission\":1", "[[0,0],[4,0],[4,3],[0,3]]") "," LINE(
         "\"name\":\"w\"", "[[0,3],[0,-0.003]]")),
     HR2D_WARNING_LOOSE_END,
     "goes past an end of patch 0 (\"floor/1\") and ends at (0, -0.003)"},
    {"a wall that is sunk into a floor",
     COLLECTION(LAMP "," WALLS "," LINE("\"name\":\"screen\"", "[[3,1],[3,-0.01]]")), REFUSED,
     "and patch 6 (\"screen\") ends 0.01 behind it: hr2d_scene_snap() or --snap 0.015"},
    {"a radiation shield",
     COLLECTION(ROOM("\"temperature\":300", SQUARE) "," LINE(
         "\"name\":\"shield\",\"flux\":0,\"sides\":\"both\"", "[[1,1],[2,1],[3,1.5]]")),
     HR2D_WARNING_SHIELD, "patch 4 (\"shield/1\") and 1 more: each side has the flux"},
    {"a window", COLLECTION(LAMP "," ROOM("\"reflectance\":0.1,\"transmittance\":0.8", SQUARE)),
     REFUSED, "write \"sides\": \"both\""},
    {"tau", COLLECTION(LAMP "," ROOM("\"tau\":0.8", SQUARE)), HR2D_WARNING_IGNORED,
     "the property is called \"transmittance\""},
    /* 65 */
    {"gloss", COLLECTION(LAMP "," ROOM("\"reflectance\":0.5,\"Specular\":0.8", SQUARE)),
     HR2D_WARNING_IGNORED, "\"Specular\" is not used: walls reflect and emit diffusely"},
    {"a letter too many", COLLECTION(LAMP "," ROOM("\"albedos\":0.8", SQUARE)),
     HR2D_WARNING_IGNORED, "\"albedos\" is not used: the property is called \"reflectance\""},
    {"a letter too few",
     COLLECTION(LAMP "," ROOM("\"temperature\":300,\"emisivity\":0.8", SQUARE)),
     HR2D_WARNING_IGNORED, "\"emisivity\" is not used: the property is called \"emissivity\""},
    {"two letters swapped", COLLECTION(LAMP "," ROOM("\"reflcetance\":0.8", SQUARE)),
     HR2D_WARNING_IGNORED, "the property is called \"reflectance\""},
    {"a sun along the period",
     WITH("\"hr2d\":{\"period\":[5,0],\"sun\":{\"bearing\":[-40,-89.99],\"irradiance\":5}}",
          LINE("", "[[0,0],[5,0]]") "," LINE("\"sides\":\"both\"", "[[1,1],[2,1]]")),
     HR2D_WARNING_LOW_SUN, "sun 1 is so low that it shines past more than"},
    {"a member of the sun",
     WITH("\"hr2d\":{\"sun\":{\"bearing\":20,\"elevation\":30,\"irradiance\":800}}",
          LINE("", "[[0,0],[5,0]]")),
     HR2D_WARNING_IGNORED, "hr2d: sun: \"elevation\" is not used: members of \"sun\""},
    {"a member of the medium",
     WITH("\"hr2d\":{\"medium\":{\"absorption\":1,\"scattering\":0.5}}",
          LAMP "," LINE("", "[[0,0],[5,0]]")),
     HR2D_WARNING_IGNORED, "hr2d: medium: \"scattering\" is not used: members of \"medium\""},
    {"a member of the medium with a capital letter",
     WITH("\"hr2d\":{\"medium\":{\"absorption\":1,\"Temperature\":500}}",
          LAMP "," LINE("", "[[0,0],[5,0]]")),
     HR2D_WARNING_IGNORED,
     "hr2d: medium: \"Temperature\" is not used: names have small letters"},
    {"glass", COLLECTION(LAMP "," ROOM("\"refractive_index\":1.5", SQUARE)),
     HR2D_WARNING_IGNORED, "refraction and clear glass are no part"},
    {"a body of revolution",
     WITH("\"hr2d\":{\"axisymmetric\":true}", LINE("", "[[0,0],[5,0]]")), HR2D_WARNING_IGNORED,
     "hr2d: \"axisymmetric\" is not used: a scene is a section"},
    {"a side without a back",
     COLLECTION(LAMP "," LINE("\"transmittance\":0.5,\"back\":{\"reflectance\":0.1}",
                              "[[1,1],[2,1]]")),
     REFUSED, "back: there is none without"},
    {"a name of the back",
     COLLECTION(LAMP "," LINE("\"sides\":\"both\",\"back\":{\"albedo\":0.1}", "[[1,1],[2,1]]")),
     HR2D_WARNING_IGNORED, ": back: \"albedo\" is not used"},
    {"all passes and half comes back",
     COLLECTION(LAMP "," LINE("\"sides\":\"both\",\"transmittance\":0.8,\"reflectance\":0.4",
                              "[[1,1],[2,1]]")),
     REFUSED, "are together above 1"},
    {"power in watts", COLLECTION(LAMP "," ROOM("\"power\":\"100 W\"", SQUARE)),
     HR2D_WARNING_IGNORED, "\"power\" is not used: write \"heat\""},
};

typedef struct hits {
  const mistake *m;
  size_t hits, others[HR2D_WARNING_COUNT + 1];
} hits;

static hr2d_status take(void *ctx, const hr2d_warning *w) {
  hits *h = ctx;
  h->others[w->code]++;
  if (w->code == h->m->code && strstr(w->text, h->m->says)) h->hits++;
  return HR2D_OK;
}

START_TEST(each_mistake_has_its_message) {
  const mistake *m = &mistakes[_i];
  hits h = {.m = m};
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_status status = hr2d_scene_parse(scene, m->file, strlen(m->file));
  if (!status) status = hr2d_scene_commit(scene);
  const char *message = hr2d_scene_message(scene);
  if (m->code == REFUSED) {
    ck_assert_msg(status != HR2D_OK, "%s: not refused", m->what);
    ck_assert_msg(strstr(message, m->says) != NULL, "%s: %s", m->what, message);
  } else {
    ck_assert_msg(!status, "%s: %s", m->what, message);
    ck_assert_int_eq(hr2d_scene_lint(scene, take, &h, NULL), HR2D_OK);
    ck_assert_msg(h.hits >= 1, "%s: %zu of its code, none with this text", m->what,
                  h.others[m->code]);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* The controls: what is meant as it is drawn has no warning. */

static const char *const sound[] = {
    COLLECTION(LAMP "," WALLS),
    /* a screen with thin ends, a rounded corner, walls back to back */
    COLLECTION(LAMP "," WALLS
                    "," ROOM("\"faces\":\"out\"", "[[1,1],[3,1],[3,1.001],[1,1.001],[1,1]]")),
    COLLECTION(LAMP
               "," ROOM("", "[[0,0],[3.999,0],[3.9999,0.0001],[4,0.001],[4,3],[0,3],[0,0]]")),
    COLLECTION(LAMP "," WALLS "," LINE("\"sides\":\"both\"", "[[2,0],[2,1]]")),
    /* what a file says in its own words beside those of the format */
    COLLECTION(LAMP "," ROOM("\"emissivity\":0.5,\"reflectance\":0.5,\"T\":1", SQUARE)),
    COLLECTION(LAMP "," ROOM("\"temperature\":300,\"emissivity\":0.5", SQUARE)),
    COLLECTION(ROOM("\"temperature\":77", SQUARE) "," ROOM(
        "\"faces\":\"out\",\"temperature\":300", "[[1,1],[2,1],[2,2],[1,2],[1,1]]")),
    WITH("\"hr2d\":{\"wavelengths\":[0.4,2.5,8,100]}", ROOM("\"temperature\":300", SQUARE)),
    WITH("\"hr2d\":{\"sun\":{\"bearing\":[90,180,40],\"irradiance\":800}}",
         LINE("\"reflectance\":0.5", "[[0,0],[4,0]]")),
    COLLECTION(LAMP "," ROOM("\"emission\":1,\"reflectance\":0,\"temperature\":300", SQUARE)),
    COLLECTION(LAMP "," ROOM("", "[[0,0,0],[4,0,0],[4,3,0],[0,3,0],[0,0,0]]")),
    /* an obstacle under the sky sees no patch, but the sky */
    WITH("\"hr2d\":{\"background\":1}", ROOM("\"faces\":\"out\"", SQUARE)),
    /* words of maps */
    COLLECTION(LAMP "," ROOM("\"site\":1,\"tower\":1,\"exit\":1,\"edit\":1,\"mission\":1,"
                             "\"admission\":1,\"template\":1,\"building:material\":\"glass\","
                             "\"face\":1,\"height\":3,\"level\":1,\"roof:colour\":\"red\","
                             "\"power\":\"tower\"",
                             SQUARE)),
    /* what a word was meant for is there */
    COLLECTION(LAMP "," ROOM("\"reflectance\":0.5,\"albedos\":0.5,\"reflectances\":1", SQUARE)),
    /* a two-sided wall of a temperature, and one-sided ones of a flux back to back elsewhere */
    COLLECTION(ROOM("\"temperature\":300", SQUARE) "," LINE(
        "\"temperature\":400,\"sides\":\"both\"", "[[1,1],[2,1]]")),
    /* panels in a row with room between them */
    WITH("\"hr2d\":{\"background\":1}", LINE("\"sides\":\"both\"", "[[0,1],[2,1]]") "," LINE(
                                            "\"sides\":\"both\"", "[[2.02,1],[4,1]]")),
};

static hr2d_status refuse(void *ctx, const hr2d_warning *w) {
  ck_abort_msg("scene %d: %s: %s", *(int *)ctx, hr2d_warning_name(w->code), w->text);
  return HR2D_OK;
}

START_TEST(what_is_meant_has_no_warning) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_parse(scene, sound[_i], strlen(sound[_i])), HR2D_OK);
  ck_assert_msg(!hr2d_scene_commit(scene), "%s", hr2d_scene_message(scene));
  ck_assert_int_eq(hr2d_scene_lint(scene, refuse, &_i, NULL), HR2D_OK);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_status stop(void *ctx, const hr2d_warning *w) {
  ck_assert_uint_eq(w->struct_size, sizeof *w);
  ++*(int *)ctx;
  return HR2D_EIO;
}

static hr2d_status count(void *ctx, const hr2d_warning *w) {
  (void)w;
  ++*(int *)ctx;
  return HR2D_OK;
}

START_TEST(a_visitor_ends_the_call) {
  const char *file = COLLECTION(LAMP "," ROOM("\"rho\":1,\"emissivity\":1", SQUARE));
  hr2d_scene *scene = test_new_scene(NULL);
  int calls = 0;
  ck_assert_int_eq(hr2d_scene_parse(scene, file, strlen(file)), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_lint(scene, stop, &calls, NULL), HR2D_EIO);
  ck_assert_int_eq(calls, 1);
  ck_assert_int_eq(hr2d_scene_lint(scene, count, &calls, NULL), HR2D_OK);
  ck_assert_int_eq(calls, 3);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(options_are_checked) {
  hr2d_lint_options o = HR2D_LINT_OPTIONS_INIT;
  hr2d_scene *scene = test_new_scene(NULL);
  int calls = 0;
  ck_assert_int_eq(hr2d_scene_lint(scene, count, &calls, NULL), HR2D_OK); /* empty */
  o.struct_size = 1;
  ck_assert_int_eq(hr2d_scene_lint(scene, count, &calls, &o), HR2D_EINVAL);
  hr2d_lint_options_init(&o, sizeof o);
  o.gap = .2;
  ck_assert_int_eq(hr2d_scene_lint(scene, count, &calls, &o), HR2D_EINVAL);
  o.gap = -1;
  ck_assert_int_eq(hr2d_scene_lint(scene, count, &calls, &o), HR2D_EINVAL);
  ck_assert_int_eq(calls, 0);
  ck_assert_str_eq(hr2d_warning_name(HR2D_WARNING_LOOSE_END), "loose-end");
  ck_assert_ptr_null(hr2d_warning_name(HR2D_WARNING_COUNT));
  hr2d_scene_destroy(scene);
}
END_TEST

/* Degrees are told once, by "crs" or by the coordinates, and with the zone of UTM there. */
static hr2d_status take_degrees(void *ctx, const hr2d_warning *w) {
  char *text = ctx;
  if (w->code != HR2D_WARNING_DEGREES) return HR2D_OK;
  ck_assert_str_eq(text, "");
  snprintf(text, 512, "%s", w->text);
  return HR2D_OK;
}

#define NAMED(crs) "\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"" crs "\"}}"
#define MUNICH     LINE("", "[[11.5001,48.1001],[11.5003,48.1003]]")
#define RIO        LINE("", "[[-43.2001,-22.9001],[-43.2003,-22.9001]]")
#define LOCAL      LINE("", "[[0.5,0],[4,0]]")
#define PROJECTED  LINE("", "[[691981.5,5331123.25],[691983.5,5331123.25]]")
#define BY_CRS     "are longitude and latitude, as \"crs\" says"
#define BY_LOOK    "look like longitude and latitude"

START_TEST(degrees_are_told_once) {
  static const struct {
    const char *file, *says, *zone;
  } cases[] = {
      {WITH(NAMED("urn:ogc:def:crs:OGC:1.3:CRS84"), MUNICH), BY_CRS, "EPSG:32632"},
      {WITH(NAMED("EPSG:4326"), RIO), BY_CRS, "EPSG:32723"},
      {WITH(NAMED("http://www.opengis.net/def/crs/EPSG/0/4258"), LOCAL), BY_CRS, "EPSG:32631"},
      {WITH("\"crs\":\"EPSG:4326\"", LOCAL), BY_CRS, "EPSG:32631"},
      {COLLECTION(MUNICH), BY_LOOK, "EPSG:32632"},
      {COLLECTION(RIO), BY_LOOK, "EPSG:32723"},
      {WITH(NAMED("EPSG:4326"), LINE("", "[[180,1.5],[180,1.25]]")), BY_CRS, "EPSG:32601"},
      {WITH(NAMED("EPSG:4326"), LINE("", "[[-180,-1.5],[-180,-1.25]]")), BY_CRS, "EPSG:32701"},
      /* controls: metres, whatever the file says, and other systems */
      {WITH(NAMED("urn:ogc:def:crs:OGC:1.3:CRS84"), PROJECTED), NULL, NULL},
      {WITH(NAMED("urn:ogc:def:crs:EPSG::25832"), PROJECTED), NULL, NULL},
      {WITH(NAMED("EPSG:43260"), LOCAL), NULL, NULL},
      {WITH("\"crs\":null", LOCAL), NULL, NULL},
      {WITH("\"crs\":{\"properties\":{\"name\":4326}}", LOCAL), NULL, NULL},
      {COLLECTION(LOCAL), NULL, NULL},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    char text[512] = "";
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(hr2d_scene_parse(scene, cases[k].file, strlen(cases[k].file)), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_lint(scene, take_degrees, text, NULL), HR2D_OK);
    if (cases[k].says)
      ck_assert_msg(strstr(text, cases[k].says) && strstr(text, cases[k].zone), "%zu: %s", k,
                    text);
    else
      ck_assert_msg(!*text, "%zu: %s", k, text);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A file that is refused leaves no notes, and one that is read leaves a bounded number. */
START_TEST(notes_are_of_what_was_read) {
  const char *bad = COLLECTION(LINE("\"rho\":1", "[[0,0],[1,0]]") "," LINE("", "[[0,0]]"));
  char many[4096] = "{\"type\":\"FeatureCollection\",\"hr2d\":{\"a0\":1";
  for (int k = 1; k < 100; k++)
    snprintf(many + strlen(many), sizeof many - strlen(many), ",\"a%d\":1", k);
  strcat(many, "},\"features\":[" LAMP "," WALLS "]}");
  hr2d_scene *scene = test_new_scene(NULL);
  int calls = 0;
  ck_assert_int_eq(hr2d_scene_parse(scene, bad, strlen(bad)), HR2D_ESYNTAX);
  ck_assert_int_eq(hr2d_scene_lint(scene, count, &calls, NULL), HR2D_OK);
  ck_assert_int_eq(calls, 0);
  ck_assert_int_eq(hr2d_scene_parse(scene, many, strlen(many)), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_lint(scene, count, &calls, NULL), HR2D_OK);
  ck_assert_int_eq(calls, 17); /* the last one counts the rest */
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("mistakes") {
  REPEAT_TESTS(sizeof mistakes / sizeof *mistakes, "mistakes", each_mistake_has_its_message);
  REPEAT_TESTS(sizeof sound / sizeof *sound, "controls", what_is_meant_has_no_warning);
  ADD_TESTS("calls", a_visitor_ends_the_call, options_are_checked, degrees_are_told_once,
            notes_are_of_what_was_read);
}
