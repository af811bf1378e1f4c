/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drawings of real buildings as people make them: none of them has a warning, and one mistake
   in one of them has one warning. */
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

enum { ROOM = 1 << 17 };

/* A collection that grows. */
typedef struct drawing {
  char text[ROOM];
  size_t length;
  int features;
} drawing;

__attribute__((format(printf, 2, 3))) static void put(drawing *d, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  d->length +=
      (size_t)vsnprintf(d->text + d->length, sizeof d->text - d->length, format, arguments);
  va_end(arguments);
  ck_assert_uint_lt(d->length, sizeof d->text);
}

static void begin(drawing *d, const char *members) {
  d->length = 0;
  d->features = 0;
  put(d, "{\"type\":\"FeatureCollection\",\"hr2d\":{%s},\"features\":[", members);
}

static void feature(drawing *d, const char *properties, const char *type) {
  put(d,
      "%s{\"type\":\"Feature\",\"properties\":{%s},\"geometry\":{\"type\":\"%s\","
      "\"coordinates\":",
      d->features++ ? "," : "", properties, type);
}

static void box(drawing *d, const char *properties, double x, double y, double w, double h) {
  feature(d, properties, "Polygon");
  put(d, "[[[%.17g,%.17g],[%.17g,%.17g],[%.17g,%.17g],[%.17g,%.17g],[%.17g,%.17g]]]}}", x, y,
      x + w, y, x + w, y + h, x, y + h, x, y);
}

static void line(drawing *d, const char *properties, double x, double y, double to_x,
                 double to_y) {
  feature(d, properties, "LineString");
  put(d, "[[%.17g,%.17g],[%.17g,%.17g]]}}", x, y, to_x, to_y);
}

static hr2d_status keep(void *ctx, const hr2d_warning *w) {
  char *said = ctx;
  const size_t length = strlen(said);
  snprintf(said + length, ROOM - length, "%s: %s\n", hr2d_warning_name(w->code), w->text);
  return HR2D_OK;
}

/* Lines of what the drawing's warnings say. */
static int count_warnings(drawing *d, char *said) {
  int lines = 0;
  put(d, "]}");
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_msg(!hr2d_scene_parse(scene, d->text, d->length), "%s", hr2d_scene_message(scene));
  ck_assert_msg(!hr2d_scene_commit(scene), "%s", hr2d_scene_message(scene));
  said[0] = '\0';
  ck_assert_int_eq(hr2d_scene_lint(scene, keep, said, NULL), HR2D_OK);
  hr2d_scene_destroy(scene);
  for (const char *c = said; *c; c++) lines += *c == '\n';
  return lines;
}

#define OUT "\"faces\":\"out\",\"reflectance\":0.3"

/* Ten houses in a row; those beside each other share the line of their party wall, or have one
   each, `apart` from each other. */
static void draw_terrace(drawing *d, double apart) {
  begin(d, "\"background\":100");
  for (int k = 0; k < 10; k++) box(d, OUT, k * (6.125 + apart), 0.25, 6.125, 9.5);
}

/* A campus: courtyards with an outline and a hole, blocks, a tower, roads between. */
static void draw_campus(drawing *d) {
  begin(d, "\"background\":100,\"sun\":{\"bearing\":-40,\"irradiance\":800}");
  for (int k = 0; k < 12; k++) {
    const double x = 61.3 * (k % 4), y = 47.9 * (k / 4);
    if (k % 3) {
      box(d, OUT, x, y, 31.7 - k, 18.2);
      continue;
    }
    feature(d, OUT, "Polygon");
    put(d,
        "[[[%g,%g],[%g,%g],[%g,%g],[%g,%g],[%g,%g]],[[%g,%g],[%g,%g],[%g,%g],[%g,%g],[%g,%g]]]}"
        "}",
        x, y, x + 40.5, y, x + 40.5, y + 30.5, x, y + 30.5, x, y, x + 10, y + 10, x + 30,
        y + 10, x + 30, y + 20, x + 10, y + 20, x + 10, y + 10);
  }
}

/* Flats: rooms that look in, with walls of 11.5 or 24 cm, or of a line, between them. */
static void draw_flats(drawing *d, double wall) {
  begin(d, "");
  for (int k = 0; k < 9; k++)
    box(d, "\"temperature\":293.15,\"emissivity\":0.9", (k % 3) * (4.2 + wall),
        (k / 3) * (2.65 + wall), 4.2, 2.65);
}

/* A room with a closed plate that is 1e-4 thick and stands at a wall. */
static void draw_plate(drawing *d) {
  static const double at[][2] = {{0, 0},     {1, 0}, {1, .5}, {.6, .5}, {.6, .5001},
                                 {1, .5001}, {1, 1}, {0, 1},  {0, 0}};
  begin(d, "");
  for (size_t k = 0; k + 1 < sizeof at / sizeof *at; k++)
    line(d, k ? "\"reflectance\":0.5" : "\"emission\":1", at[k][0], at[k][1], at[k + 1][0],
         at[k + 1][1]);
}

/* A room with a cupboard at a wall and an inner wall on the floor, which have no light behind.
 */
static void draw_furniture(drawing *d) {
  begin(d, "");
  box(d, "\"emission\":0.1,\"reflectance\":0.5,\"color\":\"#ff0000\"", 0, 0, 5, 4);
  box(d, OUT, 0, 3, .6, 1);
  box(d, OUT, 2, 0, .1, 3);
}

/* A section of a street: ground, fronts of houses, roofs, balconies of both sides. */
static void draw_street(drawing *d) {
  begin(d, "\"background\":100");
  feature(d, "\"reflectance\":0.2", "LineString");
  put(d, "[[0,12],[0,0],[15,0],[15,14]]}}");
  for (int k = 1; k < 4; k++) {
    line(d, "\"sides\":\"both\"", 0, 3. * k, 1.2, 3. * k);
    line(d, "\"sides\":\"both\"", 15, 3. * k, 13.8, 3. * k);
  }
}

/* Rows of panels over ground, in a period and in the open. */
static void draw_panels(drawing *d, int periodic) {
  begin(d, periodic ? "\"background\":100,\"period\":[5,0],\"sun\":{\"bearing\":[-40,0,-89.99],"
                      "\"irradiance\":[800,900,5]}"
                    : "\"background\":100,\"sun\":{\"bearing\":-60,\"irradiance\":800}");
  line(d, "\"reflectance\":0.2", periodic ? 0 : -40, 0, periodic ? 5 : 60, 0);
  for (int k = 0; k < (periodic ? 1 : 4); k++)
    line(d, "\"reflectance\":0.03,\"sides\":\"both\"", 5 * k + 1.6, 1, 5 * k + 3.4, 2);
}

START_TEST(real_drawings_have_no_warning) {
  static char said[ROOM];
  drawing *d = malloc(sizeof *d);
  ck_assert_ptr_nonnull(d);
  switch (_i) {
  case 0:
    draw_terrace(d, 0);
    break;
  case 1:
    draw_terrace(d, .3);
    break;
  case 2:
    draw_campus(d);
    break;
  case 3:
    draw_flats(d, .115);
    break;
  case 4:
    draw_flats(d, .24);
    break;
  case 5:
    draw_flats(d, 0);
    break;
  case 6:
    draw_plate(d);
    break;
  case 7:
    draw_street(d);
    break;
  case 8:
    draw_panels(d, 0);
    break;
  case 9:
    draw_furniture(d);
    break;
  default:
    draw_panels(d, 1);
  }
  const int warnings = count_warnings(d, said);
  ck_assert_msg(warnings == 0, "drawing %d:\n%s", _i, said);
  free(d);
}
END_TEST

START_TEST(all_houses_that_look_in_are_one_warning) {
  static char said[ROOM];
  drawing *d = malloc(sizeof *d);
  ck_assert_ptr_nonnull(d);
  begin(d, "\"background\":100");
  for (int k = 0; k < 10; k++) box(d, "\"reflectance\":0.3", 8. * k, 0, 6, 9);
  ck_assert_msg(count_warnings(d, said) == 1 && !strncmp(said, "no-sky: ", 8), "%s", said);
  free(d);
}
END_TEST

/* Their outer fronts see nothing: three on each side. */
START_TEST(bodies_in_the_open_are_one_warning) {
  static char said[ROOM];
  drawing *d = malloc(sizeof *d);
  ck_assert_ptr_nonnull(d);
  begin(d, "");
  for (int k = 0; k < 9; k++)
    box(d, "\"faces\":\"out\",\"emission\":1", 2. * (k % 3), 2. * (k / 3), 1, 1);
  ck_assert_msg(count_warnings(d, said) == 1 && !strncmp(said, "sees-nothing: ", 14), "%s",
                said);
  ck_assert_msg(strstr(said, " and 9 more:") != NULL, "%s", said);
  free(d);
}
END_TEST

START_TEST(rooms_without_light_are_one_warning) {
  static char said[ROOM];
  drawing *d = malloc(sizeof *d);
  ck_assert_ptr_nonnull(d);
  begin(d, "");
  for (int k = 0; k < 9; k++)
    box(d, k ? "\"reflectance\":0.3" : "\"emission\":1", 8. * k, 0, 6, 9);
  ck_assert_msg(count_warnings(d, said) == 1 && !strncmp(said, "unlit: ", 7), "%s", said);
  ck_assert_msg(strstr(said, " and 29 more:") != NULL, "%s", said);
  free(d);
}
END_TEST

START_TEST(houses_that_look_in_under_a_sun_are_one_warning) {
  static char said[ROOM];
  drawing *d = malloc(sizeof *d);
  ck_assert_ptr_nonnull(d);
  begin(d, "\"sun\":{\"bearing\":-40,\"irradiance\":800}");
  box(d, "\"reflectance\":0.3", 0, 0, 6, 9);
  ck_assert_msg(count_warnings(d, said) == 1 && !strncmp(said, "no-sky: ", 8), "%s", said);
  free(d);
}
END_TEST

TEST_SUITE("drawings") {
  REPEAT_TESTS(11, "controls", real_drawings_have_no_warning);
  ADD_TESTS("mistakes", all_houses_that_look_in_are_one_warning,
            bodies_in_the_open_are_one_warning, rooms_without_light_are_one_warning,
            houses_that_look_in_under_a_sun_are_one_warning);
}
