/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which patches see backs, against views from points of the patches.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "support/grid-plans.h"
#include "support/support.h"
#include "visibility/back-visibility.h"
#include "visibility/point-view.h"

enum { VIEWS = 40 };

/* The largest form factor of backs from points of a patch. */
static double max_back(randoms *r, hr2di_point_viewer *viewer, size_t patch) {
  double max = 0;
  for (int k = 0; k < VIEWS; k++) {
    hr2di_view_from seen;
    ck_assert_int_eq(hr2di_view_at(viewer, patch, random_unit(r), &seen), HR2D_OK);
    max = fmax(max, seen.back);
  }
  return max;
}

typedef struct tally {
  int seen, unseen, doubtful;
} tally;

static void check_scene(randoms *r, const hr2d_scene *scene, tally *t) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2di_point_viewer *viewer = NULL;
  unsigned char *sees = NULL;
  ck_assert_int_eq(hr2di_back_visibility(scene, &alloc, 2, &sees, NULL), HR2D_OK);
  ck_assert_int_eq(hr2di_point_viewer_create(scene, &alloc, NULL, &viewer), HR2D_OK);
  for (size_t k = 0; k < scene->patches; k++) {
    const int flag = sees && sees[k];
    const double back = max_back(r, viewer, k);
    ck_assert_msg(flag || back < 1e-12, "patch %zu sees backs by %g", k, back);
    t->seen += back >= 1e-12;
    t->unseen += !flag;
    t->doubtful += flag && back < 1e-12;
  }
  hr2di_point_viewer_destroy(viewer);
  free(sees);
}

START_TEST(backs_are_seen_by_views) {
  randoms r = randoms_stream(test_seed(), 17);
  const int count = test_count(300);
  tally t = {0, 0, 0};
  for (int k = 0; k < count; k++) {
    plan p = grid_plan(&r, random_below(&r, 2));
    hr2d_scene *scene = plan_try_scene(&p, NULL);
    plan_free(&p);
    if (scene && hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL))
      check_scene(&r, scene, &t);
    hr2d_scene_destroy(scene);
  }
  printf("%d patches see backs, %d do not, %d by few views\n", t.seen, t.unseen, t.doubtful);
  ck_assert_int_gt(t.seen, count);
  ck_assert_int_gt(t.unseen, count);
  ck_assert_int_lt(5 * t.doubtful, t.seen);
}
END_TEST

/* The back of a screen is seen from one side of it; a house, whose backs are inside, from none.
 */
START_TEST(a_screen_has_a_back) {
  static const double at[][4] = {{-1, 0, 4, 0},  {1, 1, 2, 1},     {4, 3, -1, 3}, {3, 1, 3, 2},
                                 {3, 2, 3.5, 2}, {3.5, 2, 3.5, 1}, {3.5, 1, 3, 1}};
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_scene *scene = test_open_scene(at, 7);
  unsigned char *sees = NULL;
  test_commit(scene);
  ck_assert_int_eq(hr2di_back_visibility(scene, &alloc, 2, &sees, NULL), HR2D_OK);
  ck_assert_ptr_nonnull(sees);
  ck_assert(sees[0]);
  ck_assert(!sees[1]);
  ck_assert(!sees[2]);
  ck_assert(!sees[5]);
  free(sees);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The backs of its walls are outside. */
START_TEST(nobody_in_a_room_sees_a_back) {
  static const double at[][4] = {{0, 0, 4, 0}, {4, 0, 4, 2}, {4, 2, 0, 2},
                                 {0, 2, 0, 0}, {2, 0, 2, 1}, {2, 1, 2, 0}};
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_scene *scene = test_open_scene(at, 6);
  unsigned char *sees = NULL;
  test_commit(scene);
  ck_assert_int_eq(hr2di_back_visibility(scene, &alloc, 2, &sees, NULL), HR2D_OK);
  for (size_t k = 0; k < 6 && sees; k++) ck_assert(!sees[k]);
  free(sees);
  hr2d_scene_destroy(scene);
}
END_TEST

/* So many screens have sides for several tasks. */
enum { ALONG = 20, SCREENS = ALONG * ALONG };

START_TEST(threads_find_the_same) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  randoms r = randoms_stream(test_seed(), 18);
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < SCREENS; k++) {
    const double x = k % ALONG, y = k / ALONG;
    const double at[] = {x + 0.4 * random_unit(&r), y + random_unit(&r),
                         x + 0.5 + 0.4 * random_unit(&r), y + random_unit(&r)};
    test_add_black(scene, at);
  }
  unsigned char *sees[2] = {NULL, NULL};
  size_t seen = 0;
  test_commit(scene);
  for (unsigned k = 0; k < 2; k++)
    ck_assert_int_eq(hr2di_back_visibility(scene, &alloc, 1 + 3 * k, &sees[k], NULL), HR2D_OK);
  ck_assert_mem_eq(sees[0], sees[1], scene->patches);
  for (size_t k = 0; k < scene->patches; k++) seen += sees[0][k];
  ck_assert_uint_gt(seen, scene->patches / 10);
  free(sees[0]);
  free(sees[1]);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("seen backs") {
  ADD_TESTS("backs", backs_are_seen_by_views, a_screen_has_a_back, nobody_in_a_room_sees_a_back,
            threads_find_the_same);
}
