/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files as programs of others write them, in tests/data/strangers/: each is read as it is, with
   one warning for each kind of thing that is left out. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/scene-files.h"

/* A file, what its patches are called, and what is told of it; of other kinds nothing is. */
static const struct stranger {
  const char *file, *first, *last;
  size_t patches;
  const char *skipped[3], *degrees;
  size_t altitudes;
} strangers[] = {
    /* osmtogeojson: buildings, one of them a relation with a courtyard; nodes, and a centre */
    {"overpass.geojson",
     "Rathaus/1",
     "patch 14",
     15,
     {"polygon 2, ring 1: a position repeats",
      "feature 3, feature 4 (\"Markt 1\") and feature 5: a point is no wall"},
     "look like longitude and latitude",
     0},
    /* IMDF: units with names in languages, and one without a name */
    {"unit.geojson", "Office/1", "Vestiaire/3", 11, {NULL}, "EPSG:32630", 0},
    /* geojson.io: drawn by hand, with simplestyle */
    {"drawing.geojson", "patch 0", "4/3", 5, {"feature 3: a point"}, "EPSG:32631", 0},
    /* no collection */
    {"polygon.geojson", "patch 0", "patch 7", 8, {NULL}, NULL, 0},
    {"geometries.geojson",
     "patch 0",
     "patch 3",
     4,
     {"feature 1: geometry 2: a point"},
     "as \"crs\" says",
     0},
    /* ogr2ogr from DXF: a block of a drawing, in metres */
    {"collection.geojson",
     "true/1",
     "[8,\"b\"]",
     3,
     {"geometry 3: geometry 1: line 1: a position repeats", "geometry 2: a point",
      "feature 3: a geometry has no positions"},
     NULL,
     1},
};

enum { STRANGERS = sizeof strangers / sizeof *strangers };

static const char *stranger_path(const char *file) {
  char path[300];
  snprintf(path, sizeof path, "tests/data/strangers/%s", file);
  return test_source_path(path);
}

typedef struct told {
  const struct stranger *s;
  size_t skipped, degrees, altitudes, found;
} told;

static hr2d_status take(void *ctx, const hr2d_warning *w) {
  told *t = ctx;
  switch (w->code) {
  case HR2D_WARNING_SKIPPED:
    t->skipped++;
    for (size_t k = 0; k < 3; k++)
      t->found += t->s->skipped[k] && strstr(w->text, t->s->skipped[k]);
    break;
  case HR2D_WARNING_DEGREES:
    t->degrees++;
    t->found += t->s->degrees && strstr(w->text, t->s->degrees);
    break;
  case HR2D_WARNING_ALTITUDE:
    t->altitudes++;
    break;
  case HR2D_WARNING_IGNORED:
  case HR2D_WARNING_MISPLACED:
    ck_abort_msg("%s: %s", t->s->file, w->text);
  default: /* of walls and light, as no file has any */
    break;
  }
  return HR2D_OK;
}

static void expect_as_told(const hr2d_scene *scene, const struct stranger *s) {
  told t = {.s = s};
  size_t skipped = 0;
  while (skipped < 3 && s->skipped[skipped]) skipped++;
  ck_assert_uint_eq(hr2d_scene_patches(scene), s->patches);
  file_expect_name(scene, 0, s->first);
  file_expect_name(scene, s->patches - 1, s->last);
  ck_assert_int_eq(hr2d_scene_lint(scene, take, &t, NULL), HR2D_OK);
  ck_assert_msg(t.skipped == skipped && t.degrees == (s->degrees != NULL) &&
                    t.altitudes == s->altitudes && t.found == skipped + t.degrees,
                "%s: %zu skipped, %zu degrees, %zu altitudes, %zu as expected", s->file,
                t.skipped, t.degrees, t.altitudes, t.found);
}

START_TEST(a_file_of_others_is_read) {
  const struct stranger *s = &strangers[_i];
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_status status = hr2d_scene_read(scene, stranger_path(s->file));
  ck_assert_msg(!status, "%s: %s", s->file, hr2d_scene_message(scene));
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  expect_as_told(scene, s);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The text of a file behind a byte order mark; *size is that of both. */
static char *marked(const char *path, size_t *size) {
  enum { MOST = 1 << 16 };
  char *text = malloc(MOST);
  FILE *file = fopen(path, "rb");
  ck_assert_ptr_nonnull(text);
  ck_assert_ptr_nonnull(file);
  memcpy(text, "\xEF\xBB\xBF", 3);
  *size = 3 + fread(text + 3, 1, MOST - 3, file);
  ck_assert_int_eq(fclose(file), 0);
  ck_assert_uint_lt(*size, MOST);
  return text;
}

/* The control: of a file that is damaged nothing is read, wherever the damage is. */
START_TEST(a_mark_changes_nothing_and_a_nul_byte_all) {
  const struct stranger *s = &strangers[_i];
  size_t size;
  char *text = marked(stranger_path(s->file), &size);
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(file_parse_bytes(scene, text, size), HR2D_OK);
  expect_as_told(scene, s);
  hr2d_scene_destroy(scene);

  scene = file_occupied_scene();
  for (size_t k = 5; k < size; k += 7) {
    const char byte = text[k];
    text[k] = '\0';
    file_expect_refused(scene, s->file, file_parse_bytes(scene, text, size), HR2D_ESYNTAX,
                        "line ");
    ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), ": a NUL byte"));
    text[k] = byte;
  }
  hr2d_scene_destroy(scene);
  free(text);
}
END_TEST

/* With a tenth of each length of the text a file is no JSON, and the scene stays as it was. */
START_TEST(a_part_of_a_file_is_refused) {
  const struct stranger *s = &strangers[_i];
  size_t size;
  char *text = marked(stranger_path(s->file), &size);
  hr2d_scene *scene = file_occupied_scene();
  for (size_t k = 1; k < 10; k++)
    file_expect_refused(scene, s->file, file_parse_bytes(scene, text, size * k / 10),
                        HR2D_ESYNTAX, "line ");
  hr2d_scene_destroy(scene);
  free(text);
}
END_TEST

START_TEST(every_file_is_in_the_table) {
  DIR *directory = opendir(stranger_path(""));
  size_t count = 0;
  ck_assert_ptr_nonnull(directory);
  for (struct dirent *entry; (entry = readdir(directory));) count += entry->d_name[0] != '.';
  closedir(directory);
  ck_assert_uint_eq(count, STRANGERS);
}
END_TEST

static hr2d_status read_unit(hr2d_scene *scene) {
  return hr2d_scene_read(scene, stranger_path("unit.geojson"));
}

static hr2d_status read_collection(hr2d_scene *scene) {
  return hr2d_scene_read(scene, stranger_path("collection.geojson"));
}

START_TEST(every_failed_allocation_is_reported) {
  ck_assert_int_ge(file_starve(read_unit, 11), 5);
  ck_assert_int_ge(file_starve(read_collection, 3), 5);
}
END_TEST

TEST_SUITE("strangers") {
  REPEAT_TESTS(STRANGERS, "files", a_file_of_others_is_read,
               a_mark_changes_nothing_and_a_nul_byte_all, a_part_of_a_file_is_refused);
  ADD_TESTS("all", every_file_is_in_the_table, every_failed_allocation_is_reported);
}
