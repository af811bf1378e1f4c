/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drawings of one endless scene: patches periods apart, sides of a wall in parts, half a strip.
 */
#include <math.h>

#include "support/support.h"

static void add(hr2d_scene *scene, double ax, double ay, double bx, double by) {
  ck_assert_int_eq(
      test_add_patch(scene, (hr2d_segment){{ax, ay}, {bx, by}}, 1, .5, HR2D_SIDES_FRONT),
      HR2D_OK);
}

static void add_mirror(hr2d_scene *scene, double ax, double ay, double bx, double by) {
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{ax, ay}, {bx, by}}), HR2D_OK);
}

/* A street of 3 and a house of 2, drawn `away` periods from it. */
static hr2d_scene *street(int away) {
  hr2d_scene *scene = test_new_scene(NULL);
  add(scene, 0, 0, 3, 0);
  add(scene, 3 + 5. * away, 0, 3 + 5. * away, 4);
  add(scene, 3 + 5. * away, 4, 5 + 5. * away, 4);
  add(scene, 5 + 5. * away, 4, 5 + 5. * away, 0);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){5, 0}), HR2D_OK);
  return scene;
}

/* Crossed strings: of the street the sky has (5 − 4)/3. */
START_TEST(patches_may_be_drawn_periods_apart) {
  for (int away = -1000; away <= 1000; away += 250) {
    hr2d_scene *scene = street(away);
    double area[16], seen = 0;
    test_commit(scene);
    ck_assert_uint_eq(hr2d_scene_images(scene), 3);
    ck_assert(hr2d_scene_cut_off(scene) == 0);
    ck_assert(hr2d_scene_segment(scene, 2).a.x == 3 + 5. * away);
    ck_assert(hr2d_scene_image(scene, 2, 0).a.x == 3 + 5. * away);
    const double apart = hr2d_scene_image(scene, 2, 1).a.x - hr2d_scene_image(scene, 0, 1).a.x;
    ck_assert_double_le(fabs(apart), 5);
    ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
    for (int k = 0; k < 4; k++) seen += area[k];
    ck_assert_double_eq_tol(seen, 3 - (5 - 4), 1e-13);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Patches are where they were if commit fails, and may be committed then. */
START_TEST(failures_leave_patches_where_they_are) {
  hr2d_scene *scene = street(7);
  const double bands[] = {1, 1, 1}, sun_bands[] = {1, 2};
  hr2d_patch many = HR2D_PATCH_INIT;
  many.a = (hr2d_point){4, 5};
  many.b = (hr2d_point){4, 6};
  many.emission = bands;
  many.emission_bands = 3;
  ck_assert_int_eq(hr2d_scene_add(scene, &many, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, sun_bands, 2), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  ck_assert(hr2d_scene_segment(scene, 2).a.x == 3 + 5. * 7);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 5);
  ck_assert_int_eq(hr2d_scene_set_background(scene, sun_bands, 1), HR2D_OK);
  test_commit(scene);
  ck_assert(hr2d_scene_segment(scene, 2).a.x == 3 + 5. * 7);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Two sides of a wall on a line of slope 7/5, one of them in parts that end at its points
   k/8; before a mirror of slope −3/11, which the images of these points are off by roundings.
 */
static hr2d_scene *screen(int parts) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < parts; k++)
    add(scene, 10 + 5. * k / parts, 3 + 7. * k / parts, 10 + 5. * (k + 1) / parts,
        3 + 7. * (k + 1) / parts);
  add(scene, 15, 10, 10, 3);
  add(scene, 8, 9, 9, 4);
  add(scene, 17, 3, 17, 8);
  add_mirror(scene, 0, 0, -11, 3);
  return scene;
}

/* What the patches before and behind the wall exchange with all, is the same for any parts. */
START_TEST(sides_of_a_wall_stay_back_to_back) {
  double whole[16];
  hr2d_scene *scene = screen(1);
  test_commit(scene);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, whole, NULL), HR2D_OK);
  hr2d_scene_destroy(scene);
  for (int parts = 2; parts <= 8; parts *= 2) {
    double area[121];
    const size_t n = (size_t)parts + 3;
    scene = screen(parts);
    test_commit(scene);
    ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
    for (size_t i = 0; i < 3; i++) {
      double sum = 0;
      const double *row = area + (n - 3 + i) * n;
      for (int k = 0; k < parts; k++) sum += row[k];
      ck_assert_double_eq_tol(sum, whole[4 * (1 + i)], 1e-12);
      for (size_t j = 0; j < 3; j++)
        ck_assert_double_eq_tol(row[n - 3 + j], whole[4 * (1 + i) + 1 + j], 1e-12);
    }
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* A reflection of p at the line through 0 along (−11, 3), in long doubles. */
START_TEST(images_are_off_by_roundings_alone) {
  hr2d_scene *scene = screen(8);
  test_commit(scene);
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k), is = hr2d_scene_image(scene, k, 1);
    const long double off = 3.L * s.a.x + 11.L * s.a.y; /* times the length of the normal */
    ck_assert_double_le(fabs((double)(s.a.x - 2 * off * 3 / 130 - is.b.x)), 0x1p-46);
    ck_assert_double_le(fabs((double)(s.a.y - 2 * off * 11 / 130 - is.b.y)), 0x1p-46);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* A mirror is drawn where there is room; digits are those of the patches. */
START_TEST(mirrors_may_be_drawn_far_away) {
  for (int k = 0; k < 2; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    add(scene, -11. / 4, 3. / 4, 3, 7);
    add(scene, 3, 7, -11, 3);
    const double far = k ? 0x1p+20 : 1;
    add_mirror(scene, -11 * far, 3 * far, -11 * (far + 1), 3 * (far + 1));
    test_commit(scene);
    const hr2d_segment is = hr2d_scene_image(scene, 0, 1);
    ck_assert(is.b.x == -11. / 4 && is.b.y == 3. / 4);
    /* (3, 7) less twice its part along (3, 11)/√130 */
    ck_assert_double_eq_tol(is.a.x, 3 - 2 * 86 * 3 / 130., 1e-14);
    ck_assert_double_eq_tol(is.a.y, 7 - 2 * 86 * 11 / 130., 1e-14);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Half of a strip, at a mirror along the period, sees as far as the whole. */
START_TEST(half_a_strip_has_as_many_images_as_the_whole) {
  size_t images[2];
  for (int whole = 0; whole < 2; whole++) {
    hr2d_scene *scene = test_new_scene(NULL);
    add(scene, 1, 4, 0, 4);
    add(scene, .2, 3, .4, 2.9);
    if (whole) {
      add(scene, 0, -4, 1, -4);
      add(scene, .4, -2.9, .2, -3);
    } else {
      add_mirror(scene, 0, 0, 1, 0);
    }
    hr2d_scene_set_period(scene, (hr2d_point){1, 0});
    test_commit(scene);
    images[whole] = hr2d_scene_images(scene);
    hr2d_scene_destroy(scene);
  }
  ck_assert_uint_eq(images[0], 2 * images[1]);
}
END_TEST

TEST_SUITE("redrawn") {
  ADD_TESTS("cells", patches_may_be_drawn_periods_apart, failures_leave_patches_where_they_are,
            half_a_strip_has_as_many_images_as_the_whole);
  ADD_TESTS("mirrors", mirrors_may_be_drawn_far_away);
  ADD_TESTS("walls", sides_of_a_wall_stay_back_to_back, images_are_off_by_roundings_alone);
}
