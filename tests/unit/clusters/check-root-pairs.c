/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pairs that a refinement begins with, against what sees what. */
#include <check.h>
#include <hr2d/hr2d.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "clusters/root-pairs.h"
#include "scene/scene-impl.h"
#include "support/slow-scenes.h"
#include "support/support.h"

static hr2d_scene *draw(slow_kind kind, size_t patches) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(slow_add(scene, kind, patches), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* Pairs that see each other and are no roots, or are roots twice. */
static size_t count_faults(const hr2di_roots *roots, const hr2d_scene *scene) {
  const size_t n = hr2d_scene_patches(scene);
  double *area = malloc(n * n * sizeof *area);
  unsigned char *times = calloc(n * n, 1);
  size_t faults = 0;
  ck_assert_ptr_nonnull(area);
  ck_assert_ptr_nonnull(times);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
  for (size_t k = 0; k < roots->count; k++)
    times[roots->pair[k].first * n + roots->pair[k].second]++;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++)
      faults += times[i * n + j] > 1 || (area[i * n + j] > 0 && times[i * n + j] == 0);
  free(area);
  free(times);
  return faults;
}

/* Rows are in order and hold the pairs of their patch. */
static void check_rows(const hr2di_roots *roots, size_t patches) {
  ck_assert_uint_eq(roots->row[0], 0);
  ck_assert_uint_eq(roots->row[patches], roots->count);
  for (size_t i = 0; i < patches; i++)
    for (size_t k = roots->row[i]; k < roots->row[i + 1]; k++) {
      ck_assert_uint_eq(roots->pair[k].first, i);
      ck_assert_uint_gt(roots->pair[k].second, i);
      ck_assert(k == roots->row[i] || roots->pair[k - 1].second < roots->pair[k].second);
    }
}

static const slow_kind hiding[] = {SLOW_SQUARES, SLOW_CITY, SLOW_SOUP};

START_TEST(beams_find_what_is_seen) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_scene *scene = draw(hiding[_i], 600);
  const size_t n = hr2d_scene_patches(scene);
  hr2di_roots roots;
  ck_assert_int_eq(hr2di_roots_init(&roots, scene, &alloc, 1e-6, 1, NULL), HR2D_OK);
  ck_assert_ptr_null(roots.clusters);
  check_rows(&roots, n);
  ck_assert_uint_eq(count_faults(&roots, scene), 0);
  ck_assert_uint_lt(roots.count, 100 * n);
  hr2di_roots shared;
  ck_assert_int_eq(hr2di_roots_init(&shared, scene, &alloc, 1e-6, 3, NULL), HR2D_OK);
  ck_assert_uint_eq(shared.count, roots.count);
  ck_assert_mem_eq(shared.pair, roots.pair, roots.count * sizeof *roots.pair);
  hr2di_roots_clear(&shared, &alloc);
  roots.pair[roots.count / 2] = roots.pair[roots.count / 2 - 1];
  ck_assert_uint_ge(count_faults(&roots, scene), 1);
  hr2di_roots_clear(&roots, &alloc);
  hr2d_scene_destroy(scene);
}
END_TEST

/* In a round room all see all, and clusters have to spare pairs. */
START_TEST(clusters_where_much_is_seen) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_scene *scene = draw(SLOW_ROUND, 600);
  hr2di_roots roots;
  ck_assert_int_eq(hr2di_roots_init(&roots, scene, &alloc, 1e-6, 1, NULL), HR2D_OK);
  ck_assert_ptr_nonnull(roots.clusters);
  ck_assert_uint_gt(hr2di_clusters_links(roots.clusters), 0);
  check_rows(&roots, 600);
  hr2di_roots_clear(&roots, &alloc);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("root pairs") {
  REPEAT_TESTS(sizeof hiding / sizeof *hiding, "pairs", beams_find_what_is_seen);
  ADD_TESTS("pairs", clusters_where_much_is_seen);
}
