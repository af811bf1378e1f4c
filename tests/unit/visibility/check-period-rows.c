/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of exchange areas of a cell with so many patches that few images of it are taken: what
   they are off is in their bounds. */
#include <math.h>
#include <stdlib.h>

#include "support/support.h"

/* Two plates of `each` patches, a unit apart, that repeat with period 1, and a slat between
   them if `height` is above 0. */
static hr2d_scene *make(size_t each, double height) {
  const double black = 0;
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < 2 * each + (height > 0); k++) {
    const double low = (double)(k % each) / (double)each,
                 high = (double)(k % each + 1) / (double)each;
    hr2d_patch p = {.emission = &black,
                    .emission_bands = 1,
                    .reflectance = &black,
                    .reflectance_bands = 1,
                    .a = {k < each ? low : high, k < each ? 0 : 1},
                    .b = {k < each ? high : low, k < each ? 0 : 1}};
    if (k == 2 * each) {
      p.a = (hr2d_point){0.25, height};
      p.b = (hr2d_point){0.7, height};
      p.sides = HR2D_SIDES_BOTH;
    }
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

/* The exchange area of two patches and all images of the second one, with nothing between. */
static double all_images(const hr2d_scene *scene, size_t i, size_t k) {
  const hr2d_segment at = hr2d_scene_segment(scene, i), to = hr2d_scene_segment(scene, k);
  double sum = 0;
  for (int m = -3000; m <= 3000; m++) {
    const hr2d_segment moved = {{to.a.x + m, to.a.y}, {to.b.x + m, to.b.y}};
    sum += hr2d_exchange_area(&at, &moved);
  }
  return sum;
}

typedef struct rows {
  hr2d_exchange_rows *rows;
  double *estimate, *bound;
} rows;

static rows ask(const hr2d_scene *scene) {
  const size_t n = hr2d_scene_patches(scene);
  rows r = {.estimate = malloc(n * sizeof(double)), .bound = malloc(n * sizeof(double))};
  hr2d_matrix_options how = HR2D_MATRIX_OPTIONS_INIT;
  how.cut_off_estimate = r.estimate;
  how.cut_off_bound = r.bound;
  ck_assert_int_eq(hr2d_exchange_rows_create(scene, &how, &r.rows, NULL), HR2D_OK);
  return r;
}

static void forget(rows *r) {
  hr2d_exchange_rows_destroy(r->rows);
  free(r->estimate);
  free(r->bound);
}

static double entry(const rows *r, size_t i, size_t k) {
  const uint64_t *start = hr2d_exchange_rows_start(r->rows);
  for (uint64_t m = start[i]; m < start[i + 1]; m++)
    if (hr2d_exchange_rows_column(r->rows)[m] == k) return hr2d_exchange_rows_area(r->rows)[m];
  return 0;
}

static const size_t sizes[] = {20, 450, 600};
static const size_t images[] = {33, 9, 5};
static const double min[] = {1e-9, 1e-5, 1e-4}; /* what the rows are off, of a patch */

START_TEST(rows_tell_what_they_are_off) {
  const size_t n = sizes[_i];
  /* Of few images there are two cases. */
  if (!test_meets((size_t)_i, 0, 2)) return;
  hr2d_scene *scene = make(n, 0);
  rows r = ask(scene);
  ck_assert_uint_eq(hr2d_scene_images(scene), images[_i]);
  for (size_t i = 0; i < n; i += n / test_some(3, 1)) {
    const double length = hr2d_scene_length(scene, i);
    double off = 0;
    for (size_t k = n; k < 2 * n; k++) off += fabs(entry(&r, i, k) - all_images(scene, i, k));
    ck_assert_double_le(off, r.bound[i]);
    ck_assert_double_le(r.estimate[i], r.bound[i]);
    ck_assert_double_le(off, 4 * r.estimate[i]);
    ck_assert_double_ge(off, min[_i] * length);
    ck_assert_double_le(r.bound[i], 4e4 * min[_i] * length);
  }
  forget(&r);
  hr2d_scene_destroy(scene);
}
END_TEST

/* A slat hides images from some on, and shows others.  Rows of the same scene with more images
   are nearly right: whole plates see what their parts see. */
START_TEST(kinks_are_in_the_bound) {
  const size_t n = 450, few = 18, each = n / few;
  const double highest = test_multiplier() < 0.1 ? 0.5 : 1;
  for (double height = 0.15; height < highest; height += 0.35) {
    hr2d_scene *scene = make(n, height), *coarse = make(few, height);
    rows r = ask(scene), right = ask(coarse);
    ck_assert_uint_lt(hr2d_scene_images(scene), hr2d_scene_images(coarse));
    for (size_t i = 0; i < 2 * few; i++) {
      double off = 0, allowed = right.bound[i];
      for (size_t part = i * each; part < (i + 1) * each; part++) allowed += r.bound[part];
      for (size_t k = 0; k < 2 * few + 2; k++) {
        double sum = 0;
        const size_t first = k < 2 * few ? k * each : 2 * n + k - 2 * few,
                     count = k < 2 * few ? each : 1;
        for (size_t part = i * each; part < (i + 1) * each; part++)
          for (size_t other = first; other < first + count; other++)
            sum += entry(&r, part, other);
        off += fabs(sum - entry(&right, i, k));
      }
      ck_assert_double_le(off, allowed);
    }
    forget(&r);
    forget(&right);
    hr2d_scene_destroy(scene);
    hr2d_scene_destroy(coarse);
  }
}
END_TEST

/* A room, or one of many in a row. */
static hr2d_scene *make_rooms(int period) {
  const double at[][2] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}}, black = 0;
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < 4; k++) {
    const double *a = at[k], *b = at[(k + 1) % 4];
    const hr2d_patch p = {.a = {a[0], a[1]},
                          .b = {b[0], b[1]},
                          .emission = &black,
                          .emission_bands = 1,
                          .reflectance = &black,
                          .reflectance_bands = 1};
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  if (period) ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){3, 0}), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  return scene;
}

/* Nothing is cut off without a period, nor where nobody sees the next image. */
START_TEST(complete_rows_are_not_off) {
  for (int period = 0; period < 2; period++) {
    hr2d_scene *scene = make_rooms(period);
    const size_t n = hr2d_scene_patches(scene);
    double estimate[8], bound[8], area[64];
    hr2d_matrix_options how = HR2D_MATRIX_OPTIONS_INIT;
    how.cut_off_estimate = estimate;
    how.cut_off_bound = bound;
    for (int call = 0; call < 2; call++) {
      for (size_t k = 0; k < n; k++) estimate[k] = bound[k] = 1;
      hr2d_exchange_rows *made = NULL;
      ck_assert_int_eq(call ? hr2d_exchange_rows_create(scene, &how, &made, NULL)
                            : hr2d_exchange_matrix(scene, &how, area, NULL),
                       HR2D_OK);
      hr2d_exchange_rows_destroy(made);
      for (size_t k = 0; k < n; k++) ck_assert(estimate[k] == 0 && bound[k] == 0);
    }
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("period rows") {
  REPEAT_TESTS(3, "plates", rows_tell_what_they_are_off);
  ADD_TESTS("others", kinks_are_in_the_bound, complete_rows_are_not_off);
}
