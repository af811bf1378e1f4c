/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ends of patches and walls that a patch sees, against rays from random points of the patch.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>

#include "base/alloc.h"
#include "mesh/visible-vertices.h"
#include "support/grid-plans.h"
#include "support/plane.h"
#include "support/support.h"

enum { RAYS = 1000 };

/* Whether no wall but that of patch i is between two points. */
static int is_free(const hr2d_scene *scene, uint32_t i, hr2d_point from, hr2d_point to) {
  const hr2di_walls *w = &scene->walls;
  for (uint32_t k = 0; k < w->walls; k++)
    if (k != w->of_segment[i] && plane_crosses(w->wall[k].at, from, to)) return 0;
  return 1;
}

/* An end is a joint if it is inside its wall. */
static int is_joint(const hr2d_scene *scene, uint32_t patch, hr2d_point end) {
  const hr2d_segment w = scene->walls.wall[scene->walls.of_segment[patch]].at;
  return !plane_same(end, w.a) && !plane_same(end, w.b);
}

typedef struct tally {
  int seen, unseen, doubtful;
} tally;

/* What some ray sees is seen.  Ends that few rays might see, or that only the rest of the wall
   of patch i sees, are doubtful. */
static void check_end(randoms *r, const hr2di_visible_vertices *seen, uint32_t i, uint32_t j,
                      int last, tally *t) {
  const hr2d_scene *scene = seen->tracer.scene;
  const hr2d_segment s = scene->patch[i].scaled, other = scene->patch[j].scaled;
  const hr2d_point end = last ? other.b : other.a;
  const int has = hr2di_visible_vertices_has(seen, j, last);
  if (plane_det(s.a, s.b, end) <= 0) return;
  int rays = 0;
  for (int k = 0; k < RAYS && !rays; k++)
    rays += is_free(scene, i, plane_along(s, random_unit(r)), end);
  ck_assert_msg(has || !rays || is_joint(scene, j, end), "patch %u sees end %d of %u", i, last,
                j);
  t->seen += rays > 0;
  t->unseen += !has;
  t->doubtful += has && !rays && !is_joint(scene, j, end);
}

START_TEST(ends_are_seen_by_rays) {
  randoms r = randoms_stream(test_seed(), 11);
  const int count = test_count(300);
  tally t = {0, 0, 0};
  for (int k = 0; k < count; k++) {
    const hr2d_allocator alloc = hr2di_alloc_default();
    plan p = grid_plan(&r, random_below(&r, 2));
    hr2d_scene *scene = plan_try_scene(&p, NULL);
    plan_free(&p);
    hr2di_visible_vertices seen = {0};
    if (scene && hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL)) {
      ck_assert_int_eq(hr2di_visible_vertices_init(&seen, scene, NULL, &alloc, NULL), HR2D_OK);
      for (int m = 0; m < 4; m++) {
        const uint32_t i = (uint32_t)random_below(&r, (int)scene->patches);
        ck_assert_int_eq(hr2di_visible_vertices_look(&seen, i), HR2D_OK);
        for (uint32_t j = 0; j < scene->patches; j++)
          for (int last = 0; last < 2 && j != i; last++) check_end(&r, &seen, i, j, last, &t);
      }
      hr2di_visible_vertices_clear(&seen);
    }
    hr2d_scene_destroy(scene);
  }
  printf("%d ends are seen, %d are not, %d by few rays\n", t.seen, t.unseen, t.doubtful);
  ck_assert_int_gt(t.seen, count);
  ck_assert_int_gt(t.unseen, count);
  ck_assert_int_lt(5 * t.doubtful, t.seen);
}
END_TEST

/* The front of a wall is seen in one room, and not from behind a partition. */
START_TEST(a_partition_hides_a_wall) {
  static const double at[][4] = {{0, 0, 4, 0}, {4, 0, 4, 2}, {4, 2, 0, 2},
                                 {0, 2, 0, 0}, {2, 0, 2, 2}, {2, 2, 2, 0}};
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_scene *scene = test_open_scene(at, 6);
  hr2di_visible_vertices seen = {0};
  test_commit(scene);
  ck_assert_int_eq(hr2di_visible_vertices_init(&seen, scene, NULL, &alloc, NULL), HR2D_OK);
  ck_assert_int_eq(hr2di_visible_vertices_look(&seen, 1), HR2D_OK);
  ck_assert(hr2di_visible_vertices_has_wall(&seen, scene->walls.of_segment[5]));
  ck_assert(hr2di_visible_vertices_has_wall(&seen, scene->walls.of_segment[0]));
  ck_assert(!hr2di_visible_vertices_has_wall(&seen, scene->walls.of_segment[3]));
  hr2di_visible_vertices_clear(&seen);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("seen ends") {
  ADD_TESTS("ends", ends_are_seen_by_rays, a_partition_hides_a_wall);
}
