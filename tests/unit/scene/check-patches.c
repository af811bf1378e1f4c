/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a patch may be: which coordinates, materials, bands, sides and names are refused and
   why, and that a scene keeps what it is given. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "support/support.h"

static void check_add_refused(hr2d_scene *scene, const hr2d_patch *patch, hr2d_status expected,
                              const char *phrase) {
  const size_t before = hr2d_scene_patches(scene);
  size_t index = 77;
  ck_assert_int_eq(hr2d_scene_add(scene, patch, &index), expected);
  test_expect_message(scene, phrase);
  ck_assert_uint_eq(index, 77);
  ck_assert_uint_eq(hr2d_scene_patches(scene), before);
}

START_TEST(patches_without_meaning_are_refused) {
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_black(scene, (const double[]){0, 0, 1, 0});
  const double bad[] = {NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 12; k++) {
    double p[] = {0, 1, 1, 2};
    p[k / 3] = bad[k % 3];
    const hr2d_patch patch = test_patch(p[0], p[1], p[2], p[3]);
    check_add_refused(scene, &patch, HR2D_ESCENE, "patch 1: a coordinate is not finite");
  }
  hr2d_patch patch = test_patch(3, -4.5, 3, -4.5);
  patch.name = "dot";
  check_add_refused(scene, &patch, HR2D_ESCENE,
                    "patch 1 (\"dot\"): its length is zero, at (3, -4.5)");
  patch = test_patch(0., 0, -0., -0.);
  check_add_refused(scene, &patch, HR2D_ESCENE, "patch 1: its length is zero");
  patch = test_patch(0, 1, 1, 1);
  patch.sides = (hr2d_sides)7;
  check_add_refused(scene, &patch, HR2D_EINVAL, "patch 1: sides");
  /* Patch 1 is still to come. */
  patch.sides = HR2D_SIDES_FRONT;
  size_t index = 77;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, &index), HR2D_OK);
  ck_assert_uint_eq(index, 1);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(materials_without_meaning_are_refused) {
  const struct {
    double value;
    const char *emission, *reflectance; /* NULL where the value has a meaning */
  } each[] = {{NAN, "emission is not finite", "reflectance is not finite"},
              {INFINITY, "emission is not finite", "reflectance is not finite"},
              {-INFINITY, "emission is not finite", "reflectance is not finite"},
              {-1e-300, "emission -1e-300 is negative", "reflectance -1e-300 is negative"},
              {1 + DBL_EPSILON, NULL, "reflectance 1.0000000000000002 is above 1"},
              {DBL_MAX, NULL, "reflectance"},
              {1, NULL, NULL},
              {-0., NULL, NULL}};
  for (size_t k = 0; k < 2 * sizeof each / sizeof *each; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    const double value[] = {0.5, each[k / 2].value};
    const char *refused = k % 2 ? each[k / 2].reflectance : each[k / 2].emission;
    hr2d_patch patch = test_patch(0, 0, 1, 0);
    patch.name = "wall";
    *(k % 2 ? &patch.reflectance : &patch.emission) = value;
    *(k % 2 ? &patch.reflectance_bands : &patch.emission_bands) = 2;
    if (refused) {
      check_add_refused(scene, &patch, HR2D_ESCENE, refused);
      test_expect_message(scene, "patch 0 (\"wall\"): ");
    } else {
      ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
    }
    hr2d_scene_destroy(scene);
  }
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_patch patch = test_patch(0, 0, 1, 0);
  patch.emission_bands = 3;
  check_add_refused(scene, &patch, HR2D_EINVAL, "patch 0: emission: 3 bands but no values");
  patch.emission_bands = 0;
  patch.reflectance_bands = 2;
  check_add_refused(scene, &patch, HR2D_EINVAL, "patch 0: reflectance: 2 bands but no values");
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(scenes_are_committed_once) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  test_expect_message(scene, "no patches");
  test_add_black(scene, (const double[]){0, 0, 1, 0});
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESTATE);
  test_expect_message(scene, "committed");
  const hr2d_patch patch = test_patch(0, 1, 1, 1);
  check_add_refused(scene, &patch, HR2D_ESTATE, "committed");
  hr2d_scene_destroy(scene);
  hr2d_scene_destroy(NULL);
}
END_TEST

START_TEST(allocators_must_be_whole) {
  const hr2d_allocator none = {0};
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(&none, &scene), HR2D_EINVAL);
  ck_assert_ptr_null(scene);
}
END_TEST

static void add_bands(hr2d_scene *scene, double y, const double *emission, size_t emissions,
                      const double *reflectance, size_t reflectances) {
  hr2d_patch patch = test_patch(0, y, 1, y);
  patch.emission = emission;
  patch.emission_bands = emissions;
  patch.reflectance = reflectance;
  patch.reflectance_bands = reflectances;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
}

START_TEST(bands_are_broadcast) {
  const double e[] = {1, 2, 3}, rho[] = {.25, .5, .75};
  hr2d_scene *scene = test_new_scene(NULL);
  add_bands(scene, 0, e, 3, rho, 1);
  add_bands(scene, 1, e + 1, 1, rho, 3);
  add_bands(scene, 2, NULL, 0, NULL, 0);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_bands(scene), 3);
  for (size_t band = 0; band < 3; band++) {
    ck_assert_double_eq(hr2d_scene_emission(scene, 0, band), e[band]);
    ck_assert_double_eq(hr2d_scene_reflectance(scene, 0, band), .25);
    ck_assert_double_eq(hr2d_scene_emission(scene, 1, band), 2);
    ck_assert_double_eq(hr2d_scene_reflectance(scene, 1, band), rho[band]);
    ck_assert_double_eq(hr2d_scene_emission(scene, 2, band), 0);
    ck_assert_double_eq(hr2d_scene_reflectance(scene, 2, band), 0);
  }
  const char *reason = NULL;
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_BANDS, &reason), 1);
  ck_assert_str_eq(reason, "3 bands");
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(differing_bands_are_refused) {
  const double value[] = {.1, .2, .3};
  hr2d_scene *scene = test_new_scene(NULL);
  add_bands(scene, 0, value, 1, NULL, 0);
  add_bands(scene, 1, value, 3, value, 1);
  add_bands(scene, 2, value, 3, value, 2);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  test_expect_message(scene, "patch 2 has 2 bands of reflectance where patch 1 has 3 bands");
  hr2d_scene_destroy(scene);
}
END_TEST

/* A commit that fails leaves the scene as it was: it takes more patches, and nothing
   that can be read from it has changed. */
START_TEST(failed_commits_change_nothing) {
  const double value[] = {.1, .2, .3};
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_black(scene, (const double[]){0, -1, 0.5, 3});
  add_bands(scene, 0, value, 3, NULL, 0);
  const size_t bands = hr2d_scene_bands(scene);
  const double length = hr2d_scene_length(scene, 0);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  test_expect_message(scene, "patch 0 and patch 1 cross");
  ck_assert_uint_eq(hr2d_scene_bands(scene), bands);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 2);
  ck_assert_double_eq(hr2d_scene_length(scene, 0), length);
  ck_assert_double_eq(hr2d_scene_segment(scene, 1).b.x, 1);
  ck_assert_str_eq(hr2d_scene_name(scene, 1), "patch 1");
  hr2d_hierarchy *hierarchy = NULL;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &hierarchy), HR2D_ESTATE);
  test_add_black(scene, (const double[]){5, 0, 6, 0});
  ck_assert_uint_eq(hr2d_scene_patches(scene), 3);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(both_sides_are_two_patches) {
  hr2d_scene *scene = test_new_scene(NULL);
  const double e = 2, rho = .5;
  hr2d_patch patch = test_patch(0, 0, 1, 2);
  patch.emission = &e;
  patch.emission_bands = 1;
  patch.reflectance = &rho;
  patch.reflectance_bands = 1;
  patch.sides = HR2D_SIDES_BOTH;
  size_t index = 77;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, &index), HR2D_OK);
  ck_assert_uint_eq(index, 0);
  patch.name = "baffle";
  patch.a.x = patch.b.x = 3;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, &index), HR2D_OK);
  ck_assert_uint_eq(index, 2);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 4);
  const char *const name[] = {"patch 0", "patch 0 (back)", "baffle", "baffle (back)"};
  for (size_t k = 0; k < 4; k++) {
    ck_assert_str_eq(hr2d_scene_name(scene, k), name[k]);
    size_t found = 77;
    ck_assert_int_eq(hr2d_scene_find(scene, name[k], &found), HR2D_OK);
    ck_assert_uint_eq(found, k);
    ck_assert_double_eq(hr2d_scene_emission(scene, k, 0), e);
    ck_assert_double_eq(hr2d_scene_reflectance(scene, k, 0), rho);
  }
  const hr2d_segment front = hr2d_scene_segment(scene, 2), back = hr2d_scene_segment(scene, 3);
  ck_assert_mem_eq(&front.a, &back.b, sizeof front.a);
  ck_assert_mem_eq(&front.b, &back.a, sizeof front.a);
  size_t found = 77;
  ck_assert_int_eq(hr2d_scene_find(scene, "baff", &found), HR2D_EINVAL);
  ck_assert_uint_eq(found, 77);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  const char *reason = NULL;
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_TWO_SIDED, &reason), 1);
  ck_assert_str_eq(reason, "patch 0 and patch 1 (\"patch 0 (back)\") stand back to back");
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(what_is_given_is_copied) {
  hr2d_scene *scene = test_new_scene(NULL);
  char name[] = "wall";
  double value[] = {3, .25};
  hr2d_patch patch = test_patch(0, 0, 1, 0);
  patch.name = name;
  patch.emission = value;
  patch.emission_bands = 1;
  patch.reflectance = value + 1;
  patch.reflectance_bands = 1;
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  memset(name, 'x', 4);
  value[0] = value[1] = NAN;
  ck_assert_str_eq(hr2d_scene_name(scene, 0), "wall");
  ck_assert_double_eq(hr2d_scene_emission(scene, 0, 0), 3);
  ck_assert_double_eq(hr2d_scene_reflectance(scene, 0, 0), .25);
  /* A name of the scene itself, and the same name twice. */
  patch = test_patch(0, 1, 1, 1);
  patch.name = hr2d_scene_name(scene, 0);
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  size_t found = 77;
  ck_assert_int_eq(hr2d_scene_find(scene, "wall", &found), HR2D_OK);
  ck_assert_uint_eq(found, 0);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Whether a text is UTF-8 without characters that are cut short. */
static int whole_utf8(const char *text) {
  for (const unsigned char *c = (const unsigned char *)text; *c;) {
    int more = *c >= 0xF0 ? 3 : *c >= 0xE0 ? 2 : *c >= 0xC0 ? 1 : 0;
    if ((*c & 0xC0) == 0x80) return 0;
    for (c++; more > 0; more--, c++)
      if ((*c & 0xC0) != 0x80) return 0;
  }
  return 1;
}

START_TEST(names_may_be_anything) {
  char many[2001];
  memset(many, 'n', 2000);
  many[2000] = '\0';
  const char *const name[] = {"", "\"quoted\" % %s %n", "Süd-Fenster ☀ 窓", many};
  for (size_t k = 0; k < 4; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    hr2d_patch patch = test_patch(0, 0, 1, 0);
    patch.name = name[k];
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
    ck_assert_str_eq(hr2d_scene_name(scene, 0), name[k]);
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
    test_expect_message(scene, "patch 1 (\"");
    test_expect_message(scene, "is a copy of patch 0 (\"");
    if (k < 3) test_expect_message(scene, name[k]);
    ck_assert_uint_lt(strlen(hr2d_scene_message(scene)), 240);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(long_names_are_cut_between_characters) {
  /* Characters of 2, 3 and 4 bytes, at every offset. */
  const char *const character[] = {"ü", "窓", "🌞"};
  for (size_t k = 0; k < 12; k++) {
    char name[400] = "";
    for (size_t m = 0; m < k / 3; m++) strcat(name, "n");
    for (size_t m = 0; m < 50; m++) strcat(name, character[k % 3]);
    hr2d_scene *scene = test_new_scene(NULL);
    hr2d_patch patch = test_patch(0, 0, 0, 0);
    patch.name = name;
    check_add_refused(scene, &patch, HR2D_ESCENE, "its length is zero");
    ck_assert_msg(whole_utf8(hr2d_scene_message(scene)), "%s", hr2d_scene_message(scene));
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(names_do_not_command_terminals) {
  hr2d_scene *scene = test_new_scene(NULL);
  hr2d_patch patch = test_patch(0, 0, 0, 0);
  patch.name = "red\033[31m\n\r\t\177 wall";
  check_add_refused(scene, &patch, HR2D_ESCENE, "patch 0 (\"red");
  for (const char *c = hr2d_scene_message(scene); *c; c++) {
    ck_assert_int_ge((unsigned char)*c, 0x20);
    ck_assert_int_ne(*c, 0x7F);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("patches") {
  ADD_TESTS("values", patches_without_meaning_are_refused,
            materials_without_meaning_are_refused, scenes_are_committed_once,
            allocators_must_be_whole, failed_commits_change_nothing, both_sides_are_two_patches,
            what_is_given_is_copied);
  ADD_TESTS("bands", bands_are_broadcast, differing_bands_are_refused);
  ADD_TESTS("names", names_may_be_anything, long_names_are_cut_between_characters,
            names_do_not_command_terminals);
}
