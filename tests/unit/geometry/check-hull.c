/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which segments have all others on one side, against all signs.  HR2D_TEST_SEED and
   HR2D_TEST_MULTIPLIER change the segments. */
#include <math.h>

#include "base/alloc.h"
#include "geometry/hull.h"
#include "support/lattice-scenes.h"
#include "support/support.h"

enum { MOST = 30 };

static unsigned expected(const hr2d_segment *s, size_t count, size_t k) {
  unsigned sides = 0;
  for (size_t m = 0; m < count; m++)
    for (int end = 0; end < 2; end++) {
      const int side = hr2d_orientation(s[k].a, s[k].b, end ? s[m].b : s[m].a);
      sides |= side > 0 ? 1u : side < 0 ? 2u : 0u;
    }
  return sides;
}

static void check(const hr2d_segment *s, size_t count, size_t found[4]) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2di_hull hull;
  ck_assert_int_eq(hr2di_hull_init(&hull, &alloc, s, count, sizeof *s, NULL), HR2D_OK);
  for (size_t k = 0; k < count; k++) {
    const unsigned sides = hr2di_hull_sides(&hull, s[k]);
    ck_assert_uint_eq(sides, expected(s, count, k));
    found[sides]++;
  }
  hr2di_hull_clear(&hull);
}

START_TEST(segments_on_lattices) {
  unsigned long state = test_seed() + 31;
  size_t found[4] = {0};
  for (int round = test_count(50000); round > 0; round--) {
    lattice p[MOST];
    hr2d_segment s[MOST];
    const size_t count = (size_t)(1 + lattice_random(&state, MOST));
    const long long flat = lattice_random(&state, 4);
    lattice_draw(&state, p, count, 2 + lattice_random(&state, 6),
                 1 + lattice_random(&state, 6));
    for (size_t k = 0; k < count; k++) {
      s[k] = (hr2d_segment){{(double)p[k].ax, (double)p[k].ay},
                            {(double)p[k].bx, (double)p[k].by}};
      /* All on one line, or far more on the border than inside. */
      if (flat == 0) s[k].a.y = s[k].a.x, s[k].b.y = s[k].b.x;
      if (flat == 1) s[k].a.y = s[k].b.y = (double)(p[k].ay % 2);
      if (s[k].a.x == s[k].b.x && s[k].a.y == s[k].b.y) s[k].b.x += 1, s[k].b.y += flat == 0;
    }
    check(s, count, found);
  }
  printf("%zu segments on the line of all, %zu with all on the left, %zu on the right, %zu on "
         "both sides\n",
         found[0], found[1], found[2], found[3]);
  for (int k = 0; k < 4; k++) ck_assert_uint_gt(found[k], 0);
}
END_TEST

/* A round room is on its hull.  A corner that is moved to an ulp inside of the chord between
   its neighbours takes both its segments off it. */
START_TEST(round_rooms) {
  enum { CORNERS = 24 };
  hr2d_segment s[CORNERS];
  size_t found[4] = {0};
  for (int k = 0; k < CORNERS; k++) {
    const double angle = 2 * acos(-1) * k / CORNERS;
    s[k].a = s[(k + CORNERS - 1) % CORNERS].b = (hr2d_point){cos(angle), sin(angle)};
  }
  check(s, CORNERS, found);
  ck_assert_uint_eq(found[1], CORNERS);
  const hr2d_point before = s[CORNERS - 1].a, behind = s[0].b;
  const double x = fmin(before.x, behind.x);
  s[0].a = s[CORNERS - 1].b = (hr2d_point){nextafter(x, 0), 0};
  check(s, CORNERS, found);
  ck_assert_uint_eq(found[3], 2);
}
END_TEST

TEST_SUITE("hull") {
  ADD_TESTS("hull", segments_on_lattices, round_rooms);
}
