/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangulations of walls against the checker and against exact tests of all pairs. */
#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "support/support.h"
#include "triangulation/check.h"
#include "triangulation/triangulation.h"

enum { MOST = 64 };

static hr2d_status build(hr2di_triangulation *t, const hr2d_segment *wall, size_t count,
                         hr2di_conflict *conflict) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  return hr2di_triangulation_init(t, &alloc, wall, count, sizeof *wall, conflict, NULL);
}

static int sign(hr2d_point a, hr2d_point b, hr2d_point c) {
  return hr2d_orientation(a, b, c);
}

/* The insides of two segments have a point in common; *together: a stretch. */
static int conflict_of(const hr2d_segment *i, const hr2d_segment *j, int *together) {
  const int ca = sign(i->a, i->b, j->a), cb = sign(i->a, i->b, j->b);
  const int ac = sign(j->a, j->b, i->a), bc = sign(j->a, j->b, i->b);
  *together = 0;
  if (ca || cb || ac || bc) return ca * cb < 0 && ac * bc < 0;
  const double x = fmax(fmin(i->a.x, i->b.x), fmin(j->a.x, j->b.x)),
               y = fmax(fmin(i->a.y, i->b.y), fmin(j->a.y, j->b.y));
  const double u = fmin(fmax(i->a.x, i->b.x), fmax(j->a.x, j->b.x)),
               v = fmin(fmax(i->a.y, i->b.y), fmax(j->a.y, j->b.y));
  *together = (x < u && y <= v) || (x <= u && y < v);
  return *together;
}

static int is_point(const hr2d_segment *s) {
  return s->a.x == s->b.x && s->a.y == s->b.y;
}

/* Small scenes on a lattice: of every kind of touching, some with conflicts. */
START_TEST(lattices_are_triangulated_exactly) {
  randoms r = randoms_stream(test_seed(), 1);
  int refused = 0, whole = 0;
  for (int round = 0; round < test_count(100000); round++) {
    hr2d_segment wall[MOST];
    const size_t count = 1 + (size_t)random_below(&r, 12);
    const int size = 2 + random_below(&r, 8);
    for (size_t k = 0; k < count; k++) do {
        wall[k].a = (hr2d_point){random_below(&r, size), random_below(&r, size)};
        wall[k].b = (hr2d_point){random_below(&r, size), random_below(&r, size)};
      } while (is_point(&wall[k]));
    int expected = 0, together;
    for (size_t i = 0; i < count; i++)
      for (size_t j = 0; j < i; j++) expected |= conflict_of(&wall[i], &wall[j], &together);
    hr2di_triangulation t;
    hr2di_conflict conflict;
    const hr2d_status status = build(&t, wall, count, &conflict);
    ck_assert_int_eq(status, expected ? HR2D_ESCENE : HR2D_OK);
    if (expected) {
      ck_assert(conflict.wall[0] < conflict.wall[1]);
      ck_assert(conflict_of(&wall[conflict.wall[0]], &wall[conflict.wall[1]], &together));
      ck_assert_int_eq(together, conflict.together);
      refused++;
    } else {
      const char *fault = hr2di_triangulation_fault(&t, wall, sizeof *wall, 0);
      ck_assert_msg(!fault, "%s", fault);
      whole++;
    }
    hr2di_triangulation_clear(&t);
  }
  ck_assert(refused > 0 && whole > 0);
}
END_TEST

/* Small squares on a grid, turned by chance. */
static size_t draw_squares(randoms *r, hr2d_segment *wall, size_t side) {
  size_t n = 0;
  for (size_t i = 0; i < side; i++)
    for (size_t j = 0; j < side; j++) {
      const double turn = random_between(r, 0, 6.28), size = random_between(r, 0.1, 0.6);
      hr2d_point p[4];
      for (int k = 0; k < 4; k++)
        p[k] = (hr2d_point){(double)i + size * cos(turn + k * 1.5707963267948966),
                            (double)j + size * sin(turn + k * 1.5707963267948966)};
      for (int k = 0; k < 4; k++) wall[n++] = (hr2d_segment){p[k], p[(k + 1) % 4]};
    }
  return n;
}

START_TEST(squares_are_triangulated) {
  randoms r = randoms_stream(test_seed(), 2);
  enum { SIDE = 60 };
  hr2d_segment *wall = malloc(4 * SIDE * SIDE * sizeof *wall);
  ck_assert(wall != NULL);
  for (int round = 0; round < test_count(20); round++) {
    const size_t count = draw_squares(&r, wall, SIDE);
    hr2di_triangulation t;
    hr2di_conflict conflict;
    const hr2d_status status = build(&t, wall, count, &conflict);
    if (status == HR2D_OK) {
      const char *fault = hr2di_triangulation_fault(&t, wall, sizeof *wall, 0);
      ck_assert_msg(!fault, "%s", fault);
    }
    hr2di_triangulation_clear(&t);
  }
  free(wall);
}
END_TEST

TEST_SUITE("triangulation") {
  ADD_TESTS("triangulation", lattices_are_triangulated_exactly, squares_are_triangulated);
}
