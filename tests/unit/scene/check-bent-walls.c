/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A wall that is cut at a rounded crossing bends.  No end of another patch, which touches the
   wall within roundings, changes its side by that.  HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in
   the environment change the scenes. */
#include <math.h>

#include "geometry/orient-sign.h"
#include "support/support.h"

static int is_inside(const hr2d_segment *s, hr2d_point at) {
  return at.x > fmin(s->a.x, s->b.x) && at.x < fmax(s->a.x, s->b.x);
}

/* The side of `end` to the pieces of the wall from a to b, in its direction; 2: it lies at a
   cut. */
static int side_of_pieces(const hr2d_scene *scene, const hr2d_segment *wall, hr2d_point end) {
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    const int forward = s.a.x < s.b.x;
    const int on_wall = (s.a.x == wall->a.x && s.a.y == wall->a.y) ||
                        (s.b.x == wall->b.x && s.b.y == wall->b.y);
    if (on_wall && forward && is_inside(&s, end)) return hr2di_orient_sign(s.a, s.b, end);
  }
  return 2;
}

START_TEST(ends_stay_on_their_side) {
  randoms r = randoms_stream(test_seed(), 5);
  int kept = 0, cut = 0;
  for (int k = test_count(20000) + 2000; k > 0; k--) {
    const hr2d_segment wall = {{random_unit(&r), random_unit(&r)},
                               {1 + random_unit(&r), random_unit(&r)}};
    const double x = wall.b.x - wall.a.x, y = wall.b.y - wall.a.y;
    const double at = random_between(&r, 0.3, 0.7), foot = random_between(&r, 0.05, 0.25);
    const double dx = random_between(&r, -0.2, 0.2), dy = random_between(&r, 0.5, 1);
    const hr2d_point c = {wall.a.x + at * x, wall.a.y + at * y};
    const hr2d_segment crosser = {{c.x - dx, c.y - dy}, {c.x + dx, c.y + dy}};
    const hr2d_point end = {wall.a.x + foot * x, random_nudge(&r, wall.a.y + foot * y, 2)};
    const int side = hr2di_orient_sign(wall.a, wall.b, end);
    if (side == 0) continue;
    hr2d_scene *scene = test_new_scene(NULL);
    test_add_patch(scene, wall, 1, 0.5, HR2D_SIDES_FRONT);
    test_add_patch(scene, crosser, 1, 0.5, HR2D_SIDES_FRONT);
    test_add_patch(scene, (hr2d_segment){end, {end.x, end.y + 0.2 * side}}, 1, 0.5,
                   HR2D_SIDES_FRONT);
    ck_assert_int_eq(hr2d_scene_split_crossings(scene, NULL), HR2D_OK);
    const int now = side_of_pieces(scene, &wall, end);
    ck_assert_int_ne(now, -side);
    kept += now == side;
    cut += now == 2;
    hr2d_scene_destroy(scene);
  }
  /* Negative control: some ends would have changed sides without a cut. */
  ck_assert_int_gt(kept, 100);
  ck_assert_int_gt(cut, 10);
}
END_TEST

TEST_SUITE("bent walls") {
  ADD_TESTS("ends", ends_stay_on_their_side);
}
