/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scene files of View2D: the scene is what View2D itself would read, in any locale, and
   nothing is dropped silently.  Files that must be refused are in malformed/. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <float.h>
#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/scene-files.h"

enum { TEXT = 4096 };

/* A triangular room. */
#define VERTICES "V 1 0 0\nV 2 4 0\nV 3 0 3\n"
#define SURFACES "S 1 1 2 0 0 0 0.75 floor\nS 2 2 3 0 0 0 0.5 roof\nS 3 3 1 0 0 0 1 wall\n"

static void expect_room(const hr2d_scene *scene, size_t first) {
  ck_assert_uint_eq(hr2d_scene_patches(scene), first + 3);
  static const char *const names[] = {"floor", "roof", "wall"};
  static const double corner[4][2] = {{0, 0}, {4, 0}, {0, 3}, {0, 0}};
  static const double reflectance[] = {0.25, 0.5, 0};
  for (size_t k = 0; k < 3; k++) {
    file_expect_segment(scene, first + k, corner[k][0], corner[k][1], corner[k + 1][0],
                        corner[k + 1][1]);
    file_expect_name(scene, first + k, names[k]);
    ck_assert_double_eq(hr2d_scene_reflectance(scene, first + k, 0), reflectance[k]);
    ck_assert_double_eq(hr2d_scene_emission(scene, first + k, 0), 0);
  }
}

/* The shipped scenes, read a second time by scanf(). */

typedef struct scanned {
  double x[256], y[256];
  size_t vertices, surfaces;
} scanned;

static void scan_line(const char *line, scanned *s, const hr2d_scene *scene) {
  size_t n, v1, v2;
  double emittance;
  char name[32];
  if (sscanf(line, "V %zu", &n) == 1) {
    ck_assert_uint_lt(n, 256);
    ck_assert_int_eq(sscanf(line, "V %*u %lf %lf", &s->x[n], &s->y[n]), 2);
    s->vertices++;
  }
  if (sscanf(line, "S %zu %zu %zu %*d %*d %*d %lf %31s", &n, &v1, &v2, &emittance, name) == 5) {
    ck_assert_uint_le(n, hr2d_scene_patches(scene));
    file_expect_segment(scene, n - 1, s->x[v1], s->y[v1], s->x[v2], s->y[v2]);
    ck_assert_double_eq(hr2d_scene_reflectance(scene, n - 1, 0), 1 - emittance);
    file_expect_name(scene, n - 1, name);
    s->surfaces++;
  }
}

static hr2d_scene *shipped(const char *file, size_t surfaces) {
  char line[256];
  hr2d_scene *scene = test_shipped_scene(file);
  FILE *stream = fopen(test_scene_path(file), "r");
  ck_assert_ptr_nonnull(stream);
  scanned s = {.vertices = 0};
  while (fgets(line, sizeof line, stream)) scan_line(line, &s, scene);
  fclose(stream);
  ck_assert_uint_eq(s.surfaces, surfaces);
  ck_assert_uint_eq(hr2d_scene_patches(scene), surfaces);
  return scene;
}

START_TEST(shipped_scenes_are_read_as_written) {
  hr2d_scene *scene = shipped("occ128.vs2", 128);
  /* All fronts look into the unit square around the obstacles, so that they sum to 0. */
  const file_outline o = file_outline_of(scene);
  ck_assert_double_lt(fabs(o.x) + fabs(o.y), 1e-8);
  ck_assert_double_lt(o.area, 1);
  ck_assert_double_gt(o.area, 0.5);
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL), 1);
  hr2d_scene_destroy(scene);

  scene = shipped("blk1.vs2", 4);
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL), 1);
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_EMISSION, NULL), 0);
  hr2d_scene_destroy(scene);
}
END_TEST

/* How a file may be laid out. */

START_TEST(layout_does_not_matter) {
  static const char *const texts[] = {
      "T room\nC 1 0 1e-5 6 0 0\nG 2\n" VERTICES SURFACES "End of data\n",
      VERTICES SURFACES,
      VERTICES "S 1 1 2 0 0 0 0.75 floor\nS 2 2 3 0 0 0 0.5 roof\nS 3 3 1 0 0 0 1 wall",
      "\xEF\xBB\xBFT\n" VERTICES SURFACES "*\n",
      "! comment\n\n/ comment\n  \t\n//\n" VERTICES "/\n" SURFACES "E\n\n! done\n/\n",
      "t\ng 2 ! plane\n" VERTICES SURFACES "end\n",
      "C encl=1 list=2\n" VERTICES SURFACES "***** end of data *****\n",
      "T  a title, with \"quotes\", {braces}, !\n" VERTICES SURFACES,
      ("v,1,0,0\nv,2 , 4 ,0,\n \tv\t3\t0\t3\t! apex\n  s 1,1,2,0,0,0,0.75,floor, ! below\n"
       "s 2 +2 3 0 0 0 0.5 roof !comment\nS 03 3 1 -5 17 999999999999999999999 1. wall\n"),
  };
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    const hr2d_status status = file_parse(scene, texts[k]);
    ck_assert_msg(status == HR2D_OK, "%zu: %s", k, hr2d_scene_message(scene));
    expect_room(scene, 0);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(a_comment_begins_with_a_word_of_its_own) {
  hr2d_scene *scene = file_parsed(VERTICES "S 1 1 2 0 0 0 1 a!b\nS 2 2 3 0 0 0 1 /c !d\n");
  file_expect_name(scene, 0, "a!b");
  file_expect_name(scene, 1, "/c");
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(lines_end_as_in_any_system) {
  static const char text[] = "T room\nG 2\n" VERTICES "\n! a room\n" SURFACES "End of data\n";
  static const char *const ends[] = {"\n", "\r\n", "\r"};
  for (size_t e = 0; e < 3; e++) {
    char converted[2 * sizeof text] = "";
    for (const char *c = text; *c; c++) {
      const char same[] = {*c, '\0'};
      strcat(converted, *c == '\n' ? ends[e] : same);
    }
    hr2d_scene *scene = file_parsed(converted);
    expect_room(scene, 0);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Each file numbers its vertices and surfaces by itself. */
START_TEST(files_add_up) {
  hr2d_scene *scene = file_occupied_scene();
  for (size_t k = 0; k < 3; k++) {
    ck_assert_int_eq(hr2d_scene_parse(scene, VERTICES SURFACES, strlen(VERTICES SURFACES)),
                     HR2D_OK);
    expect_room(scene, 1 + 3 * k);
  }
  file_expect_name(scene, 0, "before");
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(free_space_is_on_the_left) {
  hr2d_scene *scene = file_parsed(VERTICES SURFACES);
  const hr2d_point inside = {1, 1};
  for (size_t k = 0; k < 3; k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    ck_assert_int_eq(hr2d_orientation(s.a, s.b, inside), 1);
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_bands(scene), 1);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(the_text_tells_its_format) {
  static const struct {
    const char *text, *phrase;
    hr2d_status status;
  } cases[] = {
      {"", "line 1, column ", HR2D_ESYNTAX},
      {" \n! a comment and nothing else\n", "line 2, column ", HR2D_ESYNTAX},
      {"// JSON\n{}", "line 1, column ", HR2D_ESYNTAX},
      {"! room\n[]", "line 1, column ", HR2D_ESYNTAX},
      {"true", "line 1, column ", HR2D_ESYNTAX},
      {"Some words", "line 1, column ", HR2D_ESYNTAX},
      {"[]", "not a GeoJSON FeatureCollection", HR2D_ESYNTAX},
      {"{}", "not a GeoJSON FeatureCollection", HR2D_ESYNTAX},
      {"T", "line 1: the data end without a surface", HR2D_ESCENE},
      {"/\n* [1]", "line 2: the data end without a surface", HR2D_ESCENE},
      {"/ {\n!}\n\n\tv 1 0", "line 4: y is missing", HR2D_ESYNTAX},
      {"X 1", "line 1: unknown record \"X\"", HR2D_ESYNTAX},
      {"T\nfurther words", "line 2: unknown record \"further\"", HR2D_ESYNTAX},
  };
  hr2d_scene *scene = file_occupied_scene();
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const hr2d_status status = file_parse(scene, cases[k].text);
    file_expect_refused(scene, cases[k].text, status, cases[k].status, cases[k].phrase);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* Numbers. */

static void write_wall(char *text, size_t size, int k, double c[4]) {
  (void)k;
  snprintf(text, size, "V 1 %.17g %.17g\nV 2 %.17g %.17g\nS 1 1 2 0 0 0 0 a", c[0], c[1], c[2],
           c[3]);
}

START_TEST(coordinates_keep_every_bit) {
  file_expect_bits(write_wall);
}
END_TEST

START_TEST(numbers_have_many_forms) {
  static const struct {
    const char *word;
    double value;
  } forms[] = {{".5", 0.5},     {"10.", 10},  {"+3", 3},        {"-.25E+2", -25},
               {"1.e-4", 1e-4}, {"007", 7},   {"1e-999", 0},    {"4.9e-324", 0x1p-1074},
               {"-0", -0.0},    {"0.1", 0.1}, {"1e308", 1e308}, {"000000.000000e99", 0}};
  char text[TEXT];
  for (size_t k = 0; k < sizeof forms / sizeof *forms; k++) {
    snprintf(text, sizeof text, "V 1 %s 1\nV 2 77 -77\nS 1 1 2 0 0 0 .9 a\n", forms[k].word);
    hr2d_scene *scene = file_parsed(text);
    file_expect_segment(scene, 0, forms[k].value, 1, 77, -77);
    hr2d_scene_destroy(scene);
  }
  static const char *const words[] = {"1e",    "e5",  ".",     "+",       "--1", "1d0",
                                      "1.0.0", "nan", "NAN()", "Inf",     "0x1", "0x1p3",
                                      "1e5e",  "1_0", "1;",    "\xC2\xBD"};
  hr2d_scene *scene = file_occupied_scene();
  for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
    snprintf(text, sizeof text, "V 1 %s 1\n", words[k]);
    const hr2d_status status = file_parse(scene, text);
    ck_assert_msg(status == HR2D_ESYNTAX, "%s: %d", words[k], (int)status);
    ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), "line 1: x must be a number, not"));
    file_expect_unchanged(scene);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* strtod() takes "0,5" before and after. */
static void expect_numbers_with_commas_around(void) {
  ck_assert_double_eq(strtod("0,5", NULL), 0.5);
  hr2d_scene *scene = file_parsed("V 1 .5 1.25e1\nV 2 -7.5 2\nS 1 1 2 0 0 0 0.75 a\n");
  file_expect_segment(scene, 0, 0.5, 12.5, -7.5, 2);
  ck_assert_double_eq(hr2d_scene_reflectance(scene, 0, 0), 0.25);
  ck_assert_int_eq(hr2d_scene_parse(scene, "V 1 ze.o", 8), HR2D_ESYNTAX);
  ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), "ze.o"));
  ck_assert_double_eq(strtod("0,5", NULL), 0.5);
  hr2d_scene_destroy(scene);
}

#ifdef _WIN32
START_TEST(the_locale_does_not_matter_and_is_kept) {
  ck_assert_ptr_nonnull(setlocale(LC_NUMERIC, "German"));
  expect_numbers_with_commas_around();
  setlocale(LC_NUMERIC, "C");
}
END_TEST
#else
/* A locale in which strtod() takes "0,5": an installed one, or one made for the test. */
static int set_comma_locale(void) {
  static const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE.utf8",
                                      "fr_FR.utf8",  "de_DE",       "fr_FR"};
  for (size_t k = 0; k < sizeof names / sizeof *names; k++)
    if (setlocale(LC_NUMERIC, names[k]) && strtod("0,5", NULL) == 0.5) return 1;
  return 0;
}

static void remove_locale(const char *directory) {
  char command[TEXT];
  snprintf(command, sizeof command, "rm -r '%s'", directory);
  ck_assert_int_eq(system(command), 0);
}

START_TEST(the_locale_does_not_matter_and_is_kept) {
  char directory[] = "/tmp/check_vs2_XXXXXX", command[TEXT];
  int made = 0;
  if (!set_comma_locale()) {
    ck_assert_ptr_nonnull(mkdtemp(directory));
    made = 1;
    snprintf(command, sizeof command,
             "localedef -i de_DE -f UTF-8 '%s/de_DE.UTF-8' >/dev/null 2>&1", directory);
    if (system(command) == 0) setenv("LOCPATH", directory, 1);
    if (!set_comma_locale()) {
      printf("no locale with a decimal comma: skipped\n");
      remove_locale(directory);
      return;
    }
  }
  const locale_t mine = duplocale(LC_GLOBAL_LOCALE);
  ck_assert(mine != (locale_t)0);
  for (int of_thread = 0; of_thread < 2; of_thread++) {
    const locale_t expected = of_thread ? mine : LC_GLOBAL_LOCALE;
    uselocale(expected);
    expect_numbers_with_commas_around();
    ck_assert(uselocale((locale_t)0) == expected);
  }
  uselocale(LC_GLOBAL_LOCALE);
  freelocale(mine);
  setlocale(LC_NUMERIC, "C");
  if (made) {
    unsetenv("LOCPATH");
    remove_locale(directory);
  }
}
END_TEST
#endif

/* Damage, size and memory. */

static const char good[] = "T  a room\nC  1 0 1.e-5 6 0 0\nG  2\n!  # x y\n" VERTICES
                           "S 1 1 2 0 0 0 0.90 d\xC3\xA9j\xC3\xA0\n/\n"
                           "S 2 2 3 0 0 1 .5 roof ! above\nEnd of data\n";

static int read_or_refused(const char *text, size_t size) {
  return file_read_or_refused(text, size, "line ");
}

/* A file may end without saying so, but not before its first surface has a name. */
START_TEST(every_truncation_is_read_or_refused) {
  const size_t named = (size_t)(strstr(good, " d\xC3\xA9") + 2 - good);
  for (size_t k = 0; k < named; k++) ck_assert(!read_or_refused(good, k));
  ck_assert(read_or_refused(good, named));
  ck_assert_msg(!read_or_refused(good, named + 1), "half a character");
  for (size_t k = named + 2; k < sizeof good; k++) read_or_refused(good, k);
  ck_assert(read_or_refused(good, sizeof good - 1));
}
END_TEST

START_TEST(random_damage_is_refused_or_read) {
  FILE_EXPECT_DAMAGE(good, "!/*,.-+eE019 \t\n\r\0\x80\xFFTCGVSOX", "line ");
}
END_TEST

/* `head`, a million of `middle`, `tail`: read in a few times its size of memory. */
static void expect_huge(const char *head, char middle, const char *tail, hr2d_status expected,
                        const char *phrase) {
  enum { SIZE = 1000000 };
  char *text = malloc(SIZE + 2 * TEXT);
  ck_assert_ptr_nonnull(text);
  const size_t before = strlen(head), size = before + SIZE + strlen(tail);
  strcpy(text, head);
  memset(text + before, middle, SIZE);
  strcpy(text + before + SIZE, tail);
  test_meter m = {0, 0};
  const hr2d_allocator hooks = test_metered(&m);
  hr2d_scene *scene = test_new_scene(&hooks);
  const hr2d_status status = file_parse_bytes(scene, text, size);
  ck_assert_msg(status == expected, "%s: %d, %s", phrase, (int)status,
                hr2d_scene_message(scene));
  if (status) ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), phrase));
  ck_assert_int_lt(m.peak, 8 * (long long)size);
  hr2d_scene_destroy(scene);
  ck_assert_int_eq(m.held, 0);
  free(text);
}

START_TEST(huge_lines_and_words_are_no_trouble) {
  const char *wall = "\nV 2 1 1\nS 1 1 2 0 0 0 1 wall\n";
  expect_huge("V 1 0 0.", '0', wall, HR2D_OK, "");
  expect_huge("V 1 0 0.3", '3', wall, HR2D_OK, "");
  expect_huge("V 1 0 ", '1', wall, HR2D_ESYNTAX, "line 1: y is beyond a double: \"111");
  expect_huge("V 1 0 1e", '9', wall, HR2D_ESYNTAX, "line 1: y is beyond a double: \"1e9");
  expect_huge("V ", '9', " 0 0\n", HR2D_ESYNTAX, "line 1: vertex \"999");
  expect_huge("T ", '!', VERTICES SURFACES, HR2D_ESYNTAX, "line 2: vertex \"2\" where 1 ");
  expect_huge("T\n!", '!', "\n" VERTICES SURFACES, HR2D_OK, "");
  expect_huge("T", '\n', VERTICES SURFACES, HR2D_OK, "");
  expect_huge("T\n", '/', "\n" VERTICES SURFACES, HR2D_OK, "");
  expect_huge("T\n", '\0', "\n" VERTICES SURFACES, HR2D_ESYNTAX, "line 2: ");
  expect_huge("T\n", 'x', "\n", HR2D_ESYNTAX, "line 2: unknown record \"xxx");
  expect_huge(VERTICES "S 1 1 2 0 0 0 1 ", '\x80', "", HR2D_ESYNTAX, "name must be UTF-8");
  expect_huge(VERTICES "S 1 1 2 0 0 0 1 ", 'n', "", HR2D_OK, "");
}
END_TEST

/* Many records, through a file: memory stays a multiple of it. */
START_TEST(a_long_file_is_read_whole) {
  enum { COUNT = 20000 };
  char path[] = "/tmp/check_vs2_XXXXXX";
  FILE *file = file_temporary(path);
  for (int k = 1; k <= COUNT; k++) fprintf(file, "V %d %d.5 %d\n", k, k, k * (k % 7));
  for (int k = 1; k < COUNT; k++) fprintf(file, "S %d %d %d 0 0 0 .5 s\n", k, k, k + 1);
  const long size = ftell(file);
  ck_assert_int_eq(fclose(file), 0);
  test_meter m = {0, 0};
  const hr2d_allocator hooks = test_metered(&m);
  hr2d_scene *scene = test_new_scene(&hooks);
  ck_assert_int_eq(hr2d_scene_read(scene, path), HR2D_OK);
  unlink(path);
  ck_assert_uint_eq(hr2d_scene_patches(scene), COUNT - 1);
  for (int k = 1; k < COUNT; k++)
    file_expect_segment(scene, (size_t)k - 1, k + .5, k * (k % 7), k + 1.5,
                        (k + 1) * ((k + 1) % 7));
  ck_assert_int_lt(m.peak, 16 * size);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_status read_good(hr2d_scene *scene) {
  return hr2d_scene_parse(scene, good, sizeof good - 1);
}

/* At least the words, the vertices, the patches, two names and two reflectances. */
START_TEST(every_failed_allocation_is_reported) {
  ck_assert_int_ge(file_starve(read_good, 2), 6);
}
END_TEST

TEST_SUITE("vs2") {
  ADD_TESTS("content", shipped_scenes_are_read_as_written, layout_does_not_matter,
            a_comment_begins_with_a_word_of_its_own, lines_end_as_in_any_system, files_add_up,
            free_space_is_on_the_left, the_text_tells_its_format);
  ADD_TESTS("numbers", coordinates_keep_every_bit, numbers_have_many_forms,
            the_locale_does_not_matter_and_is_kept);
  ADD_TESTS("damage", every_truncation_is_read_or_refused, random_damage_is_refused_or_read,
            huge_lines_and_words_are_no_trouble, a_long_file_is_read_whole,
            every_failed_allocation_is_reported);
}
