/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Line classes of parts of patches, against the exchange areas of the parts among all walls,
   however the parts were reached.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "support/grid-plans.h"
#include "support/support.h"
#include "visibility/pair-visibility.h"

enum { DEEPEST = 6 };

static hr2d_scene *draw(randoms *r) {
  plan p = grid_plan(r, random_below(r, 2));
  hr2d_scene *scene = plan_try_scene(&p, NULL);
  plan_free(&p);
  if (!scene || hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL)) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

static hr2d_segment half_of(hr2d_segment s, int second) {
  const hr2d_point middle = {0.5 * (s.a.x + s.b.x), 0.5 * (s.a.y + s.b.y)};
  return second ? (hr2d_segment){middle, s.b} : (hr2d_segment){s.a, middle};
}

/* By all walls of the scene. */
static double expected(const hr2d_scene *scene, const hr2di_patch_pair *parts) {
  double area;
  hr2d_segment *walls = malloc(scene->walls.walls * sizeof *walls);
  ck_assert_ptr_nonnull(walls);
  for (size_t k = 0; k < scene->walls.walls; k++) walls[k] = scene->walls.wall[k].at;
  ck_assert_int_eq(hr2d_exchange_area_occluded(&parts->part[0], &parts->part[1], walls,
                                               scene->walls.walls, NULL, &area),
                   HR2D_OK);
  free(walls);
  return area;
}

/* Two patches that see each other, halved at random: what is left of their line classes is what
   the parts see of each other, in the same bits. */
static void check_pair(randoms *r, hr2di_pair_visibility *visibility, const hr2d_scene *scene) {
  hr2di_line_class_list list[DEEPEST + 1];
  for (int k = 0; k <= DEEPEST; k++)
    list[k] = (hr2di_line_class_list){.alloc = hr2di_alloc_default()};
  const uint32_t n = (uint32_t)scene->patches;
  hr2di_patch_pair parts = {
      .patch = {(uint32_t)random_below(r, (int)n), (uint32_t)random_below(r, (int)n)}};
  if (parts.patch[0] == parts.patch[1]) return;
  const int turn = parts.patch[0] > parts.patch[1];
  for (int k = 0; k < 2; k++) parts.part[k] = scene->patch[parts.patch[k]].scaled;
  for (int depth = 0; depth <= DEEPEST; depth++) {
    hr2di_line_class_list direct = {.alloc = hr2di_alloc_default()};
    hr2di_line_class_list left = {.alloc = hr2di_alloc_default()}, *here = &list[depth];
    ck_assert_int_eq(hr2di_pair_visibility_between(visibility, &parts, &direct,
                                                   depth == 0 ? &list[0] : NULL),
                     HR2D_OK);
    if (depth > 0)
      ck_assert_int_eq(hr2di_line_class_list_restrict(&left, here - 1, 0, here[-1].count,
                                                      parts.part[turn], parts.part[!turn],
                                                      here),
                       HR2D_OK);
    const double area = hr2di_line_class_list_area(&direct, 0, direct.count);
    ck_assert_double_eq_tol(area, expected(scene, &parts), 1e-14);
    if (depth > 0) {
      ck_assert_uint_eq(left.count, direct.count);
      ck_assert_uint_eq(left.points, direct.points);
      if (direct.points > 0)
        ck_assert_mem_eq(left.point, direct.point, direct.points * sizeof *direct.point);
    }
    hr2di_line_class_list_clear(&left);
    hr2di_line_class_list_clear(&direct);
    const int which = random_below(r, 2);
    parts.part[which] = half_of(parts.part[which], random_below(r, 2));
  }
  for (int k = 0; k <= DEEPEST; k++) hr2di_line_class_list_clear(&list[k]);
}

START_TEST(parts_see_what_is_left_of_sights) {
  randoms r = randoms_stream(test_seed(), 7);
  const int count = test_count(300);
  for (int k = 0; k < count; k++) {
    const hr2d_allocator alloc = hr2di_alloc_default();
    hr2di_watch watch;
    hr2d_scene *scene = draw(&r);
    if (!scene) continue;
    hr2di_watch_init(&watch, NULL, NULL, NULL);
    hr2di_pair_visibility visibility;
    ck_assert_int_eq(hr2di_pair_visibility_init(&visibility, scene, NULL, &alloc, &watch),
                     HR2D_OK);
    for (int m = 0; m < 30; m++) check_pair(&r, &visibility, scene);
    hr2di_pair_visibility_clear(&visibility);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("patch sights") {
  ADD_TESTS("sights", parts_see_what_is_left_of_sights);
}
