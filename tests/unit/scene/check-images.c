/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Images of mirrors and periods: where they are, how many, and what is refused. */
#include <math.h>
#include <string.h>

#include "support/support.h"

static hr2d_scene *one_patch(void) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(
      test_add_patch(scene, (hr2d_segment){{1, 0}, {3, .5}}, 1, .5, HR2D_SIDES_FRONT), HR2D_OK);
  return scene;
}

static void add_mirror(hr2d_scene *scene, double ax, double ay, double bx, double by) {
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{ax, ay}, {bx, by}}), HR2D_OK);
}

static void expect_segment(hr2d_segment is, double ax, double ay, double bx, double by) {
  ck_assert_double_eq(is.a.x, ax);
  ck_assert_double_eq(is.a.y, ay);
  ck_assert_double_eq(is.b.x, bx);
  ck_assert_double_eq(is.b.y, by);
}

START_TEST(images_keep_their_fronts) {
  hr2d_scene *scene = one_patch();
  add_mirror(scene, 0, 0, 0, 1);
  add_mirror(scene, 7, -1, -2, -1);
  test_commit(scene);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 1);
  ck_assert_uint_eq(hr2d_scene_images(scene), 4);
  expect_segment(hr2d_scene_image(scene, 0, 0), 1, 0, 3, .5);
  expect_segment(hr2d_scene_image(scene, 0, 1), -3, .5, -1, 0);
  expect_segment(hr2d_scene_image(scene, 0, 2), 3, -2.5, 1, -2);
  expect_segment(hr2d_scene_image(scene, 0, 3), -1, -2, -3, -2.5);
  ck_assert_uint_eq(hr2d_scene_mirrors(scene), 2);
  expect_segment(hr2d_scene_mirror(scene, 1), 7, -1, -2, -1);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(ends_on_a_mirror_stay_where_they_are) {
  hr2d_scene *scene = test_new_scene(NULL);
  const double c = cos(.7), s = sin(.7);
  test_add_patch(scene, (hr2d_segment){{3 * c, 3 * s}, {2, 5}}, 1, .5, HR2D_SIDES_FRONT);
  add_mirror(scene, 0, 0, 7 * c, 7 * s);
  test_commit(scene);
  const hr2d_segment is = hr2d_scene_image(scene, 0, 1);
  ck_assert_double_eq(is.b.x, 3 * c);
  ck_assert_double_eq(is.b.y, 3 * s);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A floor without end, between a mirror and its image half a period away, in any direction: H
   under a sky is 1 at the last point, too, where the image goes on. */
START_TEST(images_go_on_where_a_patch_ends) {
  for (int k = 1; k < 100; k++) {
    const double turn = .063 * k, size = 20.7, black = 0, end = 1, sky = 1;
    const hr2d_point to = {size * cos(turn), size * sin(turn)};
    hr2d_scene *scene = test_new_scene(NULL);
    hr2d_solution *solution;
    double value;
    test_add_patch(scene, (hr2d_segment){{0, 0}, to}, black, .5, HR2D_SIDES_FRONT);
    add_mirror(scene, 0, 0, -to.y, to.x);
    ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){2 * to.x, 2 * to.y}), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_set_background(scene, &sky, 1), HR2D_OK);
    test_commit(scene);
    ck_assert_int_eq(hr2d_solve_to(scene, NULL, &solution, NULL), HR2D_OK);
    ck_assert_int_eq(hr2d_solution_gather_irradiance(solution, 0, &end, 1, &value), HR2D_OK);
    ck_assert_double_eq_tol(value, 1, 1e-12);
    hr2d_solution_destroy(solution);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Number 0 is the patch, and each multiple of the period is there once, from −K to K. */
START_TEST(periods_have_images_on_both_sides) {
  hr2d_scene *scene = one_patch();
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){-2, 1}), HR2D_OK);
  test_commit(scene);
  const size_t images = hr2d_scene_images(scene);
  ck_assert_uint_eq(images % 2, 1);
  int sum = 0;
  for (size_t g = 0; g < images; g++) {
    const hr2d_segment is = hr2d_scene_image(scene, 0, g);
    const double k = is.a.y;
    ck_assert_double_eq(is.a.x, 1 - 2 * k);
    ck_assert_double_eq(is.b.y, .5 + k);
    ck_assert_double_le(fabs(k), (double)(images / 2));
    sum += (int)k;
  }
  ck_assert_int_eq(sum, 0);
  ck_assert_double_eq(hr2d_scene_period(scene).x, -2);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Without mirrors and period nothing is there but the patches. */
START_TEST(scenes_without_symmetry_have_none) {
  hr2d_scene *scene = one_patch();
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){0, 0}), HR2D_OK);
  test_commit(scene);
  ck_assert_uint_eq(hr2d_scene_images(scene), 1);
  ck_assert(hr2d_scene_cut_off(scene) == 0);
  expect_segment(hr2d_scene_image(scene, 0, 0), 1, 0, 3, .5);
  hr2d_scene_destroy(scene);
}
END_TEST

static void expect_refusal(hr2d_scene *scene, hr2d_status status, const char *phrase) {
  const size_t patches = hr2d_scene_patches(scene);
  ck_assert_int_eq(hr2d_scene_commit(scene), status);
  test_expect_message(scene, phrase);
  ck_assert_uint_eq(hr2d_scene_patches(scene), patches);
  /* It takes patches still. */
  ck_assert_int_eq(
      test_add_patch(scene, (hr2d_segment){{100, 0}, {101, 0}}, 1, .5, HR2D_SIDES_FRONT),
      HR2D_OK);
  hr2d_scene_destroy(scene);
}

START_TEST(patches_on_both_sides_are_refused) {
  hr2d_scene *scene = one_patch();
  add_mirror(scene, 2, 0, 2, 1);
  expect_refusal(scene, HR2D_ESCENE, "on both sides");
  scene = one_patch();
  test_add_patch(scene, (hr2d_segment){{-3, 0}, {-2, 0}}, 1, .5, HR2D_SIDES_FRONT);
  add_mirror(scene, 0, 0, 0, 1);
  expect_refusal(scene, HR2D_ESCENE, "has patch 1 on its left and patch 0 on its right");
}
END_TEST

START_TEST(a_patch_on_a_mirror_looks_at_the_scene) {
  hr2d_scene *scene = one_patch();
  test_add_patch(scene, (hr2d_segment){{0, 3}, {0, 2}}, 1, .5, HR2D_SIDES_FRONT);
  add_mirror(scene, 0, 0, 0, 1);
  test_commit(scene);
  hr2d_scene_destroy(scene);
  scene = one_patch();
  test_add_patch(scene, (hr2d_segment){{0, 2}, {0, 3}}, 1, .5, HR2D_SIDES_FRONT);
  add_mirror(scene, 0, 0, 0, 1);
  expect_refusal(scene, HR2D_ESCENE, "faces away");
}
END_TEST

START_TEST(other_symmetries_are_refused) {
  hr2d_scene *scene = one_patch();
  add_mirror(scene, 0, 0, 0, 1);
  add_mirror(scene, -1, -1, 0, -2);
  expect_refusal(scene, HR2D_ESCENE, "neither parallel nor perpendicular");
  scene = one_patch();
  add_mirror(scene, 0, 0, 0, 1);
  add_mirror(scene, 0, 5, 0, 3);
  expect_refusal(scene, HR2D_ESCENE, "is on another one");
  scene = one_patch();
  add_mirror(scene, 0, 0, 0, 1);
  hr2d_scene_set_period(scene, (hr2d_point){5, 5});
  expect_refusal(scene, HR2D_ESCENE, "nor perpendicular to the period");
  scene = one_patch();
  add_mirror(scene, 0, 0, 0, 1);
  add_mirror(scene, 4, 0, 4, 1);
  hr2d_scene_set_period(scene, (hr2d_point){0, 5});
  expect_refusal(scene, HR2D_EUNSUPPORTED, "two directions");
}
END_TEST

START_TEST(images_that_cross_are_refused) {
  hr2d_scene *scene = one_patch();
  test_add_patch(scene, (hr2d_segment){{4, -1}, {4, 1}}, 1, .5, HR2D_SIDES_FRONT);
  hr2d_scene_set_period(scene, (hr2d_point){2, 0});
  expect_refusal(
      scene, HR2D_ESCENE,
      "patch 0 and an image of patch 1 cross at (2, 0.25): patches have to end there");
  /* What crosses in the drawing crosses images, and the end of the period, too. */
  scene = test_new_scene(NULL);
  test_add_patch(scene, (hr2d_segment){{0, 0}, {3, 1}}, 1, .5, HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{2.5, -1}, {2.5, 2}}, 1, .5, HR2D_SIDES_FRONT);
  hr2d_scene_set_period(scene, (hr2d_point){2, 0});
  expect_refusal(scene, HR2D_ESCENE, "patch 0 and patch 1 cross at (2.5, 0.833333333)");
}
END_TEST

START_TEST(light_from_outside_is_symmetric) {
  const hr2d_sun across = {{.1, -1}, 1}, along = {{0, -2}, 1};
  const hr2d_sky_piece piece = {10, 20}, whole[2] = {{-20, -10}, {10, 20}};
  const double value[] = {3, 3};
  hr2d_scene *scene = one_patch();
  add_mirror(scene, 0, 0, 0, 1);
  hr2d_scene_set_sun(scene, &across, 1);
  expect_refusal(scene, HR2D_ESCENE, "across mirror 0");
  scene = one_patch();
  add_mirror(scene, 0, 0, 0, 1);
  hr2d_scene_set_sky(scene, &piece, 1, value, 1);
  expect_refusal(scene, HR2D_ESCENE, "the sky must be symmetric");
  scene = one_patch();
  add_mirror(scene, 0, 0, 0, 1);
  hr2d_scene_set_sky(scene, whole, 2, value, 1);
  hr2d_scene_set_sun(scene, &along, 1);
  test_commit(scene);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The light comes down by 1e-4 for each length, past 1,250 images of a patch that is half as
   high as 1: the one before it leaves the part λ at its top, λ/2 = 1e-4 (4 − 2λ). */
START_TEST(low_suns_refuse_nothing) {
  const double t = 1e-4, part = 4 * t / (.5 + 2 * t);
  const hr2d_sun low[2] = {{{1, -1}, 1}, {{1, -t}, 1}};
  double lit[4][2];
  hr2d_scene *scene = one_patch();
  hr2d_scene_set_period(scene, (hr2d_point){4, 0});
  hr2d_scene_set_sun(scene, low, 2);
  test_commit(scene);
  ck_assert_double_eq(hr2d_scene_sunlight_cut_off(scene, 1), 0);
  ck_assert_uint_eq(hr2d_scene_sunlit_parts(scene, 0, 1, lit, 4), 1);
  ck_assert_double_eq_tol(lit[0][0], 1 - part, 1e-12);
  ck_assert_double_eq(lit[0][1], 1);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Light at 0.01° comes down by 1 in 1146 periods of 5, past two plates that close no way. */
START_TEST(low_suns_are_told_band_by_band) {
  const double pi = 3.14159265358979323846, low = .01 * pi / 180;
  const hr2d_sun sun[3] = {
      {{1, -1}, 800}, {{cos(low), -sin(low)}, 5}, {{-cos(low), -sin(low)}, 0}};
  hr2d_scene *scene = test_new_scene(NULL);
  test_add_patch(scene, (hr2d_segment){{0, 0}, {5, 0}}, 0, .5, HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{1, 1}, {2, 1}}, 0, .5, HR2D_SIDES_BOTH);
  hr2d_scene_set_period(scene, (hr2d_point){5, 0});
  hr2d_scene_set_sun(scene, sun, 3);
  test_commit(scene);
  ck_assert_double_eq(hr2d_scene_sunlight_cut_off(scene, 0), 0);
  ck_assert_double_eq(hr2d_scene_sunlight_cut_off(scene, 1), 5);
  ck_assert_double_eq(hr2d_scene_sunlight_cut_off(scene, 2), 0);
  ck_assert(isnan(hr2d_scene_sunlight_cut_off(scene, 3)));
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(setters_check_what_they_get) {
  hr2d_scene *scene = one_patch();
  const hr2d_segment point = {{1, 1}, {1, 1}}, line = {{0, 0}, {0, 1}};
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, point), HR2D_ESCENE);
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{0, NAN}, {1, 1}}), HR2D_ESCENE);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){INFINITY, 0}), HR2D_ESCENE);
  ck_assert_uint_eq(hr2d_scene_mirrors(scene), 0);
  test_commit(scene);
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, line), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_ESTATE);
  hr2d_scene_destroy(scene);
  scene = one_patch();
  for (int k = 0; k < 3; k++) ck_assert_int_eq(hr2d_scene_add_mirror(scene, line), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, line), HR2D_EUNSUPPORTED);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_status keep(void *ctx, const hr2d_warning *warning) {
  hr2d_warning *kept = ctx;
  if (warning->code == HR2D_WARNING_LOOSE_END) *kept = *warning;
  ck_assert_uint_lt(warning->patches > 0 ? warning->patch[0] : 0, 2);
  return HR2D_OK;
}

/* An end that is short of a mirror is twice as far from its image; one on the mirror is not. */
START_TEST(ends_short_of_a_mirror_are_warned_of) {
  for (int k = 0; k < 2; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    hr2d_warning warning = {0};
    test_add_patch(scene, (hr2d_segment){{k ? 0 : 5e-4, 0}, {2, 0}}, 1, .5, HR2D_SIDES_FRONT);
    test_add_patch(scene, (hr2d_segment){{2, 0}, {0, 3}}, 1, .5, HR2D_SIDES_FRONT);
    add_mirror(scene, 0, 0, 0, 1);
    test_commit(scene);
    ck_assert_int_eq(hr2d_scene_lint(scene, keep, &warning, NULL), HR2D_OK);
    ck_assert_uint_eq(warning.patches, k ? 0 : 2);
    if (!k) ck_assert_double_eq_tol(warning.gap, 1e-3, 1e-15);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

static const char file[] =
    "{\"type\":\"FeatureCollection\",\"hr2d\":{%s},\"features\":["
    "{\"type\":\"Feature\",\"properties\":{\"emission\":1},\"geometry\":{\"type\":"
    "\"LineString\","
    "\"coordinates\":[[0,0],[1,0]]}},"
    "{\"type\":\"Feature\",\"properties\":{\"sides\":\"mirror\"%s},\"geometry\":{\"type\":"
    "\"LineString\",\"coordinates\":[[0,0],[0,1]%s]}}]}";

static hr2d_status read_file(hr2d_scene *scene, const char *hr2d, const char *property,
                             const char *position) {
  char text[sizeof file + 200];
  snprintf(text, sizeof text, file, hr2d, property, position);
  return hr2d_scene_parse(scene, text, strlen(text));
}

START_TEST(files_have_mirrors_and_a_period) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_int_eq(read_file(scene, "\"period\":[0,2.5]", "", ""), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 1);
  ck_assert_uint_eq(hr2d_scene_mirrors(scene), 1);
  ck_assert_double_eq(hr2d_scene_period(scene).y, 2.5);
  expect_segment(hr2d_scene_mirror(scene, 0), 0, 0, 0, 1);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(files_with_other_mirrors_are_refused) {
  static const struct {
    const char *hr2d, *property, *position, *phrase;
    hr2d_status status;
  } bad[] = {
      {"", ",\"reflectance\":1", "", "a mirror is a line of symmetry", HR2D_ESCENE},
      {"", "", ",[1,1]", "two positions", HR2D_ESCENE},
      {"\"period\":3", "", "", "must be [dx, dy]", HR2D_ESYNTAX},
      {"\"period\":[1,2,3]", "", "", "must be [dx, dy]", HR2D_ESYNTAX},
      {"\"period\":[1,\"2\"]", "", "", "must be [dx, dy]", HR2D_ESYNTAX},
  };
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    ck_assert_int_eq(read_file(scene, bad[k].hr2d, bad[k].property, bad[k].position),
                     bad[k].status);
    test_expect_message(scene, bad[k].phrase);
    ck_assert_uint_eq(hr2d_scene_patches(scene), 0);
    ck_assert_uint_eq(hr2d_scene_mirrors(scene), 0);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("images") {
  ADD_TESTS("images", images_keep_their_fronts, ends_on_a_mirror_stay_where_they_are,
            images_go_on_where_a_patch_ends, periods_have_images_on_both_sides,
            scenes_without_symmetry_have_none);
  ADD_TESTS("refusals", patches_on_both_sides_are_refused,
            a_patch_on_a_mirror_looks_at_the_scene, other_symmetries_are_refused,
            images_that_cross_are_refused, light_from_outside_is_symmetric,
            low_suns_refuse_nothing, low_suns_are_told_band_by_band,
            setters_check_what_they_get);
  ADD_TESTS("warnings", ends_short_of_a_mirror_are_warned_of);
  ADD_TESTS("files", files_have_mirrors_and_a_period, files_with_other_mirrors_are_refused);
}
